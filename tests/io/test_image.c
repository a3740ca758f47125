/* test_image.c: pictures written and read back, pictures made by hand, and pictures cut short.
 * The collections of real and hostile files are read by test_image_corpus.c.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "io/file.h"
#include "io/image_file.h"

static char folder[32]; /* a fresh one for each test */
static char target[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/facet-test-XXXXXX");
    const int result = mkdtemp(folder) ? 0 : -1;
    snprintf(target, sizeof target, "%s/picture", folder);
    return result;
}

static int remove_folder(void **state)
{
    (void)state;
    remove(target);
    return rmdir(folder); /* fails if a temporary was left */
}

/* The same numbers in every run (Knuth's 64-bit LCG, upper bits). */
static uint32_t next_random(uint64_t *seed)
{
    *seed = *seed*6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*seed >> 32);
}

static size_t sample_size(pixel_type type)
{
    return type == PIXEL_U8 ? 1 : type == PIXEL_U16 ? 2 : 4;
}

static size_t byte_count(const image *p)
{
    return p->width*p->height*p->n_channels*sample_size(p->type);
}

/* Random bits, NaN and infinities among them. */
static image random_image(size_t width, size_t height, size_t n_channels, pixel_type type)
{
    image p = {width, height, n_channels, type, NULL};
    p.pixels = malloc(byte_count(&p));
    assert_non_null(p.pixels);
    uint64_t seed = width*31 + n_channels;
    for (size_t i = 0; i < byte_count(&p); i++) {
        ((unsigned char *)p.pixels)[i] = (unsigned char)next_random(&seed);
    }
    return p;
}

static void assert_same_picture(const image *a, const image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->n_channels, b->n_channels);
    assert_int_equal(a->type, b->type);
    assert_memory_equal(a->pixels, b->pixels, byte_count(a));
}

static image read_target(void)
{
    image p = {0};
    facet_error why = {0};
    if (image_read(target, &p, &why) != FACET_OK) {
        fail_msg("%s: %s", why.place, why.text);
    }
    return p;
}

static void read_bytes(const char *path, unsigned char **bytes, size_t *size)
{
    facet_error why = {0};
    if (file_read(path, bytes, size, &why) != FACET_OK) {
        fail_msg("%s: %s", path, why.text);
    }
}

