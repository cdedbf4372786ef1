// A network operator as its authors evaluate it: float32, functions looked up by number in a map, the whole matrix
// scanned row by row. Written from the definition (Diveev and Sofronova 2008, library of 2022), for comparison only.
#include <cmath>
#include <map>
#include <vector>

namespace {
using Row = std::vector<float>;

const float LARGE = 1e8f, SMALL = 1e-8f, LN_LARGE = 18.420681f;
float sgn(float a) { return a >= 0 ? 1.0f : -1.0f; }

float identity(float a) { return a; }
float square(float a) { return std::fabs(a) > 1e4f ? LARGE : a * a; }
float negative(float a) { return -a; }
float root(float a) { return sgn(a) * std::sqrt(std::fabs(a)); }
float inverse(float a) { return std::fabs(a) <= SMALL ? sgn(a) * LARGE : 1 / a; }
float exponential(float a) { return a > LN_LARGE ? LN_LARGE : std::exp(a); }
float logarithm(float a) { return std::fabs(a) < 0.00033546263f ? -LN_LARGE : std::log(std::fabs(a)); }
float hyperbolic(float a) { return std::fabs(a) > LN_LARGE ? sgn(a) : std::tanh(0.5f * a); }
float step(float a) { return a >= 0 ? 1.0f : 0.0f; }
float cosine(float a) { return std::cos(a); }
float sine(float a) { return std::sin(a); }
float arc(float a) { return std::atan(a); }
float cube(float a) { return std::fabs(a) > 464.15888f ? sgn(a) * LARGE : a * a * a; }
float cube_root(float a) { return std::fabs(a) < SMALL ? sgn(a) * SMALL : sgn(a) * std::pow(std::fabs(a), 1.0f / 3); }
float clip(float a) { return std::fabs(a) < 1 ? a : sgn(a); }
float log1p_(float a) { return sgn(a) * std::log(std::fabs(a) + 1); }
float expm1_(float a) { return sgn(a) * (std::fabs(a) > LN_LARGE ? LARGE : std::exp(std::fabs(a)) - 1); }
float decay(float a) { return sgn(a) * (std::fabs(a) > LARGE ? SMALL : std::exp(-std::fabs(a))); }
float half(float a) { return 0.5f * a; }
float twice(float a) { return 2 * a; }
float saturation(float a) { return sgn(a) * (1 - std::exp(-std::fabs(a))); }
float minus_cube(float a) { return std::fabs(a) > LARGE ? -sgn(a) * LARGE : a - a * a * a; }
float sigmoid(float a) { return a > LARGE ? 1 : std::exp(-a) > LARGE ? 0 : 1 / (1 + std::exp(-a)); }
float step_open(float a) { return a > 0 ? 1.0f : 0.0f; }
float dead_zone(float a) { return std::fabs(a) < 0.01f ? 0 : sgn(a); }
float circle(float a) { return std::fabs(a) > 1 ? sgn(a) : sgn(a) * (1 - std::sqrt(1 - a * a)); }
float notch(float a) { return a * a > LN_LARGE ? a * (1 - SMALL) : a * (1 - std::exp(-a * a)); }

float sum(float a, float b) { return a + b; }
float product(float a, float b) { return a * b > LARGE ? LARGE : a * b < -LARGE ? -LARGE : a * b; }
float larger(float a, float b) { return a >= b ? a : b; }
float smaller(float a, float b) { return a < b ? a : b; }
float prob_sum(float a, float b) { return a + b - a * b; }
float norm(float a, float b) { return sgn(a + b) * std::sqrt(a * a + b * b); }
float abs_sum(float a, float b) { return sgn(a + b) * (std::fabs(a) + std::fabs(b)); }
float abs_max(float a, float b) { return sgn(a + b) * larger(std::fabs(a), std::fabs(b)); }

struct Network {
    std::map<int, float (*)(float)> unary{
        {1, identity}, {2, square}, {3, negative}, {4, root}, {5, inverse}, {6, exponential}, {7, logarithm},
        {8, hyperbolic}, {9, step}, {10, sgn}, {11, cosine}, {12, sine}, {13, arc}, {14, cube}, {15, cube_root},
        {16, clip}, {17, log1p_}, {18, expm1_}, {19, decay}, {20, half}, {21, twice}, {22, saturation},
        {23, minus_cube}, {24, sigmoid}, {25, step_open}, {26, dead_zone}, {27, circle}, {28, notch}};
    std::map<int, float (*)(float, float)> binary{{1, sum},      {2, product}, {3, larger},  {4, smaller},
                                                  {5, prob_sum}, {6, norm},    {7, abs_sum}, {8, abs_max}};
    std::map<int, float> unit{{1, 0}, {2, 1}, {3, -LARGE}, {4, LARGE}, {5, 0}, {6, 0}, {7, 0}, {8, 0}};
    std::vector<std::vector<int>> psi;
    std::vector<int> inputs, sources, outputs;
    Row parameters, z;

