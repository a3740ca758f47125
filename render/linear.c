/* linear.c: the list of all triangles and spheres.
 * SPDX-License-Identifier: MIT */
#include "render/linear.h"

#include <math.h>

bool linear_is_enough(const scene *s)
{
    size_t n = s->n_spheres;
    for (size_t i = 0; i < s->n_instances && n <= MOST_LINEAR; i++) {
        const mesh *m = &s->meshes[s->instances[i].mesh];
        if (s->materials[m->material].alpha != ALPHA_OPAQUE) return false;
        n += m->n_triangles;
    }
    return n <= MOST_LINEAR;
}

static void add_triangle(const scene *s, size_t instance_index, uint32_t primitive, linear_scene *to)
{
    const instance *in = &s->instances[instance_index];
    const mesh *m = &s->meshes[in->mesh];
    linear_triangle *t = &to->triangles[to->n_triangles];
    *t = (linear_triangle){.instance = (uint32_t)instance_index, .primitive = primitive};
    for (int k = 0; k < 3; k++)
        t->corners[k] = map_point(in->to_world, vector_of(m->positions[m->triangles[primitive][k]]));
    t->edges[0] = sub3(t->corners[2], t->corners[0]);
    t->edges[1] = sub3(t->corners[0], t->corners[1]);
    t->edges[2] = sub3(t->corners[1], t->corners[2]);
    t->normal = cross3(t->edges[1], t->edges[0]);
    if (isfinite(dot3(t->normal, t->normal)) && dot3(t->normal, t->normal) > 0) to->n_triangles++;
}

void linear_fill(const scene *s, linear_scene *to)
{
    to->n_triangles = to->n_spheres = 0;
    to->sphere_instance = (uint32_t)s->n_instances;
    for (size_t i = 0; i < s->n_instances; i++)
        for (uint32_t k = 0; k < s->meshes[s->instances[i].mesh].n_triangles; k++) add_triangle(s, i, k, to);
    for (size_t i = 0; i < s->n_spheres; i++)
        to->spheres[to->n_spheres++] = (linear_sphere){vector_of(s->spheres[i].center), s->spheres[i].radius};
}
