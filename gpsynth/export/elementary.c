/* gp_bits_of */
static uint64_t gp_bits_of(double a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

/* gp_float_of */
static double gp_float_of(uint64_t bits)
{
    double a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* gp_abs */
static double gp_abs(double a)
{
    return gp_float_of(gp_bits_of(a) & 0x7fffffffffffffffu);
}

/* gp_sqrt: Newton in float64 finds the root within one unit, integers modulo 2^64 round it correctly. */
static double gp_sqrt(double a)
{
    const double x = a < 2.2250738585072014e-308 ? a * 18014398509481984.0 : a;
    const uint64_t exponent = gp_bits_of(x) >> 52;
    const uint64_t odd = (exponent & 1u) ^ 1u;
    const uint64_t mantissa = (gp_bits_of(x) & 0x000fffffffffffffu) | 0x0010000000000000u;
    const double m = gp_float_of((gp_bits_of(x) & 0x000fffffffffffffu) | ((1023u + odd) << 52));
    double y = 0.5 + 0.5 * m;
    uint64_t root, rest;
    int step;
    if (!(a > 0.0) || exponent == 2047u) {
        return a < 0.0 ? gp_float_of(0x7ff8000000000000u) : a;
    }
    for (step = 0; step < 5; step++) {
        y = 0.5 * (y + m / y);
    }
    root = (uint64_t)(y * 4503599627370496.0);
    rest = (mantissa << (52u + odd)) - root * root;
    if ((rest >> 63) == 0u && rest > root) {
        root += 1u;
    } else if ((rest >> 63) == 1u && (rest + root - 1u) >> 63 == 1u) {
        root -= 1u;
    }
    y = gp_float_of((root & 0x000fffffffffffffu) | (((exponent - odd + 1023u) >> 1) << 52));
    return a < 2.2250738585072014e-308 ? y * 7.450580596923828e-09 : y;
}

