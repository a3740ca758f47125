/* gltf_buffer.c: buffers and buffer views.  [gltf, sections 3.6.1, 5.10, 5.11]
 *
 * Views are checked against their buffer's byteLength at once; that a buffer really has as many bytes
 * is checked when it is first used, before which nothing of its size is allocated.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "io/gltf_internal.h"

enum { MIN_STRIDE = 4, MAX_STRIDE = 252 };

static bool declare_view(gltf *g, const json_place *place, gltf_view *view)
{
    gltf_extension meshopt;
    *view = (gltf_view){.buffer = NONE};
    size_t stride = 0;
    if (!json_read_index(place, "buffer", g->n_buffers, "buffers", &view->buffer) ||
        !json_read_size(place, "byteOffset", SIZE_MAX, &view->offset) ||
        !json_read_size(place, "byteLength", SIZE_MAX, &view->size) ||
        !json_read_size(place, "byteStride", SIZE_MAX, &stride))
        return false;
    const json_place buffer = json_member(place, "buffer"), length = json_member(place, "byteLength"),
                     stride_place = json_member(place, "byteStride");
    if (!json_want_present(&buffer) || !json_want_present(&length)) return false;
    if (view->size == 0) return json_fail(&length, FACET_BAD_VALUE, "is 0; must be at least 1");
    if (stride_place.value && (stride < MIN_STRIDE || stride > MAX_STRIDE || stride%4 != 0))
        return json_fail(&stride_place, FACET_BAD_VALUE, "is %zu; must be a multiple of 4 from 4 to 252", stride);
    view->stride = stride;
    const size_t size = g->buffer[view->buffer].size;
    if (view->offset > size || view->size > size - view->offset)
        return json_fail(place, FACET_BAD_FILE, "needs bytes %zu to %zu of a buffer of %zu", view->offset,
                         view->offset + view->size, size);
    if (!gltf_read_extension(place, "EXT_meshopt_compression", &meshopt)) return false;
    if (meshopt.body.value)
        gltf_warn(g, place, "EXT_meshopt_compression is not supported: the uncompressed fallback is read");
    return true;
}

bool gltf_declare_buffers(gltf *g)
{
    g->n_buffers = json_count(&g->buffers);
    g->n_views = json_count(&g->views);
    g->buffer = calloc(g->n_buffers + 1, sizeof *g->buffer);
    g->view = calloc(g->n_views + 1, sizeof *g->view);
    if (!g->buffer || !g->view) return gltf_no_memory(&g->root);
    for (size_t i = 0; i < g->n_buffers; i++) {
        const json_place place = json_element(&g->buffers, i), length = json_member(&place, "byteLength");
        if (!json_want_present(&length)) return false;
        if (!json_read_size(&place, "byteLength", SIZE_MAX, &g->buffer[i].size)) return false;
        if (g->buffer[i].size == 0) return json_fail(&length, FACET_BAD_VALUE, "is 0; must be at least 1");
    }
    for (size_t i = 0; i < g->n_views; i++) {
        const json_place place = json_element(&g->views, i);
        if (!declare_view(g, &place, &g->view[i])) return false;
    }
    return true;
}

/* Section 4.4.3.3: a GLB's own chunk is the first buffer, if that has no uri. */
static bool load_buffer(gltf *g, size_t i)
{
    gltf_buffer *const b = &g->buffer[i];
    const json_place place = json_element(&g->buffers, i), uri = json_member(&place, "uri");
    if (b->bytes) return true;
    const unsigned char *bytes = g->bin;
    size_t size = g->bin_size;
    if (uri.value) {
        if (!gltf_read_uri(g, &uri, &b->owned, &size)) return false;
        bytes = b->owned;
    } else if (i != 0 || !bytes) {
        return json_fail(&place, FACET_UNSUPPORTED, "has no uri, and only a GLB's first buffer may be without");
    }
    if (size < b->size)
        return json_fail(&place, FACET_BAD_FILE, "has %zu bytes, but its byteLength is %zu", size, b->size);
    b->bytes = bytes;
    return true;
}

bool gltf_view_bytes(gltf *g, size_t view, const unsigned char **bytes)
{
    const gltf_view *const v = &g->view[view];
    if (!load_buffer(g, v->buffer)) return false;
    *bytes = g->buffer[v->buffer].bytes + v->offset;
    return true;
}
