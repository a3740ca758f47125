/* sampler.c: Owen-scrambled Sobol' points and independent random numbers.
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

/* The first three Sobol' dimensions of a point, each with its binary digits in reverse: the first digit is the lowest
 * bit.  The first dimension is van der Corput's, the index itself. */

/* The second, of the primitive polynomial x + 1: bit k of the index adds Pascal's triangle modulo 2, that is, every
 * digit j whose binary digits are a subset of those of k. */
static uint32_t sobol_second(uint32_t index)
{
    index ^= (index & 0xaaaaaaaau) >> 1;
    index ^= (index & 0xccccccccu) >> 2;
    index ^= (index & 0xf0f0f0f0u) >> 4;
    index ^= (index & 0xff00ff00u) >> 8;
    return index ^ index >> 16;
}

/* The third, of x^2 + x + 1 (m = 1, 3): v_k = v_{k-1} ^ v_{k-2} ^ v_{k-2} >> 2 before reversal (Joe and Kuo 2008). */
static uint32_t sobol_third(uint32_t index)
{
    static const uint32_t columns[32] = {
        0x00000001u, 0x00000003u, 0x00000006u, 0x00000009u, 0x00000017u, 0x0000003au, 0x00000071u, 0x000000a3u,
        0x00000116u, 0x00000339u, 0x00000677u, 0x000009aau, 0x00001601u, 0x00003903u, 0x00007706u, 0x0000aa09u,
        0x00010117u, 0x0003033au, 0x00060671u, 0x000909a3u, 0x00171616u, 0x003a3939u, 0x00717777u, 0x00a3aaaau,
        0x01170001u, 0x033a0003u, 0x06710006u, 0x09a30009u, 0x16160017u, 0x3939003au, 0x77770071u, 0xaaaa00a3u};
    uint32_t digits = 0;
    for (int bit = 0; index; bit++, index >>= 1) digits ^= (0u - (index & 1u)) & columns[bit];
    return digits;
}

static uint32_t reverse_bits(uint32_t x)
{
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    return x >> 16 | x << 16;
}

/* A permutation in which each bit is flipped by a hash of the bits below it: Owen scrambling of a number whose
 * bits are reversed.  [burley20, section 3]; the multipliers are Vegdahl's. */
static uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x*0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1u;
    x ^= x*0x05526c56u;
    x ^= x*0x53a22864u;
    return x;
}

sampler sampler_create(sampler_kind kind, uint32_t seed, uint32_t spp)
{
    sampler s = {.kind = kind, .seed = hash_pair(seed, 0x66616365u)};
    while (s.index_mask < spp - 1) s.index_mask = s.index_mask << 1 | 1;
    return s;
}

sample_stream sampler_start(const sampler *s, uint32_t x, uint32_t y, uint32_t index)
{
    return (sample_stream){.pixel = hash_pair(hash_pair(s->seed, x), y), .index = index};
}

sample_point sampler_point(const sampler *s, sample_stream stream, uint32_t group)
{
    const uint32_t seed = hash_pair(stream.pixel, group);
    sample_point p = {{0, 0, 0}};
    if (s->kind == SAMPLER_RANDOM) {
        const uint32_t base = hash_pair(seed, stream.index);
        for (uint32_t d = 0; d < 3; d++) p.u[d] = hash_pair(base, d);
        return p;
    }
    /* Another order, by Owen scrambling of the index itself: aligned runs stay runs, and so stratified, but which
     * stratum a sample gets depends on all of its index.  Were it a function of the low digits alone, that of one
     * group would determine that of every other, and no pixel would converge. */
    const uint32_t index = reverse_bits(scramble_reversed(reverse_bits(stream.index), seed)) & s->index_mask;
    const uint32_t digits[3] = {index, sobol_second(index), sobol_third(index)};
    for (uint32_t d = 0; d < 3; d++) p.u[d] = reverse_bits(scramble_reversed(digits[d], hash_pair(seed, d + 1)));
    return p;
}
