/* test_image_corpus.c: collections of real, damaged and hostile pictures, outside the source tree.
 *
 * They lie in ../shared/assets beside the source directory; without it these tests are skipped.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "io/image_file.h"

#define ASSETS FACET_SOURCE_DIR "/../shared/assets"

static void skip_without(const char *path)
{
    DIR *directory = opendir(path);
    if (!directory) {
        print_message("%s is absent\n", path);
        skip();
    }
    closedir(directory);
}

/* Reads a file that may be anything, and checks what every caller relies on. */
static facet_status read_any(const char *path, image *picture)
{
    facet_error why = {0};
    *picture = (image){0};
    const facet_status status = image_read(path, picture, &why);
    if (status == FACET_IO || status == FACET_BAD_ARGUMENT || (status != FACET_OK) != (why.text[0] != 0) ||
        (status == FACET_OK) != (picture->pixels != NULL)) {
        fail_msg("%s: status %d, %s: %s", path, (int)status, why.place, why.text);
    }
    return status;
}

/* ---- Hostile files ----------------------------------------------------------------------------- */

static void crafted_files_end_as_expected(void **state)
{
    (void)state;
    skip_without(ASSETS "/badinput/crafted");
    FILE *table = fopen(ASSETS "/badinput/crafted/expected.tsv", "r");
    assert_non_null(table);
    char line[512], name[128], expected[32];
    int n = 0;
    while (fgets(line, sizeof line, table)) {
        if (sscanf(line, "%127s %31s", name, expected) != 2 ||
            (strncmp(name, "hdr_", 4) != 0 && strncmp(name, "png_", 4) != 0 && strncmp(name, "exr_", 4) != 0)) {
            continue;
        }
        char path[1024];
        snprintf(path, sizeof path, "%s/badinput/crafted/%s", ASSETS, name);
        image p;
        const facet_status status = read_any(path, &p);
        if ((strcmp(expected, "must_load") == 0 && status != FACET_OK) ||
            (strcmp(expected, "must_reject") == 0 && status == FACET_OK)) {
            fail_msg("%s: status %d, but %s", name, (int)status, expected);
        }
        image_destroy(&p);
        n++;
    }
    fclose(table);
    assert_true(n >= 50);
}

/* Reads every file of a folder; their number. */
static int read_folder(const char *folder)
{
    skip_without(folder);
    int n = 0;
    DIR *directory = opendir(folder);
    for (struct dirent *e = readdir(directory); e; e = readdir(directory)) {
        if (e->d_name[0] != '.') {
            char path[1024];
            snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
            image p;
            read_any(path, &p);
            image_destroy(&p);
            n++;
        }
    }
    closedir(directory);
    return n;
}

static void damaged_exr_files_do_no_harm(void **state)
{
    (void)state;
    assert_true(read_folder(ASSETS "/badinput/openexr-damaged") >= 80);
    assert_true(read_folder(ASSETS "/badinput/openexr-test") >= 15);
}

/* Half of the 4 GiB of a small machine; the largest real picture here takes 6 MiB. */
static void reading_all_this_took_less_than_2_gib(void **state)
{
    (void)state;
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    assert_in_range(usage.ru_maxrss, 0, 2048L*1024); /* [KiB] */
}

/* ---- PngSuite ---------------------------------------------------------------------------------- */

/* FNV-1a of the bytes of the pixels: how the collection's reference results were made. */
static uint32_t pixel_hash(const image *p)
{
    uint32_t hash = 0x811c9dc5u;
    for (size_t i = 0; i < p->width*p->height*p->n_channels; i++) {
        hash = (hash ^ ((const unsigned char *)p->pixels)[i])*0x01000193u;
    }
    return hash;
}

