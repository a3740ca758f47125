/* test_exr_layouts.c: OpenEXR files put together byte by byte from the format's description, so that each
 * layout that exr.c reads or refuses is seen, whatever the library can write.
 *
 * All are uncompressed.  Sample i (in rows from the top) of channel number c in the file is 100 c + i.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "io/image_file.h"

enum { UINT = 0, HALF = 1, FLOAT = 2 };         /* pixel types */
enum { SCAN_LINES = 0, TILES = 1, MIPMAP = 2 }; /* layouts */
enum { TILE = 2 };                              /* its side */
enum { TILED_FLAG = 0x200, DEEP_FLAG = 0x800, MULTIPART_FLAG = 0x1000 };

typedef struct layout {
    const char *channels[6]; /* in the order of their names, NULL at the end */
    int types[5];
    int sampling;
    int x, y, width, height;
    int kind;
    bool is_decreasing; /* the lines lie in the file from the bottom up */
    bool is_multipart;  /* a second part of one black pixel follows */
    int flags;
    int missing_bytes; /* of the first block */
} layout;

/* A file as it grows. */
typedef struct file {
    unsigned char bytes[8192];
    size_t size;
} file;

static void put(file *f, const void *bytes, size_t n)
{
    assert_true(f->size + n <= sizeof f->bytes);
    memcpy(f->bytes + f->size, bytes, n);
    f->size += n;
}

static void put_number(file *f, uint64_t value, size_t n_bytes)
{
    for (size_t i = 0; i < n_bytes; i++) {
        const unsigned char byte = (unsigned char)(value >> 8*i);
        put(f, &byte, 1);
    }
}

static void put_int(file *f, int value)
{
    put_number(f, (uint32_t)value, 4);
}

static void put_float(file *f, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, 4);
    put_number(f, bits, 4);
}

static void put_name(file *f, const char *name)
{
    put(f, name, strlen(name) + 1);
}

static void put_attribute(file *f, const char *name, const char *type, int size)
{
    put_name(f, name);
    put_name(f, type);
    put_int(f, size);
}

static void put_window(file *f, const char *name, const layout *l)
{
    put_attribute(f, name, "box2i", 16);
    put_int(f, l->x);
    put_int(f, l->y);
    put_int(f, l->x + l->width - 1);
    put_int(f, l->y + l->height - 1);
}

/* An integer below 2048 as a half. */
static unsigned half_of(unsigned value)
{
    unsigned e = 0;
    while (value >> e > 1) {
        e++;
    }
    return value ? (e + 15) << 10 | ((value << 10 >> e) & 1023) : 0;
}

static void put_sample(file *f, int type, unsigned value)
{
    if (type == HALF) {
        put_number(f, half_of(value), 2);
    } else if (type == UINT) {
        put_number(f, value, 4);
    } else {
        put_float(f, (float)value);
    }
}

static void put_channels(file *f, const layout *l)
{
    int size = 1;
    for (int c = 0; l->channels[c]; c++) {
        size += (int)strlen(l->channels[c]) + 17;
    }
    put_attribute(f, "channels", "chlist", size);
    for (int c = 0; l->channels[c]; c++) {
        put_name(f, l->channels[c]);
        put_int(f, l->types[c]);
        put_int(f, 0); /* pLinear and three reserved bytes */
        put_int(f, l->sampling);
        put_int(f, l->sampling);
    }
    put_number(f, 0, 1);
}

/* Blocks of the picture; of a mipmap those of the second level, one tile, too. */
static int count_blocks(const layout *l)
{
    const int n_x = (l->width + TILE - 1)/TILE, n_y = (l->height + TILE - 1)/TILE;
    return l->kind == SCAN_LINES ? l->height : n_x*n_y + (l->kind == MIPMAP);
}

static void put_header(file *f, const layout *l, const char *name)
{
    put_channels(f, l);
    put_attribute(f, "compression", "compression", 1);
    put_number(f, 0, 1);
    put_window(f, "dataWindow", l);
    put_window(f, "displayWindow", l);
    put_attribute(f, "lineOrder", "lineOrder", 1);
    put_number(f, l->is_decreasing, 1);
    put_attribute(f, "pixelAspectRatio", "float", 4);
    put_float(f, 1.0f);
    put_attribute(f, "screenWindowCenter", "v2f", 8);
    put_float(f, 0.0f);
    put_float(f, 0.0f);
    put_attribute(f, "screenWindowWidth", "float", 4);
    put_float(f, 1.0f);
    if (l->kind != SCAN_LINES) {
        put_attribute(f, "tiles", "tiledesc", 9);
        put_int(f, TILE);
        put_int(f, TILE);
        put_number(f, l->kind == MIPMAP, 1);
    }
    if (l->is_multipart) {
        put_attribute(f, "name", "string", (int)strlen(name));
        put(f, name, strlen(name));
        put_attribute(f, "type", "string", 13);
        put(f, "scanlineimage", 13);
        put_attribute(f, "chunkCount", "int", 4);
        put_int(f, count_blocks(l));
    }
    put_number(f, 0, 1);
}