/* Whether the file holds these bytes. */
static int holds(const unsigned char *file, size_t size, const void *bytes, size_t n)
{
    for (size_t i = 0; i + n <= size; i++) {
        if (memcmp(file + i, bytes, n) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Every proper prefix is refused, says why, and leaves the result alone. */
static void assert_prefixes_refused(const unsigned char *bytes, size_t size)
{
    for (size_t n = 0; n < size; n++) {
        unsigned char *prefix = malloc(n + 1); /* of its own, so that AddressSanitizer sees a step too far */
        memcpy(prefix, bytes, n);
        image p = {0};
        facet_error why = {0};
        const facet_status status = image_decode(prefix, n, &p, &why);
        if (status == FACET_OK || why.status != status || !why.text[0] || p.pixels) {
            fail_msg("the first %zu of %zu bytes: status %d, %s", n, size, (int)status, why.text);
        }
        free(prefix);
    }
}

static void assert_decodes_to(const void *bytes, size_t size, facet_status status, const char *part)
{
    image p = {0};
    facet_error why = {0};
    const facet_status result = image_decode(bytes, size, &p, &why);
    if (result != status || !strstr(why.text, part)) {
        fail_msg("status %d, %s", (int)result, why.text);
    }
    assert_null(p.pixels);
}

/* ---- OpenEXR ----------------------------------------------------------------------------------- */

static void exr_float_round_trip_is_bit_exact(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 4; n++) {
        image p = random_image(37, 35, n, PIXEL_F32), q; /* 35 rows: two full blocks of 16 and a part */
        facet_error why = {0};
        assert_int_equal(exr_write(target, &p, EXR_FLOAT, NULL, 0, NULL, NULL, &why), FACET_OK);
        q = read_target();
        assert_same_picture(&p, &q);
        image_destroy(&p);
        image_destroy(&q);
    }
}

/* Each of three pictures in turn is the one that readers look for; the others, of smaller samples, lie around it. */
static void exr_layers_do_not_disturb_each_other(void **state)
{
    (void)state;
    static const char *const rgb[4] = {"R", "G", "B"}, *const names[2][4] = {{"albedo.R", "albedo.G", "albedo.B"},
                                                                             {"Specular.X", "Specular.Y", "zeta"}};
    image pictures[3];
    for (size_t k = 0; k < 3; k++) pictures[k] = random_image(37, 35, 3, PIXEL_F32);
    for (size_t base = 0; base < 3; base++) {
        exr_layer layers[3];
        facet_error why = {0};
        for (size_t k = 0, n = 0; k < 3; k++) {
            layers[k] = (exr_layer){.picture = &pictures[k], .precision = k == base ? EXR_FLOAT : EXR_HALF};
            memcpy(layers[k].channels, k == base ? rgb : names[n], sizeof rgb);
            n += k != base;
        }
        assert_int_equal(exr_write_layers(target, layers, 3, NULL, 0, NULL, NULL, &why), FACET_OK);
        image q = read_target();
        assert_same_picture(&pictures[base], &q);
        image_destroy(&q);
        memcpy(layers[base].channels, names[1], sizeof rgb); /* a name twice */
        assert_int_equal(exr_write_layers(target, layers, 3, NULL, 0, NULL, NULL, &why), FACET_BAD_ARGUMENT);
    }
    image small = random_image(36, 35, 3, PIXEL_F32);
    const exr_layer uneven[2] = {{{"R", "G", "B"}, &pictures[0], EXR_FLOAT}, {{"a", "b", "c"}, &small, EXR_FLOAT}};
    assert_int_equal(exr_write_layers(target, uneven, 2, NULL, 0, NULL, NULL, NULL), FACET_BAD_ARGUMENT);
    assert_int_equal(exr_write_layers(target, uneven, 0, NULL, 0, NULL, NULL, NULL), FACET_BAD_ARGUMENT);
    image_destroy(&small);
    for (size_t k = 0; k < 3; k++) image_destroy(&pictures[k]);
}

/* The value of a half, from its definition. */
static float half_value(unsigned h)
{
    const int exponent = (int)(h >> 10 & 31);
    const double mantissa = h & 1023;
    const double value = exponent == 31  ? (mantissa == 0.0 ? INFINITY : NAN)
                         : exponent == 0 ? ldexp(mantissa, -24)
                                         : ldexp(1024.0 + mantissa, exponent - 25);
    return (float)(h & 0x8000 ? -value : value);
}

static void exr_half_keeps_every_half(void **state)
{
    (void)state;
    float *values = malloc(65536*sizeof *values);
    for (unsigned h = 0; h < 65536; h++) {
        values[h] = half_value(h);
    }
    const image p = {256, 256, 1, PIXEL_F32, values};
    facet_error why = {0};
    assert_int_equal(exr_write(target, &p, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_OK);
    image q = read_target();
    for (unsigned h = 0; h < 65536; h++) {
        const float back = ((const float *)q.pixels)[h];
        if (isnan(values[h]) ? !isnan(back) : memcmp(&back, &values[h], sizeof back) != 0) {
            fail_msg("half 0x%04x: wrote %a, read %a", h, (double)values[h], (double)back);
        }
    }
    image_destroy(&q);
    free(values);
}

/* Rounding to nearest: the error is at most half the distance to the next half, which is 2^(e-10) for a
 * value in [2^e, 2^(e+1)), and 2^-24 below 2^-14.  Ties go to the even neighbour; from 65520 on, the
 * middle between the largest half and the next power, the result is infinite. */
static void exr_half_rounds_to_nearest(void **state)
{
    (void)state;
    enum { N = 4096 };
    static float values[N];
    uint64_t seed = 5;
    for (int i = 0; i < N; i++) {
        values[i] = (float)ldexp(1.0 + next_random(&seed)*0x1p-32, i%44 - 28)*(i & 64 ? -1.0f : 1.0f);
    }
    static const float EDGES[][2] = {{65519.996f, 65504.0f},         {65520.0f, INFINITY}, {1.00048828125f, 1.0f},
                                     {1.00146484375f, 1.001953125f}, {0x1p-25f, 0.0f},     {0x1.8p-24f, 0x1p-23f}};
    const int n_edges = sizeof EDGES/sizeof EDGES[0];
    for (int i = 0; i < n_edges; i++) {
        values[i] = EDGES[i][0];
    }
    const image p = {64, N/64, 1, PIXEL_F32, values};
    facet_error why = {0};
    assert_int_equal(exr_write(target, &p, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_OK);
    image q = read_target();
    for (int i = 0; i < N; i++) {
        const double x = values[i], y = ((const float *)q.pixels)[i];
        int e;
        frexp(x, &e);
        const double ulp = ldexp(1.0, e - 1 < -14 ? -24 : e - 11);
        if (i < n_edges ? y != (double)EDGES[i][1] : fabs(x) < 65504.0 && fabs(y - x) > 0.5*ulp) {
            fail_msg("%d: wrote %a, read %a", i, x, y);
        }
    }
    image_destroy(&q);
}

/* What is to be noted, in the file's order: channels first, those of OpenEXR by name. */
static void assert_notes(const unsigned char *bytes, size_t size, const image_note *expected, size_t n)
{
    image_notes notes;
    facet_error why = {0};
    assert_int_equal(image_decode_notes(bytes, size, &notes, &why), FACET_OK);
    assert_int_equal(notes.n, n);
    for (size_t i = 0; i < n; i++) {
        assert_string_equal(notes.items[i].key, expected[i].key);
        assert_string_equal(notes.items[i].value, expected[i].value);
        assert_int_equal(notes.items[i].is_channel, expected[i].is_channel);
    }
    image_notes_destroy(&notes);
    for (size_t cut = 0; cut < size; cut += 1 + size/50) { /* whatever a cut file says, it ends well */
        unsigned char *start = malloc(cut + 1);
        assert_non_null(start);
        memcpy(start, bytes, cut);
        const facet_status status = image_decode_notes(start, cut, &notes, &why);
        assert_true(status == FACET_OK || (notes.n == 0 && !notes.items && why.text[0]));
        image_notes_destroy(&notes);
        free(start);
    }
}

static void exr_keeps_text_and_matrices(void **state)
{
    (void)state;
    const image_text text[] = {{"facet:seed", "42"},
                               {"facet:command line", "facet render --env \xc3\xa9t\xc3\xa9.hdr"},
                               {"facet:a name that needs the long names flag", "yes"}};
    float camera[16], ndc[16];
    for (int i = 0; i < 16; i++) {
        camera[i] = (float)i + 0.25f;
        ndc[i] = -(float)i;
    }
    image p = random_image(5, 3, 3, PIXEL_F32), q;
    facet_error why = {0};
    assert_int_equal(exr_write(target, &p, EXR_FLOAT, text, 3, camera, ndc, &why), FACET_OK);
    unsigned char *bytes;
    size_t size;
    read_bytes(target, &bytes, &size);
    /* An attribute is name 0 type 0 length32 value. */
    static const char SEED[] = "facet:seed\0string\0\2\0\0\0"
                               "42";
    assert_true(holds(bytes, size, SEED, sizeof SEED - 1));
    assert_true(holds(bytes, size, text[1].value, strlen(text[1].value)));
    assert_true(holds(bytes, size, text[2].key, strlen(text[2].key) + 1));
    unsigned char matrix[16 + 20 + 64] = "worldToCamera\0m44f\0\x40\0\0\0";
    memcpy(matrix + 23, camera, sizeof camera); /* on a little-endian machine, as is the file */
    assert_true(holds(bytes, size, matrix, 23 + 64));
    assert_true(holds(bytes, size, "worldToNDC\0m44f", 16));
    assert_true(holds(bytes, size, "chromaticities\0chromaticities\0\x20", 31));
    const image_note notes[] = {{true, (char *)"B", (char *)"float"},
                                {true, (char *)"G", (char *)"float"},
                                {true, (char *)"R", (char *)"float"},
                                {false, (char *)text[0].key, (char *)text[0].value},
                                {false, (char *)text[1].key, (char *)text[1].value},
                                {false, (char *)text[2].key, (char *)text[2].value}};
    assert_notes(bytes, size, notes, 6);
    free(bytes);
    q = read_target(); /* long names do not disturb the reader */
    assert_same_picture(&p, &q);
    image_destroy(&p);
    image_destroy(&q);
}

static void a_cut_exr_is_refused(void **state)
{
    (void)state;
    image p = random_image(4, 3, 3, PIXEL_F32);
    facet_error why = {0};
    assert_int_equal(exr_write(target, &p, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_OK);
    unsigned char *bytes;
    size_t size;
    read_bytes(target, &bytes, &size);
    assert_prefixes_refused(bytes, size);
    free(bytes);
    image_destroy(&p);
}

/* ---- PNG --------------------------------------------------------------------------------------- */

static void png_round_trip_is_bit_exact(void **state)
{
    (void)state;
    static const pixel_type TYPES[] = {PIXEL_U8, PIXEL_U16};
    for (size_t i = 0; i < 8; i++) {
        image p = random_image(33, 17, 1 + i%4, TYPES[i/4]), q;
        facet_error why = {0};
        assert_int_equal(png_write(target, &p, NULL, 0, &why), FACET_OK);
        q = read_target();
        assert_same_picture(&p, &q);
        image_destroy(&p);
        image_destroy(&q);
    }
}

static void png_keeps_text_and_is_marked_srgb(void **state)
{
    (void)state;
    const image_text text[] = {{"facet:seed", "42"}, {"facet:scene", "\xc3\xa9t\xc3\xa9"}};
    image p = random_image(3, 2, 3, PIXEL_U8);
    facet_error why = {0};
    assert_int_equal(png_write(target, &p, text, 2, &why), FACET_OK);
    unsigned char *bytes;
    size_t size;
    read_bytes(target, &bytes, &size);
    assert_true(holds(bytes, size,
                      "tEXtfacet:seed\0"
                      "42",
                      17));
    /* iTXt: keyword 0, not compressed 0 0, no language 0, no translated keyword 0, UTF-8 */
    assert_true(holds(bytes, size, "iTXtfacet:scene\0\0\0\0\0\xc3\xa9t\xc3\xa9", 25));
    assert_true(holds(bytes, size, "sRGB", 4));
    assert_prefixes_refused(bytes, size);
    const image_note notes[] = {{false, (char *)text[0].key, (char *)text[0].value},
                                {false, (char *)text[1].key, (char *)text[1].value}};
    assert_notes(bytes, size, notes, 2);
    free(bytes);
    image_destroy(&p);
}

/* ---- JPEG -------------------------------------------------------------------------------------- */

/* Flat blocks keep only their mean, in steps of at most 6/8 at this quality; two roundings of the colour
 * conversion add 1 each. */
static void jpeg_pictures_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t n_channels;
        int top[3], bottom[3];
    } CASES[] = {{"rgb.jpg", 3, {255, 0, 0}, {0, 0, 255}},
                 {"progressive.jpg", 3, {255, 0, 0}, {0, 0, 255}},
                 {"grey.jpg", 1, {51}, {204}}};
    for (size_t i = 0; i < 3; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/tests/data/jpeg/%s", FACET_SOURCE_DIR, CASES[i].name);
        image p = {0};
        facet_error why = {0};
        assert_int_equal(image_read(path, &p, &why), FACET_OK);
        assert_true(p.width == 16 && p.height == 16 && p.type == PIXEL_U8 && p.n_channels == CASES[i].n_channels);
        for (size_t k = 0; k < 256*p.n_channels; k++) {
            const int *expected = k < 128*p.n_channels ? CASES[i].top : CASES[i].bottom;
            const int value = ((const unsigned char *)p.pixels)[k];
            assert_in_range(value + 3 - expected[k%p.n_channels], 0, 6);
        }
        image_destroy(&p);
        unsigned char *bytes;
        size_t size;
        read_bytes(path, &bytes, &size);
        assert_prefixes_refused(bytes, size - 2); /* without the end marker alone, the picture is whole */
        free(bytes);
    }
}

static void cmyk_jpeg_is_refused_by_name(void **state)
{
    (void)state;
    unsigned char *bytes;
    size_t size;
    read_bytes(FACET_SOURCE_DIR "/tests/data/jpeg/cmyk.jpg", &bytes, &size);
    assert_decodes_to(bytes, size, FACET_UNSUPPORTED, "CMYK");
    free(bytes);
}

/* ---- Radiance HDR ------------------------------------------------------------------------------ */

/* Two columns, three rows; pixel (x, y) is (x + 1, y + 1, 2) in units of 1/128 with exponent 129. */
static size_t make_hdr(char *to, const char *variables, const char *resolution, const char *order)
{
    size_t n = (size_t)sprintf(to, "#?RADIANCE\n%s\n%s\n", variables, resolution);
    for (; *order; order++) { /* '0' to '5': the pixel's number in rows from the top left */
        const int i = *order - '0';
        const char pixel[4] = {(char)(i%2 + 1), (char)(i/2 + 1), 2, (char)129};
        memcpy(to + n, pixel, 4);
        n += 4;
    }
    return n;
}

static void hdr_reads_all_eight_axis_orders(void **state)
{
    (void)state;
    static const char *const CASES[8][2] = {{"-Y 3 +X 2", "012345"}, {"-Y 3 -X 2", "103254"}, {"+Y 3 +X 2", "452301"},
                                            {"+Y 3 -X 2", "543210"}, {"+X 2 -Y 3", "024135"}, {"-X 2 -Y 3", "135024"},
                                            {"+X 2 +Y 3", "420531"}, {"-X 2 +Y 3", "531420"}};
    for (size_t k = 0; k < 8; k++) {
        char file[256];
        const size_t size = make_hdr(file, "FORMAT=32-bit_rle_rgbe\n", CASES[k][0], CASES[k][1]);
        image p = {0};
        facet_error why = {0};
        assert_int_equal(image_decode((unsigned char *)file, size, &p, &why), FACET_OK);
        assert_true(p.width == 2 && p.height == 3 && p.n_channels == 3 && p.type == PIXEL_F32);
        for (int i = 0; i < 6; i++) {
            const float *pixel = (const float *)p.pixels + 3*i;
            assert_true(pixel[0] == (float)(i%2 + 1)/128.0f && pixel[1] == (float)(i/2 + 1)/128.0f &&
                        pixel[2] == 2.0f/128.0f);
        }
        image_destroy(&p);
        assert_prefixes_refused((unsigned char *)file, size);
    }
}

static void hdr_divides_by_exposure_and_colorcorr(void **state)
{
    (void)state;
    char file[256];
    size_t size = make_hdr(file, "EXPOSURE=2\nEXPOSURE= 4 \nCOLORCORR=1 .5 2\n", "-Y 3 +X 2", "555555");
    image p = {0};
    facet_error why = {0};
    assert_int_equal(image_decode((unsigned char *)file, size, &p, &why), FACET_OK);
    const float *pixel = p.pixels; /* (2, 3, 2)/128 before */
    assert_true(pixel[0] == 2.0f/128.0f/8.0f && pixel[1] == 3.0f/128.0f/4.0f &&
                pixel[2] == 2.0f/128.0f/16.0f);
    image_destroy(&p);
    static const char *const BAD[] = {"EXPOSURE=0\n",   "EXPOSURE=-1\n",   "EXPOSURE=x\n",
                                      "EXPOSURE=inf\n", "COLORCORR=1 2\n", "EXPOSURE=1e200\nEXPOSURE=1e200\n"};
    for (size_t i = 0; i < sizeof BAD/sizeof BAD[0]; i++) {
        size = make_hdr(file, BAD[i], "-Y 3 +X 2", "555555");
        assert_decodes_to(file, size, FACET_BAD_FILE, "positive number");
    }
}

/* 600 equal pixels as one literal and the two-digit run 599 = 87 + 2*256. */
static void hdr_reads_old_runs_of_several_digits(void **state)
{
    (void)state;
    char file[128];
    size_t size = (size_t)sprintf(file, "#?RGBE\n\n-Y 1 +X 600\n");
    static const unsigned char DATA[] = {128, 64, 32, 129, 1, 1, 1, 87, 1, 1, 1, 2};
    memcpy(file + size, DATA, sizeof DATA);
    size += sizeof DATA;
    image p = {0};
    facet_error why = {0};
    assert_int_equal(image_decode((unsigned char *)file, size, &p, &why), FACET_OK);
    const float *last = (const float *)p.pixels + 3*599;
    assert_true(last[0] == 1.0f && last[1] == 0.5f && last[2] == 0.25f);
    image_destroy(&p);
    assert_prefixes_refused((unsigned char *)file, size);
    file[size - 1] = 3; /* 855 pixels do not fit */
    assert_decodes_to(file, size, FACET_BAD_FILE, "longer than its scan line");
}

/* ---- Everything -------------------------------------------------------------------------------- */

static void other_kinds_are_refused_by_name(void **state)
{
    (void)state;
    assert_decodes_to("RIFF\x10\0\0\0WEBPVP8 ", 16, FACET_UNSUPPORTED, "WebP");
    assert_decodes_to("\xabKTX 20\xbb\r\n\x1a\n", 12, FACET_UNSUPPORTED, "KTX2");
    assert_decodes_to("\0\0\0\x1c"
                      "ftypavif\0\0\0\0",
                      16, FACET_UNSUPPORTED, "AVIF");
    assert_decodes_to("GIF89a\1\0\1\0", 10, FACET_UNSUPPORTED, "GIF");
    assert_decodes_to("hello, world", 12, FACET_BAD_FILE, "not a picture");
    assert_decodes_to("", 0, FACET_BAD_FILE, "empty");
}

static void a_failed_write_is_an_error_and_leaves_nothing(void **state)
{
    (void)state;
    image f = random_image(200, 200, 3, PIXEL_F32), u = random_image(200, 200, 3, PIXEL_U8);
    facet_error why = {0};
    char missing[80];
    snprintf(missing, sizeof missing, "%s/missing/picture", folder);
    assert_int_equal(exr_write(missing, &f, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_IO);
    assert_int_equal(png_write(missing, &u, NULL, 0, &why), FACET_IO);
    assert_int_equal(exr_write(target, &u, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(png_write(target, &f, NULL, 0, &why), FACET_BAD_ARGUMENT);
    const image_text clash = {"channels", "not a list of channels"}, spaced = {"two words", "x"};
    assert_int_equal(exr_write(target, &f, EXR_HALF, &clash, 1, NULL, NULL, &why), FACET_BAD_ARGUMENT);
    assert_int_equal(png_write(target, &u, &spaced, 1, &why), FACET_BAD_ARGUMENT);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(exr_write("/dev/full", &f, EXR_HALF, NULL, 0, NULL, NULL, &why), FACET_IO);
        assert_non_null(strstr(why.text, "no space left"));
        assert_int_equal(png_write("/dev/full", &u, NULL, 0, &why), FACET_IO);
        assert_non_null(strstr(why.text, "no space left"));
    } else {
        print_message("/dev/full is missing: a full disk is not tested\n");
    }
    image_destroy(&f);
    image_destroy(&u);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(exr_float_round_trip_is_bit_exact),
        TEST(exr_layers_do_not_disturb_each_other),
        TEST(exr_half_keeps_every_half),
        TEST(exr_half_rounds_to_nearest),
        TEST(exr_keeps_text_and_matrices),
        TEST(a_cut_exr_is_refused),
        TEST(png_round_trip_is_bit_exact),
        TEST(png_keeps_text_and_is_marked_srgb),
        TEST(jpeg_pictures_are_read),
        TEST(cmyk_jpeg_is_refused_by_name),
        TEST(hdr_reads_all_eight_axis_orders),
        TEST(hdr_divides_by_exposure_and_colorcorr),
        TEST(hdr_reads_old_runs_of_several_digits),
        TEST(other_kinds_are_refused_by_name),
        TEST(a_failed_write_is_an_error_and_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