    void evaluate(const Row &x, Row &y) {
        const std::size_t size = psi.size();
        for (std::size_t j = 0; j < size; j++) z[j] = psi[j][j] ? unit[psi[j][j]] : 0;
        for (std::size_t k = 0; k < inputs.size(); k++) z[inputs[k]] = x[k];
        for (std::size_t k = 0; k < sources.size(); k++) z[sources[k]] = parameters[k];
        for (std::size_t i = 0; i + 1 < size; i++)
            for (std::size_t j = i + 1; j < size; j++)
                if (psi[i][j] != 0) z[j] = binary[psi[j][j]](z[j], unary[psi[i][j]](z[i]));
        for (std::size_t k = 0; k < outputs.size(); k++) y[k] = z[outputs[k]];
    }
};

Network network(const int *psi, int size, const int *nodes, int n, int p, int m, const float *parameters) {
    Network made;
    for (int i = 0; i < size; i++) made.psi.emplace_back(psi + i * size, psi + (i + 1) * size);
    made.inputs.assign(nodes, nodes + n);
    made.sources.assign(nodes + n, nodes + n + p);
    made.outputs.assign(nodes + n + p, nodes + n + p + m);
    made.parameters.assign(parameters, parameters + p);
    made.z.resize(size);
    return made;
}

// The unicycle of setting.py: errors of the state, controls in [-1, 1], cost x^2 + y^2 + theta^2.
Row rates(Network &law, const Row &state) {
    Row errors{-state[0], -state[1], -state[2]}, u(2);
    law.evaluate(errors, u);
    for (float &control : u) control = control > 1 ? 1 : control < -1 ? -1 : control;
    return {u[0] * std::cos(state[2]), u[0] * std::sin(state[2]), u[1],
            state[0] * state[0] + state[1] * state[1] + state[2] * state[2]};
}

Row ahead(const Row &state, float h, const Row &rate) {
    Row moved(state.size());
    for (std::size_t i = 0; i < state.size(); i++) moved[i] = state[i] + h * rate[i];
    return moved;
}
} // namespace

extern "C" void laws(const int *psi, int size, const int *nodes, int n, int p, int m, const float *parameters,
                     const float *inputs, int count, float *out) {
    Network law = network(psi, size, nodes, n, p, m, parameters);
    for (int k = 0; k < count; k++) {
        Row x(inputs + k * n, inputs + (k + 1) * n), y(m);
        law.evaluate(x, y);
        for (int i = 0; i < m; i++) out[k * m + i] = y[i];
    }
}

extern "C" void rollouts(const int *psi, int size, const int *nodes, int n, int p, int m, const float *parameters,
                         const float *starts, int count, int steps, float h, float *costs) {
    Network law = network(psi, size, nodes, n, p, m, parameters);
    for (int k = 0; k < count; k++) {
        Row state{starts[3 * k], starts[3 * k + 1], starts[3 * k + 2], 0};
        for (int step = 0; step < steps; step++) {
            Row k1 = rates(law, state), k2 = rates(law, ahead(state, h / 2, k1));
            Row k3 = rates(law, ahead(state, h / 2, k2)), k4 = rates(law, ahead(state, h, k3));
            for (int i = 0; i < 4; i++) state[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        }
        costs[k] = state[3];
    }
}
