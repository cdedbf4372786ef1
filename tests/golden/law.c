/*
 * law: feedback law of the plant 'unicycle'
 *   sha256 3cafb29601e1af8c8574e3798686527122b3c9484f3572dba5e41c68aba79c89
 *   state[0], target[0]: x in m
 *   state[1], target[1]: y in m
 *   state[2], target[2]: theta in rad
 *   control[0]: v in m/s, from -0.5 to 0.5
 *   control[1]: omega in rad/s, from -0.5 to 0.5
 *
 * cc -std=c99 -Wall -Wextra -Werror -pedantic -Wconversion -ffp-contract=off -c law.c
 * cc -std=c99 -Wall -Wextra -Werror -pedantic -Wconversion -ffp-contract=off -DLAW_SELF_TEST law.c -o law_test && ./law_test
 */
#include "law.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

#ifdef __FAST_MATH__
#error "compile without -ffast-math: the law was checked in IEEE arithmetic"
#endif
#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "compile for arithmetic in double, on x86 with -msse2 -mfpmath=sse"
#endif
#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024
#error "double is not IEEE 754 binary64"
#endif
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

/* gp_float_of */
static double gp_float_of(uint64_t bits)
{
    double a;
    memcpy(&a, &bits, sizeof a);
    return a;
}

/* gp_bits_of */
static uint64_t gp_bits_of(double a)
{
    uint64_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}

/* gp_abs */
static double gp_abs(double a)
{
    return gp_float_of(gp_bits_of(a) & 0x7fffffffffffffffu);
}

/* gp_with_sign: |magnitude| with the sign of source. */
static double gp_with_sign(double magnitude, double source)
{
    return gp_float_of((gp_bits_of(magnitude) & 0x7fffffffffffffffu) | (gp_bits_of(source) & 0x8000000000000000u));
}

/* gp_angle_of_point: The angle of (side x, y), side 1 or -1, x and y not negative; the polynomial sees ratios in [-1/2, 1/2] only. */
static double gp_angle_of_point(double x, double y, double side)
{
    const int steep = y > (x + x);
    const int flat = (y + y) <= x;
    const double turned = steep ? (-x) : (y - x);
    const double numerator = flat ? y : turned;
    const double summed = steep ? y : (y + x);
    const double denominator = flat ? x : summed;
    const double t = side * (numerator / denominator);
    const double z = t * t;
    double p = 0.010117153920883797;
    p = p * z - 0.02743541586851339;
    p = p * z + 0.04186535408290721;
    p = p * z - 0.051220177166211224;
    p = p * z + 0.05858301819535206;
    p = p * z - 0.06663811084160588;
    p = p * z + 0.07692073962679588;
    p = p * z - 0.09090896248266972;
    p = p * z + 0.1111111065979265;
    p = p * z - 0.14285714276389874;
    p = p * z + 0.1999999999990316;
    p = p * z - 0.3333333333333298;
    const double turned_base = steep ? (0.5 * 3.141592653589793) : (0.25 * 3.141592653589793);
    const double turned_rest = steep ? (0.5 * 1.2246467991473532e-16) : (0.25 * 1.2246467991473532e-16);
    const double ahead = flat ? 0.0 : turned_base;
    const double ahead_rest = flat ? 0.0 : turned_rest;
    const double base = (side < 0.0) ? (3.141592653589793 - ahead) : ahead;
    const double rest = (side < 0.0) ? (1.2246467991473532e-16 - ahead_rest) : ahead_rest;
    return base + (t * z * p + rest + t);
}

/* gp_atan2: The angle of the point (b, a) in [-pi, pi]; zeros and infinities as in C99, annex F. */
static double gp_atan2(double a, double b)
{
    double y = gp_abs(a);
    double x = gp_abs(b);
    const int diagonal = (y == x) & (y > 0.0);
    const double scale = (y > 1e+300) ? 0.25 : 1.0;
    y = diagonal ? 1.0 : (y * scale);
    x = diagonal ? 1.0 : (x * scale);
    const double x_or_one = ((x == 0.0) & (y == 0.0)) ? 1.0 : x;
    return gp_with_sign(gp_angle_of_point(x_or_one, y, gp_with_sign(1.0, b)), a);
}

