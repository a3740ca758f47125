/* demo_scene.c: spheres of the models' materials in a small studio.
 * SPDX-License-Identifier: MIT */
#include "render/demo_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "render/geometry.h"

typedef struct look {
    const char *name, *spec;
} look;

static const look looks[] = {
    {"plastic", "beckmann alpha=.15 ior=1.5 kd=.03,.14,.32"},
    {"steel", "ggx alpha_x=.06 alpha_y=.35 ks=.67,.65,.62"},
    {"gold", "ggx alpha=.12 ks=.95,.68,.3"},
    {"glass", "glass ior=1.5"},
    {"clay", "lambert kd=.55,.24,.14"},
};

static facet_status add_look(scene *s, const look *l, size_t *index, facet_error *why)
{
    facet_material parsed;
    facet_status status = facet_material_parse(l->spec, &parsed, why);
    if (status) return status;
    material m;
    status = material_default(l->name, &m);
    if (status) return facet_error_set(why, status, l->name, "no memory for a material");
    m.kind = SURFACE_BSDF;
    status = facet_bsdf_prepare(&parsed, &m.bsdf, why);
    if (status) goto fail;
    status = scene_add_material(s, &m, index);
    if (!status) return FACET_OK;
    facet_error_set(why, status, l->name, "no memory for a material");
fail:
    material_destroy(&m);
    return status;
}

static facet_status fill(scene *s, facet_error *why)
{
    for (size_t i = 0; i < sizeof looks/sizeof *looks; i++) {
        sphere ball         = {.center = {2.4f*((float)i - 2), 1, 0}, .radius = 1};
        facet_status status = add_look(s, &looks[i], &ball.material, why);
        if (status) return status;
        status = scene_add_sphere(s, &ball, NULL);
        if (status) return facet_error_set(why, status, "", "no memory for a sphere");
    }
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    const facet_status status = scene_add_framing_camera(s, NULL);
    if (status) return facet_error_set(why, status, "", "no memory for a camera");
    return FACET_OK;
}

facet_status demo_scene_create(scene **result, facet_error *why)
{
    scene *s = scene_create();
    if (!s) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the demo scene");
    const facet_status status = fill(s, why);
    if (status) scene_destroy(s);
    else *result = s;
    return status;
}
