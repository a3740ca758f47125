/* render_state.c: what a render has done: taken up, added, developed.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "core/error.h"
#include "render/render.h"

void render_share(uint32_t spp, uint32_t shard, uint32_t n_shards, uint32_t *first, uint32_t *n)
{
    *first = n_shards ? (uint32_t)((uint64_t)spp*(shard - 1)/n_shards) : 0;
    *n = (n_shards ? (uint32_t)((uint64_t)spp*shard/n_shards) : spp) - *first;
}

facet_status render_develop(const render_state *state, render_result *result, facet_error *why)
{
    render_result made = {.spp = state->spp,
                          .mean_spp = film_mean_samples(&state->film),
                          .n_paths = state->n_paths,
                          .n_rays = state->n_rays,
                          .n_shadow_rays = state->n_shadow_rays,
                          .n_bad = state->n_bad,
                          .n_clamped = state->film.n_clamped,
                          .seconds = state->seconds,
                          .cpu_seconds = state->cpu_seconds,
                          .noise = film_noise(&state->film),
                          .isa = state->isa};
    memcpy(made.bad, state->bad, sizeof made.bad);
    if (film_develop(&state->film, &made.picture))
        return facet_error_set(why, FACET_NO_MEMORY, "size", "no memory for the finished picture");
    *result = made;
    return FACET_OK;
}

void render_state_destroy(render_state *state)
{
    film_destroy(&state->film);
    *state = (render_state){0};
}

void render_state_merge(render_state *state, const render_state *other)
{
    film_merge(&state->film, &other->film);
    for (uint64_t k = 0; k < other->n_bad && state->n_bad + k < RENDER_MAX_REPORTED; k++)
        state->bad[state->n_bad + k] = other->bad[k];
    state->n_paths += other->n_paths;
    state->n_rays += other->n_rays;
    state->n_shadow_rays += other->n_shadow_rays;
    state->n_bad += other->n_bad;
    state->seconds += other->seconds;
    state->cpu_seconds += other->cpu_seconds;
    state->spp += other->spp;
}

void render_result_destroy(render_result *result)
{
    image_destroy(&result->picture);
}
