/* sampler.c: Owen-scrambled Sobol' points and independent random numbers.
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

#include "render/sampler_point.h"

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
    const uint32_t seed = seed_for(stream.pixel, group);
    sample_point p;
    if (s->kind == SAMPLER_RANDOM) {
        for (uint32_t d = 0; d < 3; d++) p.u[d] = random_fraction(stream.index, seed, d);
        return p;
    }
    const uint32_t index = shuffled_index(stream.index, seed, s->index_mask);
    uint32_t digits[3] = {index, sobol_second(index), 0};
    for (uint32_t bit = 0; s->index_mask >> bit; bit++) digits[2] = sobol_third_digit(digits[2], index, bit);
    for (uint32_t d = 0; d < 3; d++) p.u[d] = scrambled_fraction(digits[d], seed, d);
    return p;
}
