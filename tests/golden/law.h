/*
 * law: feedback law of the plant 'unicycle'
 *   sha256 3cafb29601e1af8c8574e3798686527122b3c9484f3572dba5e41c68aba79c89
 *   state[0], target[0]: x in m
 *   state[1], target[1]: y in m
 *   state[2], target[2]: theta in rad
 *   control[0]: v in m/s, from -0.5 to 0.5
 *   control[1]: omega in rad/s, from -0.5 to 0.5
 */
#ifndef LAW_H
#define LAW_H

#ifdef __cplusplus
extern "C" {
#endif

/* The saturated control at a state and a target; no state between calls, so any number of threads may call it. */
void law(const double state[3], const double target[3], double control[2]);

#ifdef __cplusplus
}
#endif

#endif
