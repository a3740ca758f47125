/* tracer.c: the tree or the list.
 * SPDX-License-Identifier: MIT */
#include "render/tracer.h"

#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "render/embree.h"
#include "render/loops.h"

struct tracer {
    embree_scene *tree; /* NULL: the list is traced */
    linear_scene list;
};

_Static_assert((int)TRACER_LANES == (int)LOOP_LANES, "arrays of rays have room for the loops");

facet_status tracer_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                           const void *opacity_user, tracer **result, facet_error *why)
{
    tracer *t = calloc(1, sizeof *t);
    if (!t) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the scene");
    const bool is_free = !isa || strcmp(isa, "any") == 0;
    if (is_free && linear_is_enough(s)) {
        linear_fill(s, &t->list);
    } else {
        const facet_status status = embree_scene_create(s, is_free ? NULL : isa, n_threads, opacity, opacity_user,
                                                        &t->tree, why);
        if (status) {
            free(t);
            return status;
        }
    }
    *result = t;
    return FACET_OK;
}

void tracer_destroy(tracer *t)
{
    if (!t) return;
    embree_scene_destroy(t->tree);
    free(t);
}

void tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h)
{
    if (t->tree) embree_nearest(t->tree, n, r, is_coherent, h);
    else render_loops_chosen()->nearest(&t->list, n, r, h);
}

void tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked)
{
    if (t->tree) embree_blocked(t->tree, n, r, is_blocked);
    else render_loops_chosen()->blocked(&t->list, n, r, is_blocked);
}

/* Room for one ray, which stands in all lanes. */
typedef struct one_ray {
    float of[8][TRACER_LANES];
    uint32_t seed[TRACER_LANES];
} one_ray;

static rays rays_of_one(const ray *r, one_ray *room)
{
    const float fields[8] = {r->origin[0],    r->origin[1],    r->origin[2], r->direction[0],
                             r->direction[1], r->direction[2], r->t_min,     r->t_max};
    for (int i = 0; i < TRACER_LANES; i++) {
        for (int k = 0; k < 8; k++) room->of[k][i] = fields[k];
        room->seed[i] = r->seed;
    }
    return (rays){.origin = {room->of[0], room->of[1], room->of[2]},
                  .direction = {room->of[3], room->of[4], room->of[5]},
                  .t_min = room->of[6],
                  .t_max = room->of[7],
                  .seed = room->seed};
}

bool tracer_intersect(const tracer *t, const ray *r, hit *found)
{
    one_ray room;
    float numbers[3][TRACER_LANES];
    uint32_t words[2][TRACER_LANES];
    const hits h = {numbers[0], numbers[1], numbers[2], words[0], words[1]};
    tracer_nearest(t, 1, rays_of_one(r, &room), false, h);
    if (h.instance[0] == NO_HIT) return false;
    *found = (hit){h.t[0], h.u[0], h.v[0], h.instance[0], h.primitive[0]};
    return true;
}

bool tracer_occluded(const tracer *t, const ray *r)
{
    one_ray room;
    uint32_t is_blocked[TRACER_LANES];
    tracer_blocked(t, 1, rays_of_one(r, &room), is_blocked);
    return is_blocked[0];
}

const char *tracer_isa(const tracer *t)
{
    return t->tree ? embree_scene_isa(t->tree) : "any";
}

void tracer_prepare_thread(void)
{
    embree_prepare_thread();
}