static void pngsuite_pictures_equal_their_references(void **state)
{
    (void)state;
    skip_without(ASSETS "/badinput/pngsuite/primary");
    FILE *table = fopen(ASSETS "/badinput/pngsuite/ref_results.csv", "r");
    assert_non_null(table);
    char line[512], name[128];
    int n_good = 0, n_corrupt = 0;
    while (fgets(line, sizeof line, table)) {
        size_t width, height, n_channels;
        const char *hash = strstr(line, ",0x");
        if (!hash || sscanf(line, "%127[^,],%zu,%zu,%zu", name, &width, &height, &n_channels) != 4) {
            continue;
        }
        const int is_corrupt = strstr(name, "/corrupt/") != NULL;
        if (!is_corrupt && !strstr(name, "/primary/")) {
            continue; /* lists more than the collection holds */
        }
        char path[1024];
        snprintf(path, sizeof path, "%s/badinput/%s", ASSETS, name);
        image p;
        const facet_status status = read_any(path, &p);
        if (is_corrupt) {
            if (status != FACET_BAD_FILE) { /* two of them only in check sums that the reference ignores */
                fail_msg("%s: status %d", name, (int)status);
            }
            n_corrupt++;
            continue;
        }
        if (status != FACET_OK || p.width != width || p.height != height || p.n_channels != n_channels ||
            p.type != PIXEL_U8 || pixel_hash(&p) != strtoul(hash + 1, NULL, 16)) {
            fail_msg("%s differs from its reference", name);
        }
        image_destroy(&p);
        n_good++;
    }
    fclose(table);
    assert_int_equal(n_good, 77);
    assert_int_equal(n_corrupt, 14);
}

/* ---- Environment maps -------------------------------------------------------------------------- */

static void environment_maps_load(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"chinese_garden_1k.hdr",  "lebombo_1k.hdr",
                                        "potsdamer_platz_1k.hdr", "studio_small_03_1k.hdr",
                                        "courtyard_zip_half.exr", "synthetic/one_texel_sun_1024x512.hdr"};
    skip_without(ASSETS "/hdri");
    for (size_t i = 0; i < sizeof NAMES/sizeof NAMES[0]; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/hdri/%s", ASSETS, NAMES[i]);
        image p;
        assert_int_equal(read_any(path, &p), FACET_OK);
        assert_true(p.width == 1024 && p.height == 512 && p.n_channels == 3 && p.type == PIXEL_F32);
        for (size_t k = 0; k < p.width*p.height*3; k++) {
            const float value = ((const float *)p.pixels)[k];
            /* courtyard went through a lossy coding that left small negative values, to be kept */
            assert_true(isfinite(value) && value >= (strstr(NAMES[i], ".exr") ? -0.01f : 0.0f));
        }
        image_destroy(&p);
    }
}

static void white_furnace_is_exactly_one(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"white_furnace_64x32.hdr", "white_furnace_64x32.exr"};
    skip_without(ASSETS "/hdri/synthetic");
    for (size_t i = 0; i < 2; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/hdri/synthetic/%s", ASSETS, NAMES[i]);
        image p;
        assert_int_equal(read_any(path, &p), FACET_OK);
        for (size_t k = 0; k < p.width*p.height*p.n_channels; k++) {
            assert_true(((const float *)p.pixels)[k] == 1.0f);
        }
        image_destroy(&p);
    }
}

enum { WIDTH = 512, HEIGHT = 256 };

static image read_axes(const char *variant)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/hdri/synthetic/axes_512x256%s", ASSETS, variant);
    image p;
    assert_int_equal(read_any(path, &p), FACET_OK);
    assert_true(p.width == WIDTH && p.height == HEIGHT && p.n_channels == 3 && p.type == PIXEL_F32);
    return p;
}

/* How far apart a and b may be, next to max, the largest component of the pixel. */
typedef double tolerance(double a, double max);

/* Half keeps 11 bits: half a unit is 2^-11 of the power of two below, at most of the value. */
static double half_tolerance(double a, double max)
{
    (void)max;
    return a*0x1p-11;
}

/* PXR24 keeps 16 of the 24 bits of a float and rounds to nearest. */
static double pxr24_tolerance(double a, double max)
{
    (void)max;
    return a*0x1p-16;
}

/* RGBE cuts off below one unit, and the largest component has at least 128 of them. */
static double rgbe_tolerance(double a, double max)
{
    (void)a;
    return max*0x1p-7;
}

