/* gltf_accessor.c: accessors, typed arrays inside buffer views.  [gltf, sections 3.6.2, 5.1 to 5.4]
 *
 * All accessors are checked against their views when the file is opened; elements are converted when
 * they are asked for.  Bytes are assembled one at a time, so that neither alignment nor the machine's
 * byte order matters.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

/* Bytes of one component; 0 for a number that is no component type. */
static size_t component_size(int component)
{
    switch (component) {
    case GLTF_I8:
    case GLTF_U8: return 1;
    case GLTF_I16:
    case GLTF_U16: return 2;
    case GLTF_U32:
    case GLTF_F32: return 4;
    default: return 0;
    }
}

static bool read_component_type(const json_place *object, int *component)
{
    const json_place place = json_member(object, "componentType");
    size_t number = 0;
    if (!json_want_present(&place) || !json_read_size(object, "componentType", SIZE_MAX, &number)) return false;
    if (number > GLTF_F32 || component_size((int)number) == 0)
        return json_fail(&place, FACET_BAD_FILE, "is %zu; must be 5120, 5121, 5122, 5123, 5125 or 5126", number);
    *component = (int)number;
    return true;
}

/* Columns of a matrix start at multiples of 4 bytes (section 3.6.2.4). */
static bool read_type(const json_place *object, gltf_accessor *a)
{
    static const struct {
        const char *name;
        size_t rows, columns;
    } types[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                 {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
    const json_place place = json_member(object, "type");
    const char *name;
    if (!json_want_present(&place) || !json_string_here(&place, &name)) return false;
    for (size_t i = 0; i < sizeof types/sizeof *types; i++)
        if (strcmp(types[i].name, name) == 0) {
            const size_t column = types[i].rows*component_size(a->component), aligned = (column + 3)/4*4;
            a->type = types[i].name;
            a->n_components = types[i].rows*types[i].columns;
            a->size = (types[i].columns - 1)*aligned + column;
            a->tight = types[i].columns == 1 ? column : types[i].columns*aligned;
            return true;
        }
    return json_fail(&place, FACET_BAD_FILE, "is \"%.20s\"; must be SCALAR, VEC2 to VEC4 or MAT2 to MAT4", name);
}

/* n elements of `size` bytes, `stride` apart, fit into the view from `offset`. */
static bool check_range(gltf *g, const json_place *place, size_t view, size_t offset, size_t n, size_t size,
                        size_t stride)
{
    const size_t room = g->view[view].size;
    if (offset > room || size > room - offset || n - 1 > (room - offset - size)/stride)
        return json_fail(place, FACET_BAD_FILE,
                         "%zu elements of %zu bytes from byte %zu do not fit into bufferViews[%zu]"
                         " of %zu bytes",
                         n, size, offset, view, room);
    return true;
}

static bool declare_sparse(gltf *g, const json_place *accessor, gltf_accessor *a)
{
    json_place sparse, indices, values;
    if (!json_read_object(accessor, "sparse", &sparse)) return false;
    if (!sparse.value) return true;
    if (!json_read_object(&sparse, "indices", &indices) || !json_read_object(&sparse, "values", &values)) return false;
    const json_place count = json_member(&sparse, "count"), index_view = json_member(&indices, "bufferView"),
                     value_view = json_member(&values, "bufferView");
    if (!json_want_present(&count) || !json_want_present(&index_view) || !json_want_present(&value_view)) return false;
    if (!json_read_size(&sparse, "count", SIZE_MAX, &a->n_sparse) ||
        !json_index_here(&index_view, g->n_views, "bufferViews", &a->sparse_index_view) ||
        !json_index_here(&value_view, g->n_views, "bufferViews", &a->sparse_value_view) ||
        !json_read_size(&indices, "byteOffset", SIZE_MAX, &a->sparse_index_offset) ||
        !json_read_size(&values, "byteOffset", SIZE_MAX, &a->sparse_value_offset) ||
        !read_component_type(&indices, &a->sparse_index_component))
        return false;
    if (a->n_sparse == 0 || a->n_sparse > a->count)
        return json_fail(&count, FACET_BAD_VALUE, "is %zu; must be from 1 to the accessor's count %zu", a->n_sparse,
                         a->count);
    const int c = a->sparse_index_component;
    if (c != GLTF_U8 && c != GLTF_U16 && c != GLTF_U32)
        return json_fail(&indices, FACET_BAD_FILE, "componentType is %d; must be 5121, 5123 or 5125", c);
    return check_range(g, &indices, a->sparse_index_view, a->sparse_index_offset, a->n_sparse, component_size(c),
                       component_size(c)) &&
           check_range(g, &values, a->sparse_value_view, a->sparse_value_offset, a->n_sparse, a->size, a->tight);
}

static bool declare_accessor(gltf *g, const json_place *place, gltf_accessor *a)
{
    *a = (gltf_accessor){.view = NONE};
    const json_place count = json_member(place, "count");
    if (!json_want_present(&count) || !json_read_size(place, "count", SIZE_MAX, &a->count) ||
        !json_read_size(place, "byteOffset", SIZE_MAX, &a->offset) ||
        !json_read_bool(place, "normalized", &a->is_normalized) ||
        !json_read_index(place, "bufferView", g->n_views, "bufferViews", &a->view) ||
        !read_component_type(place, &a->component) || !read_type(place, a))
        return false;
    if (a->count == 0) return json_fail(&count, FACET_BAD_VALUE, "is 0; must be at least 1");
    if (a->component == GLTF_F32 || a->component == GLTF_U32) a->is_normalized = false;
    a->stride = a->tight;
    if (a->view != NONE) {
        const size_t stride = g->view[a->view].stride;
        if (stride && stride < a->size)
            return json_fail(place, FACET_BAD_FILE, "elements of %zu bytes do not fit into byteStride %zu", a->size,
                             stride);
        if (stride) a->stride = stride;
        if (!check_range(g, place, a->view, a->offset, a->count, a->size, a->stride)) return false;
    }
    return declare_sparse(g, place, a);
}

bool gltf_declare_accessors(gltf *g)
{
    g->n_accessors = json_count(&g->accessors);
    g->accessor = calloc(g->n_accessors + 1, sizeof *g->accessor);
    if (!g->accessor) return gltf_no_memory(&g->root);
    for (size_t i = 0; i < g->n_accessors; i++) {
        const json_place place = json_element(&g->accessors, i);
        if (!declare_accessor(g, &place, &g->accessor[i])) return false;
    }
    return true;
}

bool gltf_find_accessor(gltf *g, const json_place *place, const gltf_accessor **a)
{
    size_t i;
    if (!json_index_here(place, g->n_accessors, "accessors", &i)) return false;
    *a = &g->accessor[i];
    return true;
}

bool gltf_want_format(const json_place *place, const gltf_accessor *a, const char *types, unsigned components)
{
    unsigned bit = 0;
    switch (a->component) {
    case GLTF_F32: bit = GLTF_WANT_F32; break;
    case GLTF_U32: bit = GLTF_WANT_U32; break;
    case GLTF_U8: bit = a->is_normalized ? GLTF_WANT_NORM_U8 : GLTF_WANT_U8; break;
    case GLTF_U16: bit = a->is_normalized ? GLTF_WANT_NORM_U16 : GLTF_WANT_U16; break;
    case GLTF_I8: bit = a->is_normalized ? GLTF_WANT_NORM_I8 : GLTF_WANT_I8; break;
    case GLTF_I16: bit = a->is_normalized ? GLTF_WANT_NORM_I16 : GLTF_WANT_I16; break;
    default: break;
    }
    if ((components & bit) && strstr(types, a->type)) return true;
    return json_fail(place, FACET_BAD_FILE, "the accessor has %s of component type %d%s; must be %s of an allowed type",
                     a->type, a->component, a->is_normalized ? " normalized" : "", types);
}

/* ---- Conversion ----------------------------------------------------------------------------------- */

static uint32_t raw_component(const unsigned char *p, int component)
{
    switch (component_size(component)) {
    case 1: return p[0];
    case 2: return (uint32_t)p[0] | (uint32_t)p[1] << 8;
    default: return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
}

/* Section 3.6.2.2: f = c/255, max(c/127, -1), ... for normalised integers. */
static float float_component(const unsigned char *p, int component, bool is_normalized)
{
    const uint32_t raw = raw_component(p, component);
    float value;
    switch (component) {
    case GLTF_F32: memcpy(&value, &raw, sizeof value); return value;
    case GLTF_U8: return is_normalized ? (float)raw/255.0f : (float)raw;
    case GLTF_U16: return is_normalized ? (float)raw/65535.0f : (float)raw;
    case GLTF_I8:
        value = raw < 128 ? (float)raw : (float)raw - 256.0f;
        return is_normalized ? fmaxf(value/127.0f, -1.0f) : value;
    case GLTF_I16:
        value = raw < 32768 ? (float)raw : (float)raw - 65536.0f;
        return is_normalized ? fmaxf(value/32767.0f, -1.0f) : value;
    default: return (float)raw;
    }
}

/* One element into out[n_components], as floats or, if `is_uint`, as integers. */
static void convert(const gltf_accessor *a, const unsigned char *p, bool is_uint, void *out)
{
    const size_t step = component_size(a->component);
    for (size_t k = 0; k < a->n_components; k++) {
        if (is_uint) ((uint32_t *)out)[k] = raw_component(p + k*step, a->component);
        else ((float *)out)[k] = float_component(p + k*step, a->component, a->is_normalized);
    }
}

/* Section 3.6.2.3: sparse.indices grow strictly and stay below count. */
static bool substitute_sparse(gltf *g, const json_place *place, const gltf_accessor *a, bool is_uint,
                              uint32_t *elements)
{
    const unsigned char *indices, *values;
    if (a->n_sparse == 0) return true;
    if (!gltf_view_bytes(g, a->sparse_index_view, &indices)) return false;
    if (!gltf_view_bytes(g, a->sparse_value_view, &values)) return false;
    const size_t step = component_size(a->sparse_index_component);
    size_t previous = NONE;
    for (size_t i = 0; i < a->n_sparse; i++) {
        const size_t at = raw_component(indices + a->sparse_index_offset + i*step, a->sparse_index_component);
        if (at >= a->count || (previous != NONE && at <= previous))
            return json_fail(place, FACET_BAD_FILE, "sparse index %zu is %zu; must grow and stay below %zu", i, at,
                             a->count);
        previous = at;
        convert(a, values + a->sparse_value_offset + i*a->tight, is_uint, elements + at*a->n_components);
    }
    return true;
}

/* float and uint32_t have one size, so that both kinds share their storage's shape. */
static uint32_t *read_elements(gltf *g, const json_place *place, const gltf_accessor *a, bool is_uint)
{
    uint32_t *elements = gltf_alloc(g, place, a->count, a->n_components*sizeof *elements);
    if (!elements) return NULL;
    const unsigned char *bytes;
    bool is_read = true;
    if (a->view != NONE) {
        is_read = gltf_view_bytes(g, a->view, &bytes);
        for (size_t i = 0; is_read && i < a->count; i++)
            convert(a, bytes + a->offset + i*a->stride, is_uint, elements + i*a->n_components);
    }
    if (is_read && substitute_sparse(g, place, a, is_uint, elements)) return elements;
    free(elements);
    return NULL;
}

bool gltf_read_any_floats(gltf *g, const json_place *place, const gltf_accessor *a, float **values)
{
    *values = (float *)(void *)read_elements(g, place, a, false);
    return *values != NULL;
}

bool gltf_read_floats(gltf *g, const json_place *place, const gltf_accessor *a, float **values)
{
    if (!gltf_read_any_floats(g, place, a, values)) return false;
    for (size_t i = 0; i < a->count*a->n_components; i++)
        if (!isfinite((*values)[i])) {
            json_fail(place, FACET_BAD_VALUE, "element %zu, component %zu is %s; must be finite", i/a->n_components,
                      i%a->n_components, isnan((*values)[i]) ? "NaN" : "infinite");
            free(*values);
            *values = NULL;
            return false;
        }
    return true;
}

bool gltf_read_uints(gltf *g, const json_place *place, const gltf_accessor *a, uint32_t **values)
{
    *values = read_elements(g, place, a, true);
    return *values != NULL;
}
