// What generated laws and plants stand on: operations of the table on W lanes at once, and the loop around them.
// `Own` computes elementary functions by polynomials, `Libm` (one lane) by the C library.
#include <cmath>
#include <cstdint>
#include <cstring>

template <int W> struct Lanes {
    typedef double Real __attribute__((vector_size(8 * W)));
    typedef int64_t Integer __attribute__((vector_size(8 * W)));
};
template <> struct Lanes<1> {
    typedef double Real;
    typedef int64_t Integer;
};

template <int W> struct Own {
    using V = typename Lanes<W>::Real;
    using I = typename Lanes<W>::Integer;
    static constexpr int width = W;
    static constexpr double ROUND = 6755399441055744.0; // 1.5 2^52; the low bits of n + ROUND hold the integer n
    static constexpr int64_t SIGN = INT64_MIN;

    static I bits(V x) { I i; std::memcpy(&i, &x, sizeof x); return i; }
    static V value(I i) { V x; std::memcpy(&x, &i, sizeof x); return x; }
    static V all(double x) { return V{} + x; }
    template <class M> static V pick(M mask, V a, V b) { return mask ? a : b; }
    static V with_sign(V a, V b) { return value((bits(a) & ~SIGN) | (bits(b) & SIGN)); }

    static V add(V a, V b) { return a + b; }
    static V sub(V a, V b) { return a - b; }
    static V mul(V a, V b) { return a * b; }
    static V neg(V a) { return -a; }
    static V abs(V a) { return value(bits(a) & ~SIGN); }
    static V square(V a) { return a * a; }
    static V max(V a, V b) { return pick(a >= b, a, b); }
    static V min(V a, V b) { return pick(a < b, a, b); }
    static V div_protected(V a, V b) {
        V sign = pick(b >= 0.0, all(1.0), all(-1.0));
        return pick(abs(b) <= 1e-8, a * sign * 1e8, a / b);
    }
    static V limit(V a, V low, V high) {
        V number = pick(a == a, a, V{});
        return pick(number > high, high, pick(number < low, low, number));
    }

    // (-1)^n sin r of x = n pi + r, |r| <= pi / 2; pi in three parts whose first two have exact multiples.
    static V sine(V x, V n, V shifted) {
        V near = (x - n * 3.141592651605606) - n * 1.984187036896401e-09;
        V r = near - n * 1.2246467991473532e-16;
        V rest = (near - r) - n * 1.2246467991473532e-16;
        V z = r * r;
        V p = all(2.721174994265398e-15);
        p = p * z + -7.6429914930608e-13;
        p = p * z + 1.605893970607826e-10;
        p = p * z + -2.5052106872806845e-08;
        p = p * z + 2.755731921113734e-06;
        p = p * z + -0.0001984126984120922;
        p = p * z + 0.008333333333333194;
        p = p * z + -0.16666666666666666;
        return value(bits(r + (r * z * p + rest)) ^ (bits(shifted) << 63));
    }
    static V sin(V a) {
        V shifted = a * 0.3183098861837907 + ROUND;
        return sine(a, shifted - ROUND, shifted);
    }
    static V cos(V a) {
        V shifted = (a * 0.3183098861837907 - 0.5) + ROUND;
        return -sine(a, (shifted - ROUND) + 0.5, shifted);
    }
    static V exp(V a) {
        V shifted = a * 1.4426950408889634 + ROUND;
        V n = shifted - ROUND;
        V r = (a - n * 0.6931471805598903) - n * 5.497923018708371e-14;
        V p = all(2.5000070582545002e-08);
        p = p * r + 2.763023436031298e-07;
        p = p * r + 2.755758627162417e-06;
        p = p * r + 2.480149313503365e-05;
        p = p * r + 0.00019841269506774855;
        p = p * r + 0.0013888888943598715;
        p = p * r + 0.008333333333494335;
        p = p * r + 0.04166666666653026;
        p = p * r + 0.16666666666666413;
        p = p * r + 0.5000000000000011;
        return (1.0 + (r + r * r * p)) * value((bits(shifted) + 1023) << 52);
    }
    static V tanh(V a) {
        V x = abs(a);
        V z = x * x;
        V p = all(-1.9490333624275116e-05);
        p = p * z + 8.33095572229502e-05;
        p = p * z + -0.00023337687175581872;
        p = p * z + 0.0005884426863291855;
        p = p * z + -0.0014555424191689719;
        p = p * z + 0.003592091965875118;
        p = p * z + -0.008863232595216543;
        p = p * z + 0.021869488385486063;
        p = p * z + -0.05396825396374805;
        p = p * z + 0.133333333333266;
        p = p * z + -0.333333333333333;
        V far = 1.0 - 2.0 / (exp(min(x + x, all(700.0))) + 1.0);
        return with_sign(pick(x < 0.55, x + x * z * p, far), a);
    }
};

struct Libm : Own<1> {
    static double sin(double a) { return std::sin(a); }
    static double cos(double a) { return std::cos(a); }
    static double tanh(double a) { return std::tanh(a); }
};

// Runge-Kutta 4 with the law computed at every stage; the states of F::width starts stay in registers.
// Loop<F>: features (state, target) -> e, law e -> raw, limits raw -> u, rates (state, u, goal, t) -> derivatives, cost.
template <class F, class Loop>
void roll(const double *starts, const double *goal, long count, long steps, double h, double *costs) {
    using V = typename F::V;
    constexpr int n = Loop::states, m = Loop::controls, W = F::width;
    for (long first = 0; first + W <= count; first += W) {
        V state[n], target[n], cost = V{};
        for (int i = 0; i < n; i++) {
            double lane[W];
            for (int k = 0; k < W; k++) lane[k] = starts[(first + k) * n + i];
            std::memcpy(&state[i], lane, sizeof lane);
            target[i] = F::all(goal[i]);
        }
        for (long step = 0; step < steps; step++) {
            V slope[n + 1], sum[n + 1], in[2 * n + m + 1], pair[2 * n], e[Loop::features], raw[m];
            for (int stage = 0; stage < 4; stage++) {
                const double ahead = stage == 0 ? 0.0 : stage == 3 ? h : 0.5 * h;
                for (int i = 0; i < n; i++) {
                    in[i] = pair[i] = stage == 0 ? state[i] : state[i] + ahead * slope[i];
                    in[n + m + i] = pair[n + i] = target[i];
                }
                in[2 * n + m] = F::all(double(step) * h + ahead);
                Loop::feature(pair, e);
                Loop::law(e, raw);
                Loop::limit(raw, in + n);
                Loop::rate(in, slope);
                const double weight = (stage == 1 || stage == 2 ? 2.0 : 1.0) * (h / 6.0);
                for (int i = 0; i <= n; i++) sum[i] = stage == 0 ? weight * slope[i] : sum[i] + weight * slope[i];
            }
            for (int i = 0; i < n; i++) state[i] += sum[i];
            cost += sum[n];
        }
        std::memcpy(costs + first, &cost, sizeof cost);
    }
}
