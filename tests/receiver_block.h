/* receiver_block.h: receivers as the loops want them (render/loops.h).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/light_receiver.h"
#include "render/loop_lanes.h"

/* As many as a loop takes at a time. */
typedef struct receiver_block {
    float at[14][LOOP_LANES];
} receiver_block;

static inline light_receivers receivers_in(receiver_block *b)
{
    float(*at)[LOOP_LANES] = b->at;
    return (light_receivers){
        {at[0], at[1], at[2]}, {at[3], at[4], at[5]}, {at[6], at[7], at[8]}, at[9], at[10], at[11], at[12], at[13]};
}

static inline void put_receiver(receiver_block *b, size_t i, const light_receiver *to)
{
    const real3 given[3] = {to->position, to->normal, to->mirror};
    for (int k = 0; k < 3; k++) {
        b->at[3*k][i] = given[k].x;
        b->at[3*k + 1][i] = given[k].y;
        b->at[3*k + 2][i] = given[k].z;
    }
    b->at[9][i] = to->around;
    b->at[10][i] = to->broad;
    b->at[11][i] = to->peak;
    b->at[12][i] = to->width;
    b->at[13][i] = to->weight;
}