/* gp_sine_of_quadrant: sin(r + (n + ahead) pi / 2) with x = r + n pi / 2, |r| <= pi / 4, shifted = n + ROUND. */
static double gp_sine_of_quadrant(double x, double shifted, uint64_t ahead)
{
    const double n = shifted - 6755399441055744.0;
    const uint64_t quadrant = gp_bits_of(shifted) + ahead;
    const int cosine = (quadrant & 1u) != 0u;
    const double near = x - n * 1.570796325802803 - n * 9.920935184482005e-10;
    const double r = near - n * 6.123233932053594e-17;
    const double r_rest = near - r - n * 6.123233932053594e-17 - n * 6.36831716351095e-25;
    const double z = r * r;
    const double base = cosine ? 1.0 : r;
    const double slope = cosine ? (-r) : 1.0;
    double p = cosine ? (-1.1353281798241095e-11) : (-7.57854031682011e-13);
    p = p * z + (cosine ? 2.087558213831528e-09 : 1.6058363165081574e-10);
    p = p * z + (cosine ? (-2.755731311738154e-07) : (-2.5052104881849487e-08));
    p = p * z + (cosine ? 2.480158728409498e-05 : 2.755731921406482e-06);
    p = p * z + (cosine ? (-0.0013888888888862001) : (-0.000198412698412548));
    p = p * z + (cosine ? 0.04166666666666647 : 0.008333333333333323);
    p = p * z + (cosine ? (-0.5) : (-0.16666666666666666));
    const double value = base + (base * z * p + slope * r_rest);
    return gp_float_of(gp_bits_of(value) ^ ((quadrant << 62u) & 0x8000000000000000u));
}

/* gp_cos: Cosine; NaN if |a| > 1e8. */
static double gp_cos(double a)
{
    const double x = gp_abs(a);
    const double value = gp_sine_of_quadrant(x, x * 0.6366197723675814 + 6755399441055744.0, 1u);
    return (x <= 100000000.0) ? value : (0.0 / 0.0);
}

/* gp_cube: a a a, from the left. */
static double gp_cube(double a)
{
    return a * a * a;
}

/* gp_sgn: 1 if a >= 0 else -1; sgn(-0.0) = 1. */
static double gp_sgn(double a)
{
    return (a >= 0.0) ? 1.0 : (-1.0);
}

/* gp_div_protected: a / b, but a sgn(b) 1e8 if |b| <= 1e-8. */
static double gp_div_protected(double a, double b)
{
    const double quotient = a / b;
    const double limited = a * gp_sgn(b) * 100000000.0;
    return (gp_abs(b) <= 1e-08) ? limited : quotient;
}

/* gp_limit: a kept in [b, c]; NaN counts as 0. */
static double gp_limit(double a, double b, double c)
{
    const double number = (a == a) ? a : 0.0;
    const double lifted = (number < b) ? b : number;
    return (number > c) ? c : lifted;
}