static void axes_agree_in_all_codings(void **state)
{
    (void)state;
    skip_without(ASSETS "/hdri/synthetic");
    static const struct {
        const char *variant;
        tolerance *allowed;
    } CASES[] = {{"_none.exr", half_tolerance},     {"_rle.exr", half_tolerance},
                 {"_piz_half.exr", half_tolerance}, {"_tiled64_zip.exr", half_tolerance},
                 {"_pxr24.exr", pxr24_tolerance},   {".hdr", rgbe_tolerance}};
    image reference = read_axes("_zips_float.exr");
    const float *a = reference.pixels;
    for (size_t i = 0; i < sizeof CASES/sizeof CASES[0]; i++) {
        image p = read_axes(CASES[i].variant);
        const float *b = p.pixels;
        for (size_t k = 0; k < WIDTH*HEIGHT*3; k++) {
            const float *pixel = a + k - k%3;
            const double max = fmax(pixel[0], fmax(pixel[1], pixel[2]));
            if (fabs((double)a[k] - b[k]) > CASES[i].allowed(a[k], max)) {
                fail_msg("%s at %zu,%zu: %a, not %a", CASES[i].variant, k/3%WIDTH, k/3/WIDTH, (double)b[k],
                         (double)a[k]);
            }
        }
        image_destroy(&p);
    }
    image_destroy(&reference);
}

/* The nearest half of a positive normal one, as its bits, which count halves in order. */
static int half_code(float value)
{
    int e;
    const double m = frexp(value, &e); /* [1/2, 1) */
    return (e + 14)*1024 + (int)lrint((2.0*m - 1.0)*1024.0);
}

/* B44 stores 16 halves as differences of 6 bits with a common shift, rounded.  The shift is the smallest
 * that fits: with one less, a difference, at most the block's range, was over 30 units even after
 * rounding.  So half a unit of the larger shift is at most range/30, and flat blocks are exact. */
static void axes_in_b44_agree_within_their_blocks(void **state)
{
    (void)state;
    skip_without(ASSETS "/hdri/synthetic");
    image reference = read_axes("_zips_float.exr"), p = read_axes("_b44.exr");
    const float *a = reference.pixels, *b = p.pixels;
    for (size_t i = 0; i < WIDTH*HEIGHT*3; i++) {
        const size_t c = i%3, x = i/3%WIDTH, y = i/3/WIDTH;
        int low = INT32_MAX, high = 0;
        for (size_t k = 0; k < 16; k++) {
            const int code = half_code(a[((y - y%4 + k/4)*WIDTH + x - x%4 + k%4)*3 + c]);
            low = code < low ? code : low;
            high = code > high ? code : high;
        }
        const int error = abs(half_code(b[i]) - half_code(a[i]));
        if (30*error > high - low) {
            fail_msg("%zu,%zu: %a, not %a, in a block of %d halves", x, y, (double)b[i], (double)a[i], high - low);
        }
    }
    image_destroy(&reference);
    image_destroy(&p);
}

static void dwa_is_refused_by_name_with_the_remedy(void **state)
{
    (void)state;
    skip_without(ASSETS "/hdri/synthetic");
    image p = {0};
    facet_error why = {0};
    assert_int_equal(image_read(ASSETS "/hdri/synthetic/axes_512x256_dwaa.exr", &p, &why), FACET_UNSUPPORTED);
    assert_non_null(strstr(why.text, "DWAA"));
    assert_non_null(strstr(why.text, "--compression zip"));
    assert_int_equal(image_read(ASSETS "/hdri/courtyard.exr", &p, &why), FACET_UNSUPPORTED);
    assert_non_null(strstr(why.text, "DWAB"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crafted_files_end_as_expected),
        cmocka_unit_test(damaged_exr_files_do_no_harm),
        cmocka_unit_test(pngsuite_pictures_equal_their_references),
        cmocka_unit_test(environment_maps_load),
        cmocka_unit_test(white_furnace_is_exactly_one),
        cmocka_unit_test(axes_agree_in_all_codings),
        cmocka_unit_test(axes_in_b44_agree_within_their_blocks),
        cmocka_unit_test(dwa_is_refused_by_name_with_the_remedy),
        cmocka_unit_test(reading_all_this_took_less_than_2_gib),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
