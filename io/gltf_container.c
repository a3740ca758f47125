/* gltf_container.c: GLB, glTF's binary container.  [gltf, section 4.4]
 *
 * A 12 byte header, then chunks of (length, type, bytes): JSON first, BIN second if at all, others
 * skipped.  Every length is little-endian and has to agree with the file's.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "io/gltf_internal.h"

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8 };
#define CHUNK_JSON 0x4E4F534Au
#define CHUNK_BIN 0x004E4942u

static uint32_t little_u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

bool gltf_is_glb(const unsigned char *bytes, size_t size)
{
    return size >= 4 && memcmp(bytes, "glTF", 4) == 0;
}

/* Checks one chunk's header; *at moves past the chunk. */
static bool read_chunk(gltf *g, const unsigned char *bytes, size_t size, size_t *at, uint32_t *type, size_t *length)
{
    if (size - *at < CHUNK_HEADER_SIZE)
        return json_fail(&g->root, FACET_BAD_FILE, "GLB: the chunk header at byte %zu is cut off by the end", *at);
    *length = little_u32(bytes + *at);
    *type = little_u32(bytes + *at + 4);
    if (*length > size - *at - CHUNK_HEADER_SIZE)
        return json_fail(&g->root, FACET_BAD_FILE, "GLB: the chunk at byte %zu has %zu bytes, but only %zu are left",
                         *at, *length, size - *at - CHUNK_HEADER_SIZE);
    if (*length%4 != 0)
        return json_fail(&g->root, FACET_BAD_FILE, "GLB: the chunk at byte %zu has %zu bytes; must be a multiple of 4",
                         *at, *length);
    *at += CHUNK_HEADER_SIZE + *length;
    return true;
}

bool gltf_open_glb(gltf *g, const unsigned char *bytes, size_t size, const unsigned char **json, size_t *json_size)
{
    if (size < HEADER_SIZE) return json_fail(&g->root, FACET_BAD_FILE, "GLB: %zu bytes; the header alone has 12", size);
    const uint32_t version = little_u32(bytes + 4), length = little_u32(bytes + 8);
    if (version != 2) return json_fail(&g->root, FACET_UNSUPPORTED, "GLB version %u; must be 2", (unsigned)version);
    if (length < HEADER_SIZE || length > size)
        return json_fail(&g->root, FACET_BAD_FILE, "GLB: the header says %u bytes, the file has %zu", (unsigned)length,
                         size);
    if (length < size) gltf_warn(g, &g->root, "GLB: the last %zu bytes of the file are ignored", size - length);
    size = length;
    size_t at = HEADER_SIZE, chunk_size;
    uint32_t type;
    if (!read_chunk(g, bytes, size, &at, &type, &chunk_size)) return false;
    if (type != CHUNK_JSON) return json_fail(&g->root, FACET_BAD_FILE, "GLB: the first chunk must be JSON");
    *json = bytes + at - chunk_size;
    *json_size = chunk_size;
    for (int i = 1; at < size; i++) {
        if (!read_chunk(g, bytes, size, &at, &type, &chunk_size)) return false;
        if (type == CHUNK_JSON) return json_fail(&g->root, FACET_BAD_FILE, "GLB: more than one JSON chunk");
        if (type != CHUNK_BIN) continue;
        if (i != 1) return json_fail(&g->root, FACET_BAD_FILE, "GLB: the binary chunk must be the second");
        g->bin = bytes + at - chunk_size;
        g->bin_size = chunk_size;
    }
    return true;
}
