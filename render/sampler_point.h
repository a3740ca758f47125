/* sampler_point.h: the parts of a point of the sampler, for the loops over many (loops_text.h).
 *
 * [burley20] Burley, Practical hash-based Owen scrambling, JCGT 2020.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

/* The first three Sobol' dimensions of a point, each with its binary digits in reverse: the first digit is the lowest
 * bit.  The first dimension is van der Corput's, the index itself. */

/* The second, of the primitive polynomial x + 1: bit k of the index adds Pascal's triangle modulo 2, that is, every
 * digit j whose binary digits are a subset of those of k. */
static inline uint32_t sobol_second(uint32_t index)
{
    index ^= (index & 0xaaaaaaaau) >> 1;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xff00ff00u) >> 8;
    return index ^ index >> 16;
}

/* The third, of p = x^2 + x + 1 (m = 1, 3; Joe and Kuo 2008): bit k of the index adds x^k, where a factor p stands
 * for a step by two digits.  Hence the digits are those of the index, as a polynomial modulo 2, in the base p.  p to a
 * power of two has three terms as well: the quotient by x^16 + x^8 + 1 is what lies above x^16 and, 8 lower, above
 * x^24; it and the rest are divided by x^8 + x^4 + 1, and so on. */
static inline uint32_t sobol_third(uint32_t index)
{
    uint32_t x = index ^ (index >> 8 & 0x00ff0000u), quotient = x >> 16;
    x ^= quotient ^ (quotient << 8 & 0x0000ff00u);
    x ^= x >> 4 & 0x0f000f00u;
    quotient = x >> 8 & 0x00ff00ffu;
    x ^= quotient ^ (quotient << 4 & 0x00f000f0u);
    x ^= x >> 2 & 0x30303030u;
    quotient = x >> 4 & 0x0f0f0f0fu;
    x ^= quotient ^ (quotient << 2 & 0x0c0c0c0cu);
    x ^= x >> 1 & 0x44444444u;
    quotient = x >> 2 & 0x33333333u;
    x ^= quotient ^ (quotient << 1 & 0x22222222u);
    return x ^ (x >> 1 & 0x55555555u); /* the second number, 3, has both digits */
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/* A permutation in which each bit is flipped by a hash of the bits below it: Owen scrambling of a number whose
 * bits are reversed.  [burley20, section 3]; the multipliers are Vegdahl's. */
static inline uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x*0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x*0x05526c56u;
    x ^= x*0x53a22864u;
    return x;
}

/* A permutation of all words without a pattern to see; the constants are Wellons's. */
static inline uint32_t mix_bits(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

/* A word for each of several purposes of the same seed. */
static inline uint32_t seed_for(uint32_t seed, uint32_t purpose)
{
    return mix_bits(seed + purpose*0x9e3779b9u);
}

/* The sample's place in the group's own order, by Owen scrambling of the index: aligned runs stay runs, and so
 * stratified, but which stratum a sample gets depends on all of its index.  Were it a function of the low digits alone,
 * that of one group would determine that of every other, and no pixel would converge. */
static inline uint32_t shuffled_index(uint32_t index, uint32_t seed, uint32_t mask)
{
    return reverse_bits(scramble_reversed(reverse_bits(index), seed)) & mask;
}

/* The fraction of a dimension's digits. */
static inline uint32_t scrambled_fraction(uint32_t digits, uint32_t seed, uint32_t dimension)
{
    return reverse_bits(scramble_reversed(digits, seed_for(seed, dimension + 1)));
}

/* Three independent numbers. */
static inline uint32_t random_fraction(uint32_t index, uint32_t seed, uint32_t dimension)
{
    return seed_for(seed_for(seed, index), dimension);
}