/* A block of w x h samples whose corner is at x, y of the picture. */
static void put_samples(file *f, const layout *l, int x, int y, int w, int h)
{
    const size_t at = f->size;
    put_int(f, 0);
    for (int j = y; j < y + h; j++) {
        for (int c = 0; l->channels[c]; c++) {
            for (int i = x; i < x + w; i++) {
                put_sample(f, l->types[c], (unsigned)(100*c + j*l->width + i));
            }
        }
    }
    file length = {.size = 0};
    put_int(&length, (int)(f->size - at - 4));
    memcpy(f->bytes + at, length.bytes, 4);
}

static void put_block(file *f, const layout *l, int number)
{
    const int n_x = (l->width + TILE - 1)/TILE;
    const bool is_level_1 = l->kind == MIPMAP && number == count_blocks(l) - 1;
    if (l->is_multipart) {
        put_int(f, 0);
    }
    if (l->kind == SCAN_LINES) {
        put_int(f, l->y + number);
        put_samples(f, l, 0, number, l->width, 1);
        return;
    }
    const int x = is_level_1 ? 0 : number%n_x, y = is_level_1 ? 0 : number/n_x;
    const int w = is_level_1 ? l->width/2 : l->width - x*TILE,
              h = is_level_1 ? l->height/2 : l->height - y*TILE;
    put_int(f, x);
    put_int(f, y);
    put_int(f, is_level_1);
    put_int(f, is_level_1);
    put_samples(f, l, x*TILE, y*TILE, w < TILE ? w : TILE, h < TILE ? h : TILE);
}

static void make_file(const layout *l, file *f)
{
    static const layout SECOND = {
        .channels = {"Y"}, .types = {HALF}, .sampling = 1, .width = 1, .height = 1, .is_multipart = true};
    const int n = count_blocks(l);
    put(f, "\x76\x2f\x31\x01", 4);
    put_int(f, 2 | l->flags | (l->kind != SCAN_LINES ? TILED_FLAG : 0) | (l->is_multipart ? MULTIPART_FLAG : 0));
    put_header(f, l, "first");
    if (l->is_multipart) {
        put_header(f, &SECOND, "second");
        put_number(f, 0, 1);
    }
    file table = {.size = 0};
    const size_t at = f->size;
    f->size += 8*(size_t)(n + l->is_multipart);
    size_t offsets[64];
    for (int i = 0; i < n; i++) {
        const int number = l->is_decreasing ? n - 1 - i : i;
        offsets[number] = f->size;
        put_block(f, l, number);
    }
    for (int i = 0; i < n; i++) {
        put_number(&table, offsets[i], 8);
    }
    if (l->is_multipart) {
        put_number(&table, f->size, 8);
        put_int(f, 1);
        put_int(f, 0);
        put_int(f, 2);
        put_number(f, 0, 2);
    }
    memcpy(f->bytes + at, table.bytes, table.size);
    f->bytes[offsets[0] + 4] = (unsigned char)(f->bytes[offsets[0] + 4] - l->missing_bytes); /* scan lines */
}

/* sources: the file's channel number behind each channel of the picture. */
static void assert_reads(const layout *l, size_t n_channels, const int *sources)
{
    file f = {.size = 0};
    make_file(l, &f);
    image p = {0};
    facet_error why = {0};
    if (image_decode(f.bytes, f.size, &p, &why) != FACET_OK) {
        fail_msg("%s: %s", why.place, why.text);
    }
    assert_int_equal(p.width, l->width);
    assert_int_equal(p.height, l->height);
    assert_int_equal(p.n_channels, n_channels);
    assert_int_equal(p.type, PIXEL_F32);
    for (size_t i = 0; i < p.width*p.height; i++) {
        for (size_t c = 0; c < n_channels; c++) {
            assert_true(((const float *)p.pixels)[i*n_channels + c] == (float)(100*sources[c] + (int)i));
        }
    }
    image_destroy(&p);
    /* The last byte is missed unless it belongs to a part or a level that is not read. */
    assert_int_equal(image_decode(f.bytes, f.size - 1, &p, &why) == FACET_OK, l->is_multipart || l->kind == MIPMAP);
    image_destroy(&p);
}

