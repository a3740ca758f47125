/* sampler.c: streams of samples; the points themselves are in loops_text.h.
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

#include "render/loops.h"

/* The side of the squares of pixels that share a point set is 2^MOST_SIDE_BITS, if an index of 32 bits has room. */
enum { MOST_SIDE_BITS = 5 };

sampler sampler_create(sampler_kind kind, uint32_t seed, uint32_t spp)
{
    sampler s = {.kind = kind, .seed = hash_pair(seed, 0x66616365u)};
    while (s.index_mask < spp - 1) s.index_mask = s.index_mask << 1 | 1;
    for (uint32_t mask = s.index_mask; mask; mask >>= 1) s.sample_bits++;
    while (s.side_bits < MOST_SIDE_BITS && s.sample_bits + 2*s.side_bits + 2 <= 32) s.side_bits++;
    s.index_mask = (uint32_t)(((uint64_t)1 << (s.sample_bits + 2*s.side_bits)) - 1);
    return s;
}

sample_point sampler_point(const sampler *s, sample_stream stream, uint32_t group)
{
    uint32_t pixel[LOOP_LANES], index[LOOP_LANES], room[3][LOOP_LANES];
    uint32_t *const u[3] = {room[0], room[1], room[2]};
    for (int i = 0; i < LOOP_LANES; i++) {
        pixel[i] = stream.pixel;
        index[i] = stream.index;
    }
    render_loops_chosen()->points(s, 1, pixel, index, group, u);
    return (sample_point){{u[0][0], u[1][0], u[2][0]}};
}
