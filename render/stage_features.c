/* stage_features.c: what paths see first, for denoisers and compositing.
 *
 * The albedo is the mean weight of scattered directions: their integral of f cos over all directions, without any cost.
 * What only emits has its radiance for an albedo, up to 1, so that its picture has edges for a denoiser, too.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>

void feature_start(path_batch *batch, uint32_t n)
{
    feature_list *f = &batch->features;
    for (uint32_t slot = 0; slot < n; slot++) {
        set3(&f->albedo, slot, splat3(0));
        set3(&f->normal, slot, splat3(0));
        f->distance[slot] = INFINITY;
        f->is_known[slot] = false;
    }
}

static void set_albedo(path_batch *batch, const path_list *list, uint32_t i, real3 albedo)
{
    const uint32_t slot = list->slot[i];
    set3(&batch->features.albedo, slot, min3(mul3(get3(&list->throughput, i), albedo), splat3(1)));
    batch->features.is_known[slot] = true;
}

void feature_of_sky(path_batch *batch, const path_list *list, uint32_t i, real3 radiance)
{
    if (!batch->features.is_known[list->slot[i]]) set_albedo(batch, list, i, radiance);
}

/* Where it lies, if this is the first.  Returns whether albedo and normal are open yet. */
static bool meet(path_batch *batch, const path_list *list, uint32_t i, real3 normal)
{
    feature_list *f = &batch->features;
    const uint32_t slot = list->slot[i];
    if (list->lobe[i] == 0) f->distance[slot] = batch->t[i];
    if (f->is_known[slot]) return false;
    set3(&f->normal, slot, normal);
    return true;
}

void feature_of_surface(path_batch *batch, const path_list *list, uint32_t i, const surface *at)
{
    if (meet(batch, list, i, at->shading.n) && !at->scatters) set_albedo(batch, list, i, add3(at->emission, at->unlit));
}

void feature_of_vertex(path_batch *batch, const path_list *list, uint32_t k)
{
    const vertex_list *v = batch->vertices;
    if (v->path[k] != NO_PATH) meet(batch, list, v->path[k], get3(&v->up, k));
}

void feature_of_scattering(path_batch *batch, const path_list *list, uint32_t k)
{
    const vertex_list *v = batch->vertices;
    const uint32_t i = v->path[k];
    if (i == NO_PATH) return;
    const bool is_found = v->pdf[k] > 0;
    if (batch->features.is_known[list->slot[i]] || (is_found && v->lobe[k] & FACET_DELTA)) return;
    set_albedo(batch, list, i, is_found ? get3(&v->f, k) : splat3(0));
}
