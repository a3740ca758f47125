/* gltf.h: glTF 2.0 files (.gltf with external or embedded buffers, .glb) into a scene.
 *
 * [gltf] Khronos Group, glTF 2.0 Specification, 2.0.1.  What is read and what is not: docs/gltf.md.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Called for each thing that the file asks for and that will look different; text is one line, place
 * and remedy included ("materials[2]: KHR_materials_sheen is not supported: rendered without sheen"). */
typedef void gltf_warning(void *user, const char *text);

/* Called for each file that the scene refers to, once it is read. */
typedef void gltf_file(void *user, const char *path);

/* How to read; all zeros are the defaults. */
typedef struct gltf_options {
    gltf_warning *warning; /* may be NULL */
    void *user;            /* of the warning and of on_file */
    /* References may name any file: absolute, with "..", by a symbolic link, or as file: URI.  Without it they cannot
     * leave the scene's own folder. */
    bool allows_outside;
    /* Files, geometry and pictures of the scene together [byte]; 0: FILE_MEMORY_DEFAULT, and geometry within
     * GLTF_GEOMETRY_FLOOR and _FACTOR besides. */
    size_t most_memory;
    gltf_file *on_file; /* may be NULL */
} gltf_options;

/* Reads the file and everything it refers to.  On success *result is the caller's to destroy. */
facet_status gltf_read_with(const char *path, const gltf_options *options, scene **result, facet_error *why);

/* The same with the default options. */
facet_status gltf_read(const char *path, gltf_warning *warning, void *user, scene **result, facet_error *why);

#ifdef __cplusplus
}
#endif
