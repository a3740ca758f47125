/* gltf.h: glTF 2.0 files (.gltf with external or embedded buffers, .glb) into a scene.
 *
 * [gltf] Khronos Group, glTF 2.0 Specification, 2.0.1.  What is read and what is not: docs/gltf.md.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Called for each thing that the file asks for and that will look different; text is one line, place
 * and remedy included ("materials[2]: KHR_materials_sheen is not supported: rendered without sheen"). */
typedef void gltf_warning(void *user, const char *text);

/* Reads the file and everything it refers to.  File references cannot leave the file's own folder.
 * On success *result is the caller's to destroy.  warning may be NULL. */
facet_status gltf_read(const char *path, gltf_warning *warning, void *user, scene **result, facet_error *why);

#ifdef __cplusplus
}
#endif
