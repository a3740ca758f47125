/* gltf_builder.c: small glTF files made in a test and read back.
 * SPDX-License-Identifier: MIT */
#include "tests/gltf_builder.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

char gltf_warnings[8192];

static char folder[32];

int gltf_setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/facet-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

int gltf_teardown(void **state)
{
    (void)state;
    DIR *list = opendir(folder);
    if (!list) return -1;
    for (struct dirent *entry = readdir(list); entry; entry = readdir(list))
        if (entry->d_name[0] != '.') remove(gltf_test_path(entry->d_name));
    closedir(list);
    return rmdir(folder);
}

const char *gltf_test_path(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

void gltf_write_file(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(gltf_test_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

int add_view(gltf_builder *b, const void *bytes, size_t size, const char *more)
{
    char *const end = b->views + strlen(b->views);
    assert_true(b->n_bytes + size + 4 <= sizeof b->bytes);
    snprintf(end, sizeof b->views - (size_t)(end - b->views),
             "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s%s}", b->n_views ? "," : "", b->n_bytes, size,
             more[0] ? "," : "", more);
    memcpy(b->bytes + b->n_bytes, bytes, size);
    b->n_bytes += (size + 3)/4*4;
    return b->n_views++;
}

int add_accessor(gltf_builder *b, const char *members)
{
    char *const end = b->accessors + strlen(b->accessors);
    snprintf(end, sizeof b->accessors - (size_t)(end - b->accessors), "%s{%s}", b->n_accessors ? "," : "", members);
    return b->n_accessors++;
}

int add_array(gltf_builder *b, const char *type, int component, size_t count, const void *bytes, size_t size,
              const char *more)
{
    char members[256];
    const int view = add_view(b, bytes, size, "");
    snprintf(members, sizeof members, "\"bufferView\":%d,\"type\":\"%s\",\"componentType\":%d,\"count\":%zu%s%s", view,
             type, component, count, more[0] ? "," : "", more);
    return add_accessor(b, members);
}

int add_floats(gltf_builder *b, const char *type, size_t count, const float *values, size_t n)
{
    return add_array(b, type, 5126, count, values, n*sizeof *values, "");
}

static void write_base64(const unsigned char *bytes, size_t n, char *out)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < n; i += 3, out += 4) {
        const unsigned group = (unsigned)bytes[i] << 16 | (i + 1 < n ? (unsigned)bytes[i + 1] << 8 : 0u) |
                               (i + 2 < n ? (unsigned)bytes[i + 2] : 0u);
        for (int k = 0; k < 4; k++) out[k] = digits[group >> (18 - 6*k) & 63];
        if (i + 1 >= n) out[2] = '=';
        if (i + 2 >= n) out[3] = '=';
    }
    *out = 0;
}

char *gltf_text(const gltf_builder *b, const char *rest)
{
    char *const base64 = malloc(b->n_bytes/3*4 + 8);
    const size_t size = strlen(b->views) + strlen(b->accessors) + strlen(rest) + b->n_bytes/3*4 + 512;
    char *const text = malloc(size);
    assert_non_null(base64);
    assert_non_null(text);
    write_base64(b->bytes, b->n_bytes, base64);
    char buffers[64] = "";
    if (b->n_bytes) snprintf(buffers, sizeof buffers, "{\"byteLength\":%zu,\"uri\":\"data:;base64,", b->n_bytes);
    snprintf(text, size,
             "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[%s%s%s],\"bufferViews\":[%s],\"accessors\":[%s]%s%s}",
             buffers, base64, b->n_bytes ? "\"}" : "", b->views, b->accessors, rest[0] ? "," : "", rest);
    free(base64);
    return text;
}

static void collect_warning(void *user, const char *text)
{
    const size_t used = strlen(gltf_warnings);
    assert_ptr_equal(user, gltf_warnings);
    snprintf(gltf_warnings + used, sizeof gltf_warnings - used, "%s\n", text);
}

static facet_status read_text(const char *text, scene **result, facet_error *why)
{
    gltf_write_file("test.gltf", text, strlen(text));
    gltf_warnings[0] = 0;
    return gltf_read(gltf_test_path("test.gltf"), collect_warning, gltf_warnings, result, why);
}

scene *load_text(const char *text)
{
    scene *s = NULL;
    facet_error why = {0};
    if (read_text(text, &s, &why)) fail_msg("refused: %s: %s", why.place, why.text);
    return s;
}

facet_error refuse_text(const char *text)
{
    scene *s = NULL;
    facet_error why = {0};
    if (!read_text(text, &s, &why)) fail_msg("not refused: %s", text);
    assert_null(s);
    assert_true(why.status != FACET_OK && why.text[0]);
    return why;
}

scene *load(const gltf_builder *b, const char *rest)
{
    char *const text = gltf_text(b, rest);
    scene *const s = load_text(text);
    free(text);
    return s;
}

facet_error refuse(const gltf_builder *b, const char *rest)
{
    char *const text = gltf_text(b, rest);
    const facet_error why = refuse_text(text);
    free(text);
    return why;
}

void add_triangle(gltf_builder *b)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    add_floats(b, "VEC3", 3, corners, 9);
}

#define AROUND_PRIMITIVE "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[%s]}]"

scene *load_primitive(const gltf_builder *b, const char *primitive)
{
    char rest[2048];
    snprintf(rest, sizeof rest, AROUND_PRIMITIVE, primitive);
    return load(b, rest);
}

facet_error refuse_primitive(const gltf_builder *b, const char *primitive)
{
    char rest[2048];
    snprintf(rest, sizeof rest, AROUND_PRIMITIVE, primitive);
    return refuse(b, rest);
}

void expect_floats(const float *actual, const float *expected, size_t n, const char *what)
{
    for (size_t i = 0; i < n; i++)
        if (!(actual[i] == expected[i]))
            fail_msg("%s: number %zu is %a, not %a", what, i, (double)actual[i], (double)expected[i]);
}

void expect_error(const facet_error *why, const char *place, const char *text)
{
    if (strcmp(why->place, place) != 0 || !strstr(why->text, text))
        fail_msg("error is \"%s: %s\", not \"%s: ...%s...\"", why->place, why->text, place, text);
}
