/* tile_plan.c: which samples of which tiles are still to be rendered.
 * SPDX-License-Identifier: MIT */
#include "render/tile_plan.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"

/* Samples per pixel from which on an estimate of the noise ends anything. */
enum { LEAST_TO_JUDGE = 16 };

tile tile_plan_at(const tile_plan *plan, uint32_t i)
{
    const uint32_t x0 = i%plan->n_tiles_x*TILE_SIZE, y0 = i/plan->n_tiles_x*TILE_SIZE;
    const uint32_t w = (uint32_t)plan->state->film.width, h = (uint32_t)plan->state->film.height;
    return (tile){x0, y0, x0 + TILE_SIZE < w ? x0 + TILE_SIZE : w, y0 + TILE_SIZE < h ? y0 + TILE_SIZE : h};
}

uint32_t tile_plan_position(const tile_plan *plan, tile where)
{
    const film *f = &plan->state->film;
    return f->pixels[where.y0*f->width + where.x0].n;
}

static uint64_t pixels_of(tile where)
{
    return (uint64_t)(where.x1 - where.x0)*(where.y1 - where.y0);
}

/* Passes grow, so that the first pictures come soon and later ones waste no time on waiting for the last tile. */
uint32_t tile_plan_pass_end(const tile_plan *plan, uint32_t position)
{
    const uint32_t length = position < 4 ? 1 : position/4 < 16 ? position/4 : 16, left = plan->n_share - position;
    return position + (length < left ? length : left);
}

/* ---- Noise --------------------------------------------------------------------------------------- */

/* The deviation of a tile over the one that is asked for: the target's share of the geometric mean of the tile's and
 * the picture's luminance, since the eye forgives less in the dark.  Were it so in all tiles, the noise of the picture
 * would be below the target: the mean of square roots is at most the root of the mean. */
static double excess_of(const tile_plan *plan, tile where)
{
    film_error e;
    if (!film_measure(&plan->state->film, where.x0, where.y0, where.x1, where.y1, &e)) return INFINITY;
    const double tolerance = plan->noise_target*sqrt(fmax(e.luminance, 0)*plan->state->mean_luminance);
    return e.deviation > 0 ? e.deviation/tolerance : 0;
}

void tile_plan_judge(const tile_plan *plan, uint32_t i)
{
    if (plan->noise_target > 0 && plan->state->mean_luminance > 0 && !plan->is_done[i])
        plan->is_done[i] = excess_of(plan, tile_plan_at(plan, i)) <= 1;
}

/* The end of the last pass that does not go beyond a position. */
static uint32_t last_pass_end(const tile_plan *plan, uint32_t position)
{
    uint32_t end = 0;
    while (end < position && tile_plan_pass_end(plan, end) <= position) end = tile_plan_pass_end(plan, end);
    return end;
}

/* Whether all tiles that are not done are at the end of the same pass: what follows from the noise then is the same
 * however the samples came there. */
static bool is_between_passes(const tile_plan *plan)
{
    const uint32_t least = tile_plan_least(plan);
    bool is_even = last_pass_end(plan, least) == least;
    for (uint32_t i = 0; i < plan->n_tiles && is_even; i++)
        is_even = plan->is_done[i] || tile_plan_position(plan, tile_plan_at(plan, i)) == least;
    return is_even;
}

void tile_plan_look(tile_plan *plan)
{
    render_state *state = plan->state;
    const film *f = &state->film;
    film_error e;
    plan->noise = film_noise(f);
    if (!(plan->noise_target > 0)) return;
    if (state->mean_luminance == 0 && tile_plan_least(plan) >= LEAST_TO_JUDGE && is_between_passes(plan) &&
        film_measure(f, 0, 0, f->width, f->height, &e))
        state->mean_luminance = e.luminance;
    for (uint32_t i = 0; i < plan->n_tiles; i++) {
        const uint32_t position = tile_plan_position(plan, tile_plan_at(plan, i));
        if (last_pass_end(plan, position) == position) tile_plan_judge(plan, i);
    }
}

uint32_t tile_plan_passed(const tile_plan *plan)
{
    const uint32_t least = tile_plan_least(plan), most = tile_plan_most(plan);
    return last_pass_end(plan, least < most ? least : most);
}

