/* draws.h: seeded pseudo-random numbers for tests.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The state is any number: the seed. */
typedef struct draws {
    uint64_t state;
} draws;

/* 64 random bits (splitmix64). */
uint64_t draw_bits(draws *d);

/* A multiple of 2^-24 in [0,1), exact in both precisions. */
double draw(draws *d);

/* Uniform in [low, high], and in its logarithm (low > 0). */
double draw_between(draws *d, double low, double high);
double draw_log(draws *d, double low, double high);

/* A unit vector, uniform over the upper hemisphere. */
void draw_direction(draws *d, double v[3]);

#ifdef __cplusplus
}
#endif
