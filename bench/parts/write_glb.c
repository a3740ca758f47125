/* write_glb.c: see write_glb.h.
 * SPDX-License-Identifier: MIT */
#include "bench/parts/write_glb.h"

#include <stdio.h>

#include "bench/parts/build_scene.h"

static void put32(FILE *file, size_t value)
{
    const uint32_t word = (uint32_t)value;
    fwrite(&word, sizeof word, 1, file);
}

/* The albedo in a material's name, which is its specification. */
static void find_kd(const material *m, double kd[3])
{
    const int n = sscanf(m->name, "lambert kd=%lf,%lf,%lf", &kd[0], &kd[1], &kd[2]);
    if (n == 1) kd[1] = kd[2] = kd[0];
    else if (n != 3) check(FACET_BAD_VALUE, m->name);
}

void write_glb(const scene *s, const char *path)
{
    static char text[1 << 16];
    size_t length = 0, offset = 0;
    FILE *file = fopen(path, "wb");
    if (!file) check(FACET_IO, path);
#define PUT(...) length += (size_t)snprintf(text + length, sizeof text - length, __VA_ARGS__)
    PUT("{\"asset\":{\"version\":\"2.0\"},"
        "\"extensionsUsed\":[\"FACET_materials_bsdf\",\"KHR_materials_emissive_strength\"],"
        "\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (size_t i = 0; i <= s->n_meshes; i++) PUT("%zu%s", i, i < s->n_meshes ? "," : "]}],\"nodes\":[");
    for (size_t i = 0; i < s->n_meshes; i++) PUT("{\"mesh\":%zu},", i);
    PUT("{\"camera\":0,\"translation\":[0,1,3.9]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":"
        "{\"yfov\":%.9g,\"znear\":0.1,\"aspectRatio\":1}}],\"materials\":[",
        (double)s->cameras[0].yfov);
    for (size_t i = 0; i < s->n_materials; i++) {
        const material *m = &s->materials[i];
        double kd[3];
        find_kd(m, kd);
        PUT("%s{\"extensions\":{\"FACET_materials_bsdf\":{\"model\":\"lambert\",\"kd\":[%.9g,%.9g,%.9g]}", i ? "," : "",
            kd[0], kd[1], kd[2]);
        if (m->emission[0] > 0)
            PUT(",\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}},\"emissiveFactor\":[1,1,1]}",
                (double)m->emission[0]);
        else PUT("}}");
    }
    PUT("],\"meshes\":[");
    for (size_t i = 0; i < s->n_meshes; i++)
        PUT("%s{\"primitives\":[{\"attributes\":{\"POSITION\":%zu},\"indices\":%zu,\"material\":%zu}]}", i ? "," : "",
            2*i, 2*i + 1, s->meshes[i].material);
    PUT("],\"accessors\":[");
    for (size_t i = 0; i < s->n_meshes; i++)
        PUT("%s{\"bufferView\":%zu,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%zu,"
            "\"min\":[-1,0,-1],\"max\":[1,2,1]},"
            "{\"bufferView\":%zu,\"componentType\":5125,\"type\":\"SCALAR\",\"count\":%zu}",
            i ? "," : "", 2*i, s->meshes[i].n_vertices, 2*i + 1, 3*s->meshes[i].n_triangles);
    PUT("],\"bufferViews\":[");
    for (size_t i = 0; i < s->n_meshes; i++) {
        const size_t sizes[2] = {12*(size_t)s->meshes[i].n_vertices, 12*(size_t)s->meshes[i].n_triangles};
        for (int k = 0; k < 2; k++) {
            PUT("%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", offset ? "," : "", offset, sizes[k]);
            offset += sizes[k];
        }
    }
    PUT("],\"buffers\":[{\"byteLength\":%zu}]}", offset);
    while (length%4) PUT(" ");
#undef PUT
    if (length >= sizeof text) check(FACET_NO_MEMORY, "text of the file");
    fwrite("glTF", 1, 4, file);
    put32(file, 2);
    put32(file, 12 + 8 + length + 8 + offset);
    put32(file, length);
    fwrite("JSON", 1, 4, file);
    fwrite(text, 1, length, file);
    put32(file, offset);
    fwrite("BIN", 1, 4, file);
    for (size_t i = 0; i < s->n_meshes; i++) {
        fwrite(s->meshes[i].positions, 12, s->meshes[i].n_vertices, file);
        fwrite(s->meshes[i].triangles, 12, s->meshes[i].n_triangles, file);
    }
    const int failed = ferror(file);
    if (fclose(file) != 0 || failed) check(FACET_IO, path);
}
