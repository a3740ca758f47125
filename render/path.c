/* path.c: the paths of a tile, stage by stage (stages.h).
 * SPDX-License-Identifier: MIT */
#include "render/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/stages.h"

_Static_assert(PATHS%LOOP_LANES == 0, "arrays hold whole vectors");
_Static_assert(ROOM*sizeof(float)%64 == 0, "arrays follow each other in whole cache lines");

path_batch *path_batch_create(const scene *s)
{
    path_batch *batch = aligned_alloc(64, (sizeof *batch + 63)/64*64);
    if (!batch) return NULL;
    memset(batch, 0, sizeof *batch); /* loops run over whole vectors, over lanes that nothing was put in */
    const float none[3] = {0, 0, 0};
    batch->black = facet_bsdf_metallic_roughness(none, 0, 1, 0, 0, none);
    batch->n_of_material = malloc((s->n_materials + 2)*sizeof *batch->n_of_material);
    if (!batch->n_of_material) {
        free(batch);
        return NULL;
    }
    return batch;
}

void path_batch_destroy(path_batch *batch)
{
    if (batch) free(batch->n_of_material);
    free(batch);
}

/* Hands the radiance to the film; what is not finite is counted and black. */
static void deposit(const path_batch *batch, const path_context *c, tile where, uint32_t sample_index, film *to,
                    path_counts *counts)
{
    uint32_t slot = 0;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++, slot++) {
            float rgb[3] = {batch->radiance.x[slot], batch->radiance.y[slot], batch->radiance.z[slot]};
            if (!(isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]))) {
                counts->n_bad++;
                if (counts->n_reported < RENDER_MAX_REPORTED)
                    counts->bad[counts->n_reported++] = (bad_sample){x + (uint32_t)c->settings->crop_x,
                                                                     y + (uint32_t)c->settings->crop_y, sample_index};
                rgb[0] = rgb[1] = rgb[2] = 0;
            }
            film_add(to, x, y, rgb);
            if (c->keeps_features) {
                const feature_list *f = &batch->features;
                const feature seen = {.albedo = {f->albedo.x[slot], f->albedo.y[slot], f->albedo.z[slot]},
                                      .normal = {f->normal.x[slot], f->normal.y[slot], f->normal.z[slot]},
                                      .distance = f->distance[slot]};
                film_add_feature(to, x, y, &seen);
            }
        }
}

void path_batch_run(path_batch *batch, const path_context *c, tile where, uint32_t sample_index, film *to,
                    path_counts *counts)
{
    stage_generate(batch, c, where, sample_index);
    counts->n_paths += batch->lists[0].n;
    for (uint32_t event = 0; batch->lists[event & 1].n > 0; event++) {
        path_list *list = &batch->lists[event & 1], *next = &batch->lists[~event & 1];
        const uint32_t group = 1 + event*GROUPS_PER_EVENT;
        if (c->has_mixed_surfaces || event + 1 >= ROULETTE_START) {
            uint32_t *const u[3] = {c->has_mixed_surfaces ? batch->chance[0] : NULL, batch->chance[1], NULL};
            render_loops_chosen()->points(&c->sampler, list->n, list->pixel, list->index, group + GROUP_CHANCE, u);
        }
        stage_trace(batch, c, list, event == 0, counts);
        batch->vertices = &batch->vertex_lists[event < 2 ? event : 2];
        stage_meet(batch, c, list, c->has_gradients && event == 0, event >= c->settings->depth);
        if (c->has_gradients && event == 1) gradient_of_second_vertices(batch);
        stage_connect(batch, c, group, counts);
        if (c->has_gradients && event == 0) gradient_of_first_lights(batch, c);
        if (c->has_gradients && event == 1) gradient_of_lights(batch);
        stage_scatter(batch, c, list, event + 1, group, next);
        if (c->has_gradients && event == 0) gradient_start(batch);
    }
    if (c->has_gradients) gradient_solve(batch, c, where, counts);
    deposit(batch, c, where, sample_index, to, counts);
}
