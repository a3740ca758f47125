/* sampler.h: the numbers in [0,1) that place a path: pixel position, lobes, directions, lights.
 *
 * sobol: each group of up to three dimensions is a Sobol' point set of its own, whose order is shuffled and
 * whose digits are Owen-scrambled by hashes of place, group and seed, so that groups are independent of
 * each other while each stays well spread over the samples of a pixel.  [burley20] Burley, Practical
 * hash-based Owen scrambling, JCGT 2020.  Squares of pixels share a point set, whose aligned runs are their quarters,
 * and the quarters' quarters, down to pixels: neighbours complement each other, and what error is left is blue noise.
 * [ahmed20] Ahmed and Wonka, Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering
 * of pixels, 2020.  random: independent numbers by the same hashes.
 *
 * A number depends only on (seed, pixel, sample, group): never on threads or order.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "render/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What all paths of a picture share. */
typedef struct sampler {
    sampler_kind kind;
    uint32_t seed;
    uint32_t sample_bits; /* k with 2^k >= samples per pixel */
    uint32_t side_bits;   /* squares of 2^side_bits pixels a side share a point set */
    uint32_t index_mask;  /* 2^(k + 2 side_bits) - 1: of its points */
} sampler;

sampler sampler_create(sampler_kind kind, uint32_t seed, uint32_t spp);

/* One path's position in its sequence. */
typedef struct sample_stream {
    uint32_t pixel; /* hash of the pixel's square and the seed */
    uint32_t index; /* of the point: the pixel's place in its square, then the sample's in the pixel */
} sample_stream;

/* A well-mixed 32-bit hash of two. */
static inline uint32_t hash_pair(uint32_t a, uint32_t b)
{
    uint64_t x = ((uint64_t)a << 32 | b) + 0x9e3779b97f4a7c15u; /* the finaliser of splitmix64 */
    x = (x ^ x >> 30)*0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27)*0x94d049bb133111ebu;
    return (uint32_t)(x >> 32) ^ (uint32_t)x;
}

/* The binary digits of two numbers below 2^8 in turn: a place on a curve through a square that visits each quarter in
 * one go. */
static inline uint32_t interleave(uint32_t x, uint32_t y)
{
    uint32_t digits = x | y << 16;
    digits = (digits | digits << 4) & 0x0f0f0f0fu;
    digits = (digits | digits << 2) & 0x33333333u;
    digits = (digits | digits << 1) & 0x55555555u;
    return (digits & 0xffffu) | digits >> 16 << 1;
}

static inline sample_stream sampler_start(const sampler *s, uint32_t x, uint32_t y, uint32_t index)
{
    const uint32_t mask = (1u << s->side_bits) - 1;
    const sample_stream stream = {.pixel = hash_pair(hash_pair(s->seed, x >> s->side_bits), y >> s->side_bits),
                                  .index = interleave(x & mask, y & mask) << s->sample_bits | index};
    return stream;
}

/* The three numbers of a group as 32-bit fractions.  Groups are numbered by the integrator. */
typedef struct sample_point {
    uint32_t u[3];
} sample_point;
sample_point sampler_point(const sampler *s, sample_stream stream, uint32_t group);

/* A 32-bit fraction as a float in [0, 1 - 2^-24]. */
static inline float fraction(uint32_t u)
{
    return (float)(u >> 8)*0x1p-24f;
}

#ifdef __cplusplus
}
#endif
