/* sampler.c: streams of samples; the points themselves are in loops_text.h.
 * SPDX-License-Identifier: MIT */
#include "render/sampler.h"

#include "render/loops.h"

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
    uint32_t pixel[LOOP_LANES], index[LOOP_LANES], room[3][LOOP_LANES];
    uint32_t *const u[3] = {room[0], room[1], room[2]};
    for (int i = 0; i < LOOP_LANES; i++) {
        pixel[i] = stream.pixel;
        index[i] = stream.index;
    }
    render_loops_chosen()->points(s, 1, pixel, index, group, u);
    return (sample_point){{u[0][0], u[1][0], u[2][0]}};
}
