/* tile_plan.h: which samples of which tiles are still to be rendered.
 *
 * Every tile goes through the same passes, whose ends depend on nothing but the number of samples, and stops at the end
 * of one: when it has all samples or, with a noise target, when its own error is small enough for it.  That follows
 * from the tile's own sums, so that a render which was stopped and continued ends each tile where it would have ended.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "render/path.h"
#include "render/render.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tile_plan {
    render_state *state;
    uint32_t n_tiles_x, n_tiles;
    uint32_t first_sample, n_share; /* the samples of each pixel that are to be rendered */
    double noise_target;            /* 0: none */
    uint8_t *is_done;               /* [n_tiles] has as small an error as is asked for */
    double noise;                   /* film_noise when tile_plan_look was last called */
} tile_plan;

/* Makes an empty state's film, or takes up the positions of a state's tiles.  settings: crop filled in. */
facet_status tile_plan_create(const render_settings *settings, render_state *state, tile_plan *plan, facet_error *why);
void tile_plan_destroy(tile_plan *plan);

tile tile_plan_at(const tile_plan *plan, uint32_t i);

/* The samples that each pixel of a tile has. */
uint32_t tile_plan_position(const tile_plan *plan, tile where);

/* Where the pass ends that begins after so many samples per pixel. */
uint32_t tile_plan_pass_end(const tile_plan *plan, uint32_t position);

/* To be called when tile i has come to the end of a pass: marks it as done if it is.  Threads may call for different
 * tiles at once. */
void tile_plan_judge(const tile_plan *plan, uint32_t i);

/* Estimates the noise and judges all tiles that are at the end of a pass, from the first pass on after which the noise
 * can be judged by.  No thread may be at work. */
void tile_plan_look(tile_plan *plan);

/* Whole passes that all tiles have behind them which are not done, in samples per pixel. */
uint32_t tile_plan_passed(const tile_plan *plan);

/* The least position of tiles that are not done; n_share if all are. */
uint32_t tile_plan_least(const tile_plan *plan);

/* The largest position of all. */
uint32_t tile_plan_most(const tile_plan *plan);

/* Samples of all pixels: those that there are, and about as many as the targets still ask for. */
uint64_t tile_plan_samples(const tile_plan *plan);
uint64_t tile_plan_samples_left(const tile_plan *plan);

/* Whether the noise is what is asked for, in the picture at the end of a pass, or in every tile of it. */
bool tile_plan_is_quiet(const tile_plan *plan);

#ifdef __cplusplus
}
#endif
