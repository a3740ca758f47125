/* test_gltf_files.c: where glTF's bytes come from: GLB containers, URIs, versions and extensions.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "tests/gltf_builder.h"

static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

#define AROUND(buffer)                                                                                                 \
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36" buffer "}],\"bufferViews\":[{\"buffer\":0,"     \
    "\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"type\":\"VEC3\",\"componentType\":5126,\"count\":3}],"     \
    "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}"

/* ---- GLB ------------------------------------------------------------------------------------------ */

typedef struct chunk {
    uint32_t type; /* as the four letters of the file, little-endian */
    const void *bytes;
    size_t size;
} chunk;

enum { JSON = 0x4E4F534A, BIN = 0x004E4942, OTHER = 0x21212121 };

static void put_u32(unsigned char *out, size_t value)
{
    for (int k = 0; k < 4; k++) out[k] = (unsigned char)(value >> 8*k);
}

/* Writes "test.glb"; each chunk padded with blanks to four bytes; `excess` is added to the stated length. */
static facet_status read_glb(const chunk *chunks, size_t n, int excess, scene **s, facet_error *why)
{
    static unsigned char file[4096];
    size_t size = 12;
    for (size_t i = 0; i < n; i++) {
        const size_t padded = (chunks[i].size + 3)/4*4;
        put_u32(file + size, padded);
        put_u32(file + size + 4, chunks[i].type);
        memset(file + size + 8, ' ', padded);
        memcpy(file + size + 8, chunks[i].bytes, chunks[i].size);
        size += 8 + padded;
    }
    memcpy(file, "glTF", 4);
    put_u32(file + 4, 2);
    put_u32(file + 8, (size_t)((long)size + excess));
    gltf_write_file("test.glb", file, size);
    *why = (facet_error){0};
    return gltf_read(gltf_test_path("test.glb"), NULL, NULL, s, why);
}

static void glb_chunks_are_read_and_others_skipped(void **state)
{
    (void)state;
    static const char json[] = AROUND("");
    const chunk chunks[] = {{JSON, json, sizeof json - 1}, {BIN, triangle, sizeof triangle}, {OTHER, "abc", 3}};
    scene *s;
    facet_error why;
    for (size_t n = 2; n <= 3; n++) {
        assert_int_equal(read_glb(chunks, n, 0, &s, &why), FACET_OK);
        EXPECT_FLOATS(s->meshes[0].positions, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        scene_destroy(s);
    }
}

static void malformed_glb_files_are_refused(void **state)
{
    (void)state;
    static const char json[] = AROUND("");
    const chunk j = {JSON, json, sizeof json - 1}, b = {BIN, triangle, sizeof triangle}, o = {OTHER, "abcd", 4};
    const struct {
        chunk chunks[3];
        size_t n;
        int excess;
        const char *text;
    } cases[] = {
        {{j, b, b}, 3, 0, "must be the second"},
        {{b, j, o}, 2, 0, "first chunk must be JSON"},
        {{o, j, b}, 3, 0, "first chunk must be JSON"},
        {{j, o, b}, 3, 0, "must be the second"},
        {{j, j, b}, 3, 0, "more than one JSON chunk"},
        {{j, b, o}, 2, 1, "the header says"},
        {{j, b, o}, 2, -1, "only"},
        {{j, b, o}, 2, -40, "cut off"},
        {{j, b, o}, 0, 0, "cut off"},
        {{j, b, o}, 1, 0, "has no uri"},
        {{j, {BIN, triangle, 32}, o}, 2, 0, "has 32 bytes, but its byteLength is 36"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        scene *s = NULL;
        facet_error why;
        if (!read_glb(cases[i].chunks, cases[i].n, cases[i].excess, &s, &why)) fail_msg("case %zu is accepted", i);
        if (!strstr(why.text, cases[i].text)) fail_msg("case %zu: \"%s\" lacks \"%s\"", i, why.text, cases[i].text);
    }
}

/* ---- URIs ----------------------------------------------------------------------------------------- */

static void relative_uris_are_decoded_and_read(void **state)
{
    (void)state;
    gltf_write_file("a b\xC3\xA9%.bin", triangle, sizeof triangle);
    static const char *const texts[] = {AROUND(",\"uri\":\"a%20b%C3%A9%25.bin\""),
                                        AROUND(",\"uri\":\"a b\\u00e9%25.bin\""),
                                        AROUND(",\"uri\":\"./x/../a%20b\xC3\xA9%25.bin\"")};
    assert_int_equal(mkdir(gltf_test_path("x"), 0700), 0);
    for (size_t i = 0; i < sizeof texts/sizeof *texts; i++) {
        scene *s = load_text(texts[i]);
        EXPECT_FLOATS(s->meshes[0].positions, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0);
        scene_destroy(s);
    }
}

static void uris_that_leave_the_folder_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *complaint;
    } cases[] = {
        {AROUND(",\"uri\":\"../a.bin\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"x/../../a.bin\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"%2e%2e/a.bin\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"..%2fa.bin\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"/dev/zero\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"%2Fdev/zero\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"\""), "is empty"},
        {AROUND(",\"uri\":\"..\\\\a.bin\""), "backslash"},
        {AROUND(",\"uri\":\"a%00.bin\""), "control character"},
        {AROUND(",\"uri\":\"a%0.bin\""), "two hexadecimal digits"},
        {AROUND(",\"uri\":\"a%\""), "two hexadecimal digits"},
        {AROUND(",\"uri\":\"file:///a.bin\""), "inside the scene's own folder; --allow-outside"},
        {AROUND(",\"uri\":\"http://localhost/a.bin\""), "only data URIs and files of this machine"},
        {AROUND(",\"uri\":\"gone.bin\""), "No such file"},
        {AROUND(",\"uri\":\".\""), "regular file"},
        {AROUND(",\"uri\":7"), "is a number; must be a string"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const facet_error why = refuse_text(cases[i].text);
        expect_error(&why, "buffers[0].uri", cases[i].complaint);
    }
}

static void base64_is_strict(void **state)
{
    (void)state;
    static const struct {
        const char *text, *complaint;
    } cases[] = {
        {AROUND(",\"uri\":\"data:;base64,AAA\""), "multiple of 4"},
        {AROUND(",\"uri\":\"data:;base64,AA=A\""), "invalid digit"},
        {AROUND(",\"uri\":\"data:;base64,AA A\""), "invalid digit"},
        {AROUND(",\"uri\":\"data:;base64,A===\""), "invalid digit"},
        {AROUND(",\"uri\":\"data:;base64,AB==\""), "belong to no byte"},
        {AROUND(",\"uri\":\"data:;base64,AAB=\""), "belong to no byte"},
        {AROUND(",\"uri\":\"data:;base64\""), "without a comma"},
        {AROUND(",\"uri\":\"data:text/plain,AAAA\""), "not base64"},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const facet_error why = refuse_text(cases[i].text);
        expect_error(&why, "buffers[0].uri", cases[i].complaint);
    }
    const facet_error why = refuse_text(AROUND(",\"uri\":\"data:;base64,AAAA\""));
    expect_error(&why, "buffers[0]", "has 3 bytes, but its byteLength is 36");
}

/* ---- Version, extensions, hash -------------------------------------------------------------------- */

static void only_gltf_2_0_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *text, *place; /* place NULL: read */
    } cases[] = {
        {"{\"asset\":{\"version\":\"2.0\"}}", NULL},
        {"{\"asset\":{\"version\":\"2.7\",\"minVersion\":\"2.0\"}}", NULL},
        {"{\"asset\":{\"version\":\"1.0\"}}", "asset.version"},
        {"{\"asset\":{\"version\":\"3.0\"}}", "asset.version"},
        {"{\"asset\":{\"version\":\"2\"}}", "asset.version"},
        {"{\"asset\":{\"version\":2.0}}", "asset.version"},
        {"{\"asset\":{\"version\":\"2.9\",\"minVersion\":\"2.1\"}}", "asset.minVersion"},
        {"{\"asset\":{}}", "asset.version"},
        {"{}", "asset"},
        {"[]", ""},
        {"null", ""},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        if (!cases[i].place) {
            scene_destroy(load_text(cases[i].text));
            continue;
        }
        const facet_error why = refuse_text(cases[i].text);
        expect_error(&why, cases[i].place, "");
    }
}