static void assert_refuses(const layout *l, facet_status status, const char *part)
{
    file f = {.size = 0};
    make_file(l, &f);
    image p = {0};
    facet_error why = {0};
    const facet_status result = image_decode(f.bytes, f.size, &p, &why);
    if (result != status || !strstr(why.text, part)) {
        fail_msg("status %d, %s: %s", (int)result, why.place, why.text);
    }
    assert_null(p.pixels);
}

static const int RGB_SOURCES[] = {2, 1, 0}; /* B, G, R by name */

static const layout RGB = {
    .channels = {"B", "G", "R"}, .types = {HALF, HALF, HALF}, .sampling = 1, .width = 5, .height = 3};

static void the_data_window_alone_makes_the_picture(void **state)
{
    (void)state;
    layout l = RGB;
    assert_reads(&l, 3, RGB_SOURCES);
    l.x = -7;
    l.y = 1000;
    assert_reads(&l, 3, RGB_SOURCES);
}

static void lines_may_lie_from_the_bottom_up(void **state)
{
    (void)state;
    layout l = RGB;
    l.is_decreasing = true;
    assert_reads(&l, 3, RGB_SOURCES);
}

static void tiles_are_put_together(void **state)
{
    (void)state;
    layout l = RGB;
    l.kind = TILES;
    assert_reads(&l, 3, RGB_SOURCES);
    l.x = 3;
    l.y = -8;
    assert_reads(&l, 3, RGB_SOURCES);
}

static void a_mipmap_gives_its_full_resolution(void **state)
{
    (void)state;
    layout l = RGB;
    l.kind = MIPMAP;
    l.width = 3; /* levels 3 x 3 and 1 x 1 */
    assert_reads(&l, 3, RGB_SOURCES);
}

static void the_first_part_is_read(void **state)
{
    (void)state;
    layout l = RGB;
    l.is_multipart = true;
    assert_reads(&l, 3, RGB_SOURCES);
}

static void sample_types_may_be_mixed_and_other_channels_left_out(void **state)
{
    (void)state;
    static const layout MIXED = {.channels = {"A", "B", "G", "R", "Z"},
                                 .types = {HALF, FLOAT, UINT, HALF, FLOAT},
                                 .sampling = 1,
                                 .width = 4,
                                 .height = 2};
    static const int SOURCES[] = {3, 2, 1, 0};
    assert_reads(&MIXED, 4, SOURCES);
    static const layout GREY = {
        .channels = {"A", "Y", "Z"}, .types = {FLOAT, HALF, UINT}, .sampling = 1, .width = 4, .height = 2};
    static const int GREY_SOURCES[] = {1, 0};
    assert_reads(&GREY, 2, GREY_SOURCES);
}

static void what_is_not_read_is_refused_by_name(void **state)
{
    (void)state;
    layout l = RGB;
    l.channels[0] = "C";
    assert_refuses(&l, FACET_UNSUPPORTED, "no channel B");
    l = (layout){.channels = {"left.B", "left.G", "left.R"},
                 .types = {HALF, HALF, HALF},
                 .sampling = 1,
                 .width = 2,
                 .height = 2};
    assert_refuses(&l, FACET_UNSUPPORTED, "left.R");
    l = (layout){.channels = {"Z"}, .types = {FLOAT}, .sampling = 1, .width = 2, .height = 2};
    assert_refuses(&l, FACET_UNSUPPORTED, "the first of its 1 is Z");
    l.channels[0] = "Y";
    l.sampling = 2;
    assert_refuses(&l, FACET_UNSUPPORTED, "subsampled");
    l = RGB;
    l.flags = DEEP_FLAG;
    assert_refuses(&l, FACET_UNSUPPORTED, "deep");
}

static void a_block_of_the_wrong_size_is_refused(void **state)
{
    (void)state;
    layout l = RGB;
    l.missing_bytes = 2; /* the length that the first block states */
    assert_refuses(&l, FACET_BAD_FILE, "another size");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_data_window_alone_makes_the_picture),
        cmocka_unit_test(lines_may_lie_from_the_bottom_up),
        cmocka_unit_test(tiles_are_put_together),
        cmocka_unit_test(a_mipmap_gives_its_full_resolution),
        cmocka_unit_test(the_first_part_is_read),
        cmocka_unit_test(sample_types_may_be_mixed_and_other_channels_left_out),
        cmocka_unit_test(what_is_not_read_is_refused_by_name),
        cmocka_unit_test(a_block_of_the_wrong_size_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
