/* sampler.c: Owen-scrambled Sobol' points and independent random numbers.
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

/* Direction numbers of the first three Sobol' dimensions, one 32-bit column per bit of the index.  The first is
 * van der Corput's; the others follow from the primitive polynomials x + 1 (m = 1) and x^2 + x + 1 (m = 1, 3)
 * by v_k = v_{k-1} ^ v_{k-1} >> 1 and v_k = v_{k-1} ^ v_{k-2} ^ v_{k-2} >> 2 (Joe and Kuo 2008). */
static const uint32_t columns[3][32] = {
    {0x80000000u, 0x40000000u, 0x20000000u, 0x10000000u, 0x08000000u, 0x04000000u, 0x02000000u, 0x01000000u,
     0x00800000u, 0x00400000u, 0x00200000u, 0x00100000u, 0x00080000u, 0x00040000u, 0x00020000u, 0x00010000u,
     0x00008000u, 0x00004000u, 0x00002000u, 0x00001000u, 0x00000800u, 0x00000400u, 0x00000200u, 0x00000100u,
     0x00000080u, 0x00000040u, 0x00000020u, 0x00000010u, 0x00000008u, 0x00000004u, 0x00000002u, 0x00000001u},
    {0x80000000u, 0xc0000000u, 0xa0000000u, 0xf0000000u, 0x88000000u, 0xcc000000u, 0xaa000000u, 0xff000000u,
     0x80800000u, 0xc0c00000u, 0xa0a00000u, 0xf0f00000u, 0x88880000u, 0xcccc0000u, 0xaaaa0000u, 0xffff0000u,
     0x80008000u, 0xc000c000u, 0xa000a000u, 0xf000f000u, 0x88008800u, 0xcc00cc00u, 0xaa00aa00u, 0xff00ff00u,
     0x80808080u, 0xc0c0c0c0u, 0xa0a0a0a0u, 0xf0f0f0f0u, 0x88888888u, 0xccccccccu, 0xaaaaaaaau, 0xffffffffu},
    {0x80000000u, 0xc0000000u, 0x60000000u, 0x90000000u, 0xe8000000u, 0x5c000000u, 0x8e000000u, 0xc5000000u,
     0x68800000u, 0x9cc00000u, 0xee600000u, 0x55900000u, 0x80680000u, 0xc09c0000u, 0x60ee0000u, 0x90550000u,
     0xe8808000u, 0x5cc0c000u, 0x8e606000u, 0xc5909000u, 0x6868e800u, 0x9c9c5c00u, 0xeeee8e00u, 0x5555c500u,
     0x8000e880u, 0xc0005cc0u, 0x60008e60u, 0x9000c590u, 0xe8006868u, 0x5c009c9cu, 0x8e00eeeeu, 0xc5005555u},
};

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
    uint32_t index = reverse_bits(scramble_reversed(reverse_bits(stream.index), seed)) & s->index_mask;
    for (int bit = 0; index; bit++, index >>= 1)
        if (index & 1)
            for (int d = 0; d < 3; d++) p.u[d] ^= columns[d][bit];
    for (uint32_t d = 0; d < 3; d++)
        p.u[d] = reverse_bits(scramble_reversed(reverse_bits(p.u[d]), hash_pair(seed, d + 1)));
    return p;
}