static void required_extensions_are_supported_or_named(void **state)
{
    (void)state;
    const facet_error why = refuse_text(
        "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[\"KHR_texture_transform\","
        "\"KHR_draco_mesh_compression\"]}");
    assert_int_equal(why.status, FACET_UNSUPPORTED);
    expect_error(&why, "extensionsRequired[1]", "KHR_draco_mesh_compression");
}

static void the_hash_is_fnv_1a_of_the_bytes_in_the_order_of_reading(void **state)
{
    (void)state;
    static const char text[] = AROUND(",\"uri\":\"t.bin\"");
    gltf_write_file("t.bin", triangle, sizeof triangle);
    scene *s = load_text(text);
    uint64_t expected = 0xcbf29ce484222325;
    for (size_t i = 0; i < sizeof text - 1; i++) expected = (expected ^ (unsigned char)text[i])*0x100000001b3;
    for (size_t i = 0; i < sizeof triangle; i++)
        expected = (expected ^ ((const unsigned char *)triangle)[i])*0x100000001b3;
    assert_true(s->hash == expected);
    scene_destroy(s);
}

static void a_missing_file_is_an_io_error(void **state)
{
    (void)state;
    scene *s = NULL;
    facet_error why = {0};
    assert_int_equal(gltf_read(gltf_test_path("none.gltf"), NULL, NULL, &s, &why), FACET_IO);
    assert_null(s);
    assert_true(why.text[0]);
    assert_int_equal(gltf_read(gltf_test_path("none.gltf"), NULL, NULL, &s, NULL), FACET_IO);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)
    const struct CMUnitTest tests[] = {
        TEST(glb_chunks_are_read_and_others_skipped),
        TEST(malformed_glb_files_are_refused),
        TEST(relative_uris_are_decoded_and_read),
        TEST(uris_that_leave_the_folder_are_refused),
        TEST(base64_is_strict),
        TEST(only_gltf_2_0_is_read),
        TEST(required_extensions_are_supported_or_named),
        TEST(the_hash_is_fnv_1a_of_the_bytes_in_the_order_of_reading),
        TEST(a_missing_file_is_an_io_error),
    };
    return cmocka_run_group_tests_name("glTF files", tests, NULL, NULL);
}
