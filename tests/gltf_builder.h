/* gltf_builder.h: small glTF files made in a test and read back.
 *
 * A test adds accessors, which get a buffer view each in one data URI, and gives the rest of the JSON as
 * text.  Files lie in a fresh folder for each test (gltf_setup, gltf_teardown are cmocka fixtures).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "io/gltf.h"

enum { BUILDER_BYTES = 1 << 16, BUILDER_TEXT = 1 << 14 };

typedef struct gltf_builder {
    unsigned char bytes[BUILDER_BYTES];
    size_t n_bytes;
    char views[BUILDER_TEXT], accessors[BUILDER_TEXT];
    int n_views, n_accessors;
} gltf_builder;

int gltf_setup(void **state);
int gltf_teardown(void **state);

/* Path of a file in the test's folder; valid until the next call. */
const char *gltf_test_path(const char *name);
void gltf_write_file(const char *name, const void *bytes, size_t size);

/* Appends bytes as a buffer view with more members ("\"byteStride\":16" or ""); returns its index. */
int add_view(gltf_builder *b, const void *bytes, size_t size, const char *more);
/* Appends an accessor from its JSON members; returns its index. */
int add_accessor(gltf_builder *b, const char *members);
/* Both, for tight data. */
int add_array(gltf_builder *b, const char *type, int component, size_t count, const void *bytes, size_t size,
              const char *more);
int add_floats(gltf_builder *b, const char *type, size_t count, const float *values, size_t n);

/* The whole file's text; `rest` is the members beside asset, buffers, bufferViews and accessors.  The
 * caller frees it. */
char *gltf_text(const gltf_builder *b, const char *rest);

/* Writes and reads the file.  load fails the test if it is refused; refuse fails it if it is not. */
scene *load(const gltf_builder *b, const char *rest);
facet_error refuse(const gltf_builder *b, const char *rest);
scene *load_text(const char *text);
facet_error refuse_text(const char *text);

/* The warnings of the latest reading, one a line. */
extern char gltf_warnings[8192];

/* One triangle (0,0,0), (1,0,0), (0,1,0), or a mesh of it, in `b`: accessor 0. */
void add_triangle(gltf_builder *b);
/* Scene, node and mesh around one primitive's members: {"attributes": ...}. */
scene *load_primitive(const gltf_builder *b, const char *primitive);
facet_error refuse_primitive(const gltf_builder *b, const char *primitive);

/* Fail the test, naming what differs; the floats must be equal. */
void expect_floats(const float *actual, const float *expected, size_t n, const char *what);
#define EXPECT_FLOATS(actual, n, ...) expect_floats((const float *)(actual), (const float[]){__VA_ARGS__}, (n), #actual)
/* The error is at this place and its text contains this. */
void expect_error(const facet_error *why, const char *place, const char *text);