/* gp_sin: Sine; NaN if |a| > 1e8. */
static double gp_sin(double a)
{
    const double x = gp_abs(a);
    const double value = gp_sine_of_quadrant(x, x * 0.6366197723675814 + 6755399441055744.0, 0u);
    const double odd = gp_float_of(gp_bits_of(value) ^ (gp_bits_of(a) & 0x8000000000000000u));
    return (x <= 100000000.0) ? odd : (0.0 / 0.0);
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

/* gp_sqrt_protected: The square root of |a|. */
static double gp_sqrt_protected(double a)
{
    return gp_sqrt(gp_abs(a));
}

/* gp_square: a a. */
static double gp_square(double a)
{
    return a * a;
}

/* gp_power_of_two: 2^n of shifted = n + ROUND; n in [-1022, 1023]. */
static double gp_power_of_two(double shifted)
{
    return gp_float_of((gp_bits_of(shifted) + 1023u) << 52u);
}

/* gp_exp: Exponential; the power of two goes in as two factors, so that subnormal results round once. */
static double gp_exp(double a)
{
    const double shifted = a * 1.4426950408889634 + 6755399441055744.0;
    const double n = shifted - 6755399441055744.0;
    const double r = a - n * 0.6931471805598903 - n * 5.497923018708371e-14;
    double p = 2.5000070582545002e-08;
    p = p * r + 2.763023436031298e-07;
    p = p * r + 2.755758627162417e-06;
    p = p * r + 2.480149313503365e-05;
    p = p * r + 0.00019841269506774855;
    p = p * r + 0.0013888888943598715;
    p = p * r + 0.008333333333494335;
    p = p * r + 0.04166666666653026;
    p = p * r + 0.16666666666666413;
    p = p * r + 0.5000000000000011;
    const double value = 1.0 + (r + r * r * p);
    const double half = 0.5 * n + 6755399441055744.0;
    const double rest = n - (half - 6755399441055744.0) + 6755399441055744.0;
    const double scaled = value * gp_power_of_two(half) * gp_power_of_two(rest);
    const double above_zero = (a < (-746.0)) ? 0.0 : scaled;
    return (a > 710.0) ? (1.0 / 0.0) : above_zero;
}

/* gp_tanh: Hyperbolic tangent: odd polynomial below 0.55, 1 - 2 / (e^2x + 1) above. */
static double gp_tanh(double a)
{
    const double x = gp_abs(a);
    const double z = x * x;
    double p = -1.9490333624275116e-05;
    p = p * z + 8.33095572229502e-05;
    p = p * z - 0.00023337687175581872;
    p = p * z + 0.0005884426863291855;
    p = p * z - 0.0014555424191689719;
    p = p * z + 0.003592091965875118;
    p = p * z - 0.008863232595216543;
    p = p * z + 0.021869488385486063;
    p = p * z - 0.05396825396374805;
    p = p * z + 0.133333333333266;
    p = p * z - 0.333333333333333;
    const double near = x + x * z * p;
    const double far = 1.0 - 2.0 / (gp_exp(x + x) + 1.0);
    return gp_with_sign((x < 0.55) ? near : far, a);
}

/* gp_wrap: a + 2 pi k in [-PI, PI), so PI goes to -PI; NaN if |a| > 1e8. */
static double gp_wrap(double a)
{
    const double n = 4.0 * (a * 0.15915494309189535 + 6755399441055744.0 - 6755399441055744.0);
    const double near = a - n * 1.570796325802803 - n * 9.920935184482005e-10;
    const double r = near - n * 6.123233932053594e-17 - n * 6.36831716351095e-25;
    const double lowered = (r >= 3.141592653589793) ? (r - 2.0 * 3.141592653589793 - 2.0 * 1.2246467991473532e-16) : r;
    const double kept = (r < (-3.141592653589793)) ? (r + 2.0 * 3.141592653589793 + 2.0 * 1.2246467991473532e-16) : lowered;
    const int inside = (kept >= (-3.141592653589793)) & (kept < 3.141592653589793);
    const double wrapped = inside ? kept : (-3.141592653589793);
    return (gp_abs(a) <= 100000000.0) ? wrapped : (0.0 / 0.0);
}

void law(const double state[3], const double target[3], double control[2])
{
    const double r1 = state[0]; /* x */
    const double r2 = state[1]; /* y */
    const double r3 = state[2]; /* theta */
    const double r4 = target[0]; /* x_target */
    const double r5 = target[1]; /* y_target */
    const double r6 = target[2]; /* theta_target */
    const double r7 = r4 - r1;
    const double r8 = r5 - r2;
    const double r9 = r6 - r3;
    const double r10 = gp_cos(r3);
    const double r11 = gp_sin(r3);
    const double r12 = r7 * r10;
    const double r13 = r8 * r11;
    const double r14 = r12 + r13; /* ahead */
    const double r15 = r8 * r10;
    const double r16 = r7 * r11;
    const double r17 = r15 - r16; /* aside */
    const double r18 = gp_wrap(r9); /* error_theta */
    const double r19 = r17 * 0.7;
    const double r20 = gp_abs(r14);
    const double r21 = r20 + 0.001;
    const double r22 = gp_atan2(r19, r21);
    const double r23 = r22 - r18;
    const double r24 = r23 * 2.25;
    const double r25 = gp_tanh(r24);
    const double r26 = r14 * 3.1;
    const double r27 = gp_square(r25);
    const double r28 = 1.0 - r27;
    const double r29 = r26 * r28;
    const double r30 = gp_sqrt_protected(r14);
    const double r31 = gp_div_protected(r25, r30);
    const double r32 = gp_cube(r17);
    const double r33 = -r32;
    const double r34 = r31 + r33;
    const double r35 = gp_limit(r29, (-0.5), 0.5);
    const double r36 = gp_limit(r34, (-0.5), 0.5);
    control[0] = r35;
    control[1] = r36;
}

#ifdef LAW_SELF_TEST
#include <stdio.h>

/* Each row: state, target, and the control the law has there. */
int main(void)
{
    static const double rows[32][8] = {
        {0x1.61e0d28bbb3a1p-2, 0x1.a4ab22204681fp-1, 0x1.525e18ce5fc0ap-2, -0x1.4d9bb65b49607p+0, 0x1.cf8acddd349f3p-1, 0x1.c9166a7847147p-2, -0x1p-1, 0x1.60d5c5b9a36ecp-5},
        {(1.0 / 0.0), 0x1.dc0d4ca8701dp-5, 0x1.2aa85f7ba8cbfp-5, 0x1.e1e81c587d084p-6, (-1.0 / 0.0), -0x0.fd1d7d505cd02p-1022, 0x0p+0, 0x0p+0},
        {-0x1.2694e604af145p+6, -0x1.04a7ea29a527fp+4, -0x1.81b2090548676p+5, 0x1.df13b4501f599p+5, 0x1.fc7166dc189afp+1, -0x1.d3ee49028f27cp+4, -0x1p-1, 0x1p-1},
        {-0x1.90564e549399fp-1, (0.0 / 0.0), -0x1.1ccf385ebc8ap+1023, 0x0.0000000000001p-1022, 0x1.0f0cf064dd592p+73, 0x1.01b8af4a538d9p+0, 0x0p+0, 0x0p+0},
        {-0x1.b1c93713502ep+4, -0x1.2e3dfb88b6b6ap+4, -0x1.bf6aa3644de16p+0, -0x1.0e33ad520357p+2, 0x1.1176899461358p+1, 0x1.162c0ce43a366p+1, -0x1.acf2b313dead1p-11, -0x1p-1},
        {0x1.5afc987a554bep-6, -0x1.6c63100a8ae11p-7, 0x0p+0, 0x1.4eb00d1e523b8p-6, -0x1p+0, -0x0.fd1d7d505cd02p-1022, -0x1.0c840336a00d1p-17, -0x1p-1},
        {-0x1.a512f2f44437cp-5, -0x1.51869a8023c44p-3, 0x1.125fcdfde2ccfp-6, 0x1.6537a5198f2cdp-7, -0x1.f6b930d5daabcp-4, -0x1.17d9820cf6e4dp-4, 0x1.0d2e22c0eee4p-4, 0x1p-1},
        {(0.0 / 0.0), -0x1.82f8634638eaep-4, -0x1.4202d2e7bbfd1p-7, (0.0 / 0.0), 0x1.5798ee2308c3ap-27, -0x1.1ccf385ebc8ap+1023, 0x0p+0, 0x0p+0},
        {0x1.851e6580fb1d2p-8, 0x1.2404809e9d9f8p-7, 0x1.a48ad380768a3p-9, -0x1.0c1e205611351p-7, 0x1.df7ee24f1c0d6p-8, -0x1.489faccd5e0b7p-8, -0x1.5f81576e87c59p-5, -0x1p-1},
        {0x1.c221572ef4c13p-1, -0x1.1260a8ffc0c0cp+0, 0x1.d4350b9567c8dp-1, -0x1.48b83a5ac4e9fp-6, 0x1.0f0cf064dd592p+73, 0x1p-1, 0x1p-1, -0x1p-1},
        {0x1.1ba6d96fe1195p-11, 0x1.658d959b5baa7p-9, -0x1.41d7e9602e391p-7, -0x1.6add2f1c38278p-7, 0x1.059974d3cac8ep-9, -0x1.31e39766317fcp-8, -0x1.22bf9bb1c71d9p-5, -0x1p-1},
        {0x1.81da368298d94p-6, -0x1.5798ee2308c3ap-27, 0x1.1ccf385ebc8ap+1023, 0x1.a0ca1c05fa997p-6, 0x1.f59d8ab789d94p-4, -0x1.e777cda805592p-6, 0x0p+0, 0x0p+0},
        {-0x1.0375ee3fa8131p+3, 0x1.e16fa0eee2b49p+2, 0x1.44695abbfed99p+1, 0x1.1eaebdbc897fp+3, -0x1.b9e048abada6ap+1, -0x1.da2e8d9050a9ep+3, -0x1.10a25c9d9ea71p-2, 0x1.41fd204e22d4ap-3},
        {-0x1p+0, -0x1.1d547c0e0c5e6p+2, 0x0p+0, -0x1p+0, -0x1.0f0cf064dd592p+73, -0x1.7e73c270098f1p+3, 0x0p+0, 0x1p-1},
        {0x1.c47fff2169459p-1, 0x1.5c0a290d8c8e1p-1, -0x1.47cdfa7c1da7cp-1, -0x1.12ef8bd3962ecp-10, 0x1.c8446f05b990ep-2, 0x1.dfa562df131b6p-2, -0x1.ebc6d473d25dcp-10, -0x1p-1},
        {0x1p-1, -0x0p+0, -0x1.e585668412f45p-1, -0x1.4b5355787bc2p+1, 0x1.51d6734198e28p+3, 0x1p+0, -0x1.e591825b825e7p-5, -0x1p-1},
        {-0x1.c65884558ca17p-7, 0x1.b089f979a8825p-9, -0x1.23e955e9dc2b1p-3, 0x1.10a412cd17c31p-5, -0x1.0ac3c38e51faep-4, 0x1.6141e437a6821p-4, 0x1.b99477c706e6ep-7, -0x1p-1},
        {-0x1.91e509058c8a8p+3, 0x0p+0, 0x1.e78995cdaba8p+6, -0x1.1ccf385ebc8ap+1023, 0x1.1ccf385ebc8ap+1023, -0x0p+0, 0x1p-1, 0x1p-1},
        {0x1.1f46429aeae35p-6, -0x1.23beed339d65p-10, -0x1.c342075007729p-8, 0x1.7a294b047ab5ep-10, -0x1.f5c5f82e265ffp-10, 0x1.173adfc81b28ep-7, -0x1.92ca2c8489b07p-5, -0x1p-1},
        {0x1.1ccf385ebc8ap+1023, 0x1.19976abdfa73ap-3, (0.0 / 0.0), 0x1.2c86098c69d85p+2, 0x0.0000000000001p-1022, 0x1p+0, 0x0p+0, 0x0p+0},
        {0x1.f35d24e5aef64p-7, -0x1.f39bef59fd1b1p-7, -0x1.941126bb9460dp-6, 0x1.944714ca339bp-8, 0x1.a172947a459c5p-6, -0x1.47fba97552aa7p-7, -0x1.3b2711ac0142cp-11, 0x1p-1},
        {-0x1.9038ff1ea0246p+3, 0x1.78f0ab8c5e28dp+2, -0x1.0d07e9a3ed4bep+3, (-1.0 / 0.0), 0x0p+0, -0x1.7d784p+26, 0x1p-1, 0x1p-1},
        {-0x1.4c0610d6f5c64p-5, 0x1.c74882c1b059dp-6, -0x1.213b6a5711222p-6, -0x1.59fa2f49b21eap-4, -0x1.06006d77b59e2p-5, -0x1.8548a0c00a784p-4, -0x1.64bad232ae2f3p-6, -0x1p-1},
        {(0.0 / 0.0), -0x1.cc55ea53f510ap-4, -0x1.bfa647d691a9p-4, 0x1.0f0cf064dd592p+73, 0x1.388p+13, -0x1.614097a8b80c4p-8, 0x0p+0, 0x0p+0},
        {0x1.a30cf66da10d5p-5, -0x1.58c41c472b001p-5, -0x1.766eae3b81e4ep-6, 0x1.5c4826ed656c8p-5, 0x1.ceb5ca286594ap-6, -0x1.dad9128da7c8ap-4, -0x1.99c79c77aff41p-13, 0x1p-1},
        {-0x1p+0, (-1.0 / 0.0), -0x1.51f1fcd3fde66p+3, 0x1.0f0cf064dd592p+73, 0x1.921fb54442d18p+1, 0x1.045e37eafc914p+4, 0x1p-1, 0x1p-1},
        {-0x1.782be6bda2b9cp+3, 0x1.99cb5641214a6p+0, -0x1.560d49241e988p+4, -0x1.00b9f088baa29p-6, 0x1.1fdc7b1d8c963p+3, -0x1.2eedd65e1554dp+1, -0x1p-1, -0x1.b2062b9e83de7p-2},
        {-0x1.01c8a5990c809p-4, (0.0 / 0.0), 0x1.1ec83b757c96fp-4, 0x1.0fd58a4538582p-4, 0x1.93f66febdff4dp-3, 0x1.56b33253a801ep-6, 0x0p+0, 0x0p+0},
        {-0x1.2f50606884943p-1, -0x1.020160a7c0ec9p-3, -0x1.28f43c271d507p-4, 0x1.bd63691e4212p-4, -0x1.ebf9c6f29cc75p-6, 0x1.644841116ac21p-3, 0x1p-1, -0x1.1295076bb3c3fp-2},
        {0x1.0f0cf064dd592p+73, -0x0.fd1d7d505cd02p-1022, (-1.0 / 0.0), -0x1.806baf2bd9a63p-7, -0x1p+0, 0x1.388p+13, 0x0p+0, 0x0p+0},
        {0x1.8a6c2a3e96011p+5, 0x1.01dadade13b21p+4, -0x1.74e35bf91fddfp+6, 0x1.1f281fb481138p+8, 0x1.601a7b95e14c9p+6, -0x1.c7b7c634cc12bp+6, 0x1p-1, 0x1p-1},
        {-0x1.37daec3104842p+6, 0x1.1655668296593p+3, -0x1.36f23be4af2ap+7, (0.0 / 0.0), -0x1.6f41dac7b81d2p+5, 0x1.ea821c0661c6cp+6, 0x0p+0, 0x0p+0}
    };
    int row, index;
    for (row = 0; row < 32; row++) {
        double control[2];
        law(rows[row], rows[row] + 3, control);
        for (index = 0; index < 2; index++) {
            const double expected = rows[row][6 + index];
            if (memcmp(&control[index], &expected, sizeof expected) != 0) {
                printf("row %d: control[%d] is %a, expected %a\n", row, index, control[index], expected);
                return 1;
            }
        }
    }
    printf("ok: %d rows\n", row);
    return 0;
}
#endif