bool tile_plan_is_quiet(const tile_plan *plan)
{
    if (!(plan->noise_target > 0 && plan->state->mean_luminance > 0)) return false;
    bool are_all_done = true;
    for (uint32_t i = 0; i < plan->n_tiles; i++) are_all_done &= plan->is_done[i];
    return are_all_done || (plan->noise >= 0 && plan->noise <= plan->noise_target && is_between_passes(plan));
}

/* ---- Counts -------------------------------------------------------------------------------------- */

uint32_t tile_plan_least(const tile_plan *plan)
{
    uint32_t least = plan->n_share;
    for (uint32_t i = 0; i < plan->n_tiles; i++) {
        const uint32_t position = tile_plan_position(plan, tile_plan_at(plan, i));
        if (!plan->is_done[i] && position < least) least = position;
    }
    return least;
}

uint32_t tile_plan_most(const tile_plan *plan)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < plan->n_tiles; i++) {
        const uint32_t position = tile_plan_position(plan, tile_plan_at(plan, i));
        if (position > most) most = position;
    }
    return most;
}

uint64_t tile_plan_samples(const tile_plan *plan)
{
    uint64_t n = 0;
    for (uint32_t i = 0; i < plan->n_tiles; i++) {
        const tile where = tile_plan_at(plan, i);
        n += pixels_of(where)*tile_plan_position(plan, where);
    }
    return n;
}

uint64_t tile_plan_samples_left(const tile_plan *plan)
{
    uint64_t n = 0;
    for (uint32_t i = 0; i < plan->n_tiles; i++) {
        const tile where = tile_plan_at(plan, i);
        if (!plan->is_done[i]) n += pixels_of(where)*(plan->n_share - tile_plan_position(plan, where));
    }
    if (!(plan->noise_target > 0 && plan->noise > 0)) return n;
    /* The error falls with the square root of the samples. */
    const double factor = plan->noise/plan->noise_target;
    return (uint64_t)fmin((double)n, fmax(factor*factor - 1, 0)*(double)tile_plan_samples(plan));
}

/* ---- Beginning ----------------------------------------------------------------------------------- */

static facet_status check_tile(const tile_plan *plan, uint32_t i, facet_error *why)
{
    const film *f = &plan->state->film;
    const tile where = tile_plan_at(plan, i);
    const uint32_t position = tile_plan_position(plan, where);
    bool is_even = position <= plan->n_share;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++) is_even &= f->pixels[y*f->width + x].n == position;
    if (!is_even)
        return facet_error_set(why, FACET_BAD_VALUE, "", "tile %u has not the samples that a render gives it", i);
    return FACET_OK;
}

facet_status tile_plan_create(const render_settings *r, render_state *state, tile_plan *plan, facet_error *why)
{
    film *f = &state->film;
    *plan = (tile_plan){.state = state, .noise_target = r->noise_target, .noise = -1};
    plan->n_tiles_x = (uint32_t)((r->crop_w + TILE_SIZE - 1)/TILE_SIZE);
    plan->n_tiles = plan->n_tiles_x*(uint32_t)((r->crop_h + TILE_SIZE - 1)/TILE_SIZE);
    render_share(r->spp, r->shard, r->n_shards, &plan->first_sample, &plan->n_share);
    plan->is_done = calloc(plan->n_tiles, sizeof *plan->is_done);
    facet_status status = plan->is_done ? FACET_OK : FACET_NO_MEMORY;
    if (!status && !f->pixels) {
        *state = (render_state){0};
        status = film_create(r->crop_w, r->crop_h, f);
        if (!status && r->keeps_features) status = film_keep_features(f);
    }
    if (status) return facet_error_set(why, status, "size", "no memory for a picture of %zux%zu", r->crop_w, r->crop_h);
    if (f->width != r->crop_w || f->height != r->crop_h)
        return facet_error_set(why, FACET_BAD_VALUE, "size", "%zux%zu is not the picture's %zux%zu", f->width,
                               f->height, r->crop_w, r->crop_h);
    if (!f->features != !r->keeps_features)
        return facet_error_set(why, FACET_BAD_VALUE, "", "a film %s features cannot be continued %s them",
                               f->features ? "with" : "without", f->features ? "without" : "with");
    for (uint32_t i = 0; i < plan->n_tiles && !status; i++) status = check_tile(plan, i, why);
    return status;
}

void tile_plan_destroy(tile_plan *plan)
{
    free(plan->is_done);
    *plan = (tile_plan){0};
}
