/* build_scene.h: scenes for the benchmarks; a failure ends the program.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/scene.h"

static inline void check(facet_status status, const char *what)
{
    if (status == FACET_OK) return;
    fprintf(stderr, "benchmark: %s: %s\n", what, facet_status_string(status));
    exit(4);
}

static inline void *allocate(size_t n, size_t size)
{
    void *p = calloc(n, size);
    if (!p) check(FACET_NO_MEMORY, "scene");
    return p;
}

static inline size_t add_material(scene *s, const char *spec, float emission)
{
    material m;
    facet_material described;
    facet_error why = {FACET_OK, "", ""};
    check(material_default(spec, &m), spec);
    check(facet_material_parse(spec, &described, &why), why.text);
    check(facet_bsdf_prepare(&described, &m.bsdf, &why), why.text);
    m.kind = SURFACE_BSDF;
    for (int k = 0; k < 3; k++) m.emission[k] = emission;
    size_t index;
    check(scene_add_material(s, &m, &index), spec);
    return index;
}

static inline void add_mesh(scene *s, mesh *m)
{
    instance in = {.mesh = 0, .to_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    check(scene_add_mesh(s, m, &in.mesh), "mesh");
    check(scene_add_instance(s, &in, NULL), "instance");
}

/* Two triangles over four corners in order. */
static inline void add_quad(scene *s, size_t material_index, const float corners[4][3])
{
    mesh m;
    memset(&m, 0, sizeof m);
    m.n_vertices = 4;
    m.n_triangles = 2;
    m.material = material_index;
    m.positions = (float(*)[3])allocate(4, sizeof *m.positions);
    m.triangles = (uint32_t(*)[3])allocate(2, sizeof *m.triangles);
    memcpy(m.positions, corners, 4*sizeof *m.positions);
    const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    memcpy(m.triangles, triangles, sizeof triangles);
    add_mesh(s, &m);
}
