/* test_checkpoint.c: a render's state survives its file bit for bit, and no damage to the file goes unnoticed.
 * SPDX-License-Identifier: MIT */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/checkpoint.h"
#include "io/file.h"
#include "tests/draws.h"
#include "tests/run_program.h"

static char *folder;

static int setup(void **state)
{
    (void)state;
    folder = make_folder();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

static const image_text texts[] = {
    {"facet:version", "0.1.0"}, {"facet:command", "facet render 'a b.glb'\n"}, {"facet:camera", ""}};
enum { N_TEXTS = sizeof texts/sizeof *texts };

/* Every field of a state with bits of its own. */
static render_state some_state(size_t width, size_t height)
{
    draws d = {width};
    render_state state = {.n_paths = draw_bits(&d),
                          .n_rays = draw_bits(&d),
                          .n_shadow_rays = draw_bits(&d),
                          .n_bad = draw_bits(&d),
                          .seconds = 1e3*draw(&d),
                          .cpu_seconds = 1e3*draw(&d),
                          .mean_luminance = draw(&d),
                          .spp = 77};
    if (film_create(width, height, &state.film)) fail();
    if (width%2 && film_keep_features(&state.film)) fail();
    state.film.n_clamped = draw_bits(&d);
    for (uint32_t i = 0; i < RENDER_MAX_REPORTED; i++) state.bad[i] = (bad_sample){i, 2*i, 1u << 31 | i};
    for (size_t i = 0; i < width*height; i++) {
        film_pixel *p = &state.film.pixels[i];
        for (int k = 0; k < 3; k++) p->rgb[k] = (exact_sum){draw_bits(&d), draw_bits(&d)};
        p->luminance_squares = (exact_sum){draw_bits(&d), draw_bits(&d)};
        p->n = (uint32_t)draw_bits(&d);
        if (!state.film.features) continue;
        film_features *q = &state.film.features[i];
        for (int k = 0; k < 3; k++) {
            q->albedo[k] = (int64_t)draw_bits(&d);
            q->normal[k] = (int64_t)draw_bits(&d);
        }
        q->distance = (exact_sum){draw_bits(&d), draw_bits(&d)};
        q->n_hits = (uint32_t)draw_bits(&d);
    }
    return state;
}

static void assert_same_film(const film *a, const film *b)
{
    assert_true(!a->features == !b->features);
    assert_true(a->width == b->width && a->height == b->height && a->n_clamped == b->n_clamped);
    for (size_t i = 0; i < a->width*a->height; i++) { /* not the padding */
        const film_pixel *p = &a->pixels[i], *q = &b->pixels[i];
        assert_memory_equal(p->rgb, q->rgb, sizeof p->rgb);
        assert_memory_equal(&p->luminance_squares, &q->luminance_squares, sizeof p->luminance_squares);
        assert_int_equal(p->n, q->n);
        if (!b->features) continue;
        const film_features *r = &a->features[i], *s = &b->features[i];
        assert_memory_equal(r->albedo, s->albedo, sizeof r->albedo);
        assert_memory_equal(r->normal, s->normal, sizeof r->normal);
        assert_memory_equal(&r->distance, &s->distance, sizeof r->distance);
        assert_int_equal(r->n_hits, s->n_hits);
    }
}

static void a_state_survives_its_file(void **state)
{
    (void)state;
    static const size_t sizes[][2] = {{1, 1}, {3, 2}, {1, 50}, {301, 7}};
    const char *path = in_folder(folder, "a.ckpt");
    for (size_t i = 0; i < sizeof sizes/sizeof *sizes; i++) {
        render_state made = some_state(sizes[i][0], sizes[i][1]);
        checkpoint c;
        facet_error why = {0};
        assert_int_equal(checkpoint_write(path, &made, texts, N_TEXTS, &why), FACET_OK);
        assert_int_equal(checkpoint_read(path, true, &c, &why), FACET_OK);
        assert_same_film(&c.state.film, &made.film);
        assert_true(c.state.n_paths == made.n_paths && c.state.n_rays == made.n_rays);
        assert_true(c.state.n_shadow_rays == made.n_shadow_rays && c.state.n_bad == made.n_bad);
        assert_true(c.state.seconds == made.seconds && c.state.cpu_seconds == made.cpu_seconds);
        assert_int_equal(c.state.spp, made.spp);
        assert_true(c.state.mean_luminance == made.mean_luminance);
        assert_memory_equal(c.state.bad, made.bad, sizeof made.bad);
        assert_int_equal(c.n_texts, N_TEXTS);
        for (size_t k = 0; k < N_TEXTS; k++) {
            assert_string_equal(c.texts[k].key, texts[k].key);
            assert_string_equal(checkpoint_text(&c, texts[k].key), texts[k].value);
        }
        assert_null(checkpoint_text(&c, "facet:none"));
        checkpoint_destroy(&c);
        assert_int_equal(checkpoint_read(path, false, &c, &why), FACET_OK);
        assert_null(c.state.film.pixels);
        assert_int_equal(c.state.film.width, made.film.width);
        checkpoint_destroy(&c);
        render_state_destroy(&made);
    }
}

static void write_bytes(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* A small checkpoint's bytes. */
static char *some_bytes(size_t *size)
{
    const char *path = in_folder(folder, "b.ckpt");
    render_state made = some_state(3, 2);
    assert_int_equal(checkpoint_write(path, &made, texts, N_TEXTS, NULL), FACET_OK);
    render_state_destroy(&made);
    char *bytes = read_bytes(path, size);
    assert_non_null(bytes);
    return bytes;
}

static void expect_refusal(const char *path, size_t place)
{
    checkpoint c;
    facet_error why = {0};
    if (checkpoint_read(path, true, &c, &why) == FACET_OK) fail_msg("not noticed at byte %zu", place);
    assert_true(why.text[0] != 0);
}

/* Each bit alone, and each byte as a whole. */
static void every_flip_of_a_bit_or_byte_is_refused(void **state)
{
    (void)state;
    size_t size;
    char *bytes = some_bytes(&size);
    const char *path = in_folder(folder, "flipped.ckpt");
    write_bytes(path, bytes, size);
    const int file = open(path, O_WRONLY);
    for (size_t i = 0; i < size; i++) {
        for (int bit = 0; bit <= 8; bit++) {
            const char flipped = bytes[i] ^ (char)(bit < 8 ? 1 << bit : 0xff);
            assert_int_equal(pwrite(file, &flipped, 1, (off_t)i), 1);
            expect_refusal(path, i);
        }
        assert_int_equal(pwrite(file, &bytes[i], 1, (off_t)i), 1);
    }
    close(file);
    free(bytes);
}

static void every_truncation_and_extension_is_refused(void **state)
{
    (void)state;
    size_t size;
    char *bytes = some_bytes(&size);
    const char *path = in_folder(folder, "cut.ckpt");
    write_bytes(path, bytes, size);
    for (size_t i = size; i-- > 0;) {
        assert_int_equal(truncate(path, (off_t)i), 0);
        expect_refusal(path, i);
    }
    write_bytes(path, bytes, size + 1); /* with read_bytes' closing 0 */
    expect_refusal(path, size);
    write_bytes(path, bytes, size);
    checkpoint c;
    assert_int_equal(checkpoint_read(path, true, &c, NULL), FACET_OK);
    checkpoint_destroy(&c);
    free(bytes);
}

/* A sector of zeros, or of another row, is what disks bring. */
static void exchanged_and_zeroed_rows_are_refused(void **state)
{
    (void)state;
    enum { ROW = 3*136 + 4 };
    size_t size;
    char *bytes = some_bytes(&size), *first = bytes + size - 2*ROW, row[ROW];
    const char *path = in_folder(folder, "rows.ckpt");
    memcpy(row, first, ROW);
    memcpy(first, first + ROW, ROW);
    memcpy(first + ROW, row, ROW);
    write_bytes(path, bytes, size);
    expect_refusal(path, size - ROW);
    memset(first, 0, ROW);
    write_bytes(path, bytes, size);
    expect_refusal(path, size - ROW);
    free(bytes);
}

/* zlib's CRC-32, bit by bit. */
static uint32_t crc_of(uint32_t crc, const char *bytes, size_t size)
{
    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned char)bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

enum { HEAD_SIZE = 8 + 4*6 + 8*8 + 12*RENDER_MAX_REPORTED, TEXTS_AT = HEAD_SIZE + 4 };

/* Makes the checksums of a head and texts right again. */
static void forge(char *bytes, size_t text_size)
{
    uint32_t crc = crc_of(0, bytes, HEAD_SIZE);
    memcpy(bytes + HEAD_SIZE, &crc, 4);
    crc = crc_of(crc, bytes + TEXTS_AT, text_size);
    memcpy(bytes + TEXTS_AT + text_size, &crc, 4);
}

/* What a checksum does not stop: sizes that lie, and texts without ends. */
static void forged_files_are_refused_or_read_within_their_bounds(void **state)
{
    (void)state;
    static const uint32_t sizes[][3] = {/* of texts, width, height */
                                        {0, 0, 1},          {0, 1, 0},          {0, 65536, 65536}, {0, 65537, 1},
                                        {0, 1, UINT32_MAX}, {UINT32_MAX, 1, 1}, {1 << 30, 1, 1},   {9, 1, 1}};
    const char *path = in_folder(folder, "forged.ckpt");
    size_t size;
    char *bytes = some_bytes(&size);
    for (size_t i = 0; i < sizeof sizes/sizeof *sizes; i++) {
        memcpy(bytes + 12, sizes[i], sizeof sizes[i]);
        forge(bytes, 0);
        write_bytes(path, bytes, size);
        expect_refusal(path, i);
    }
    /* A picture of one pixel whose texts are bytes of any kind; its row is wrong, but its head can be read. */
    static const char *const ends[] = {"", "k", "key=value", "\377\377\377", "a\0b", "\0\0\0"};
    static const uint32_t lengths[] = {0, 1, 9, 3, 3, 3};
    for (size_t i = 0; i < sizeof ends/sizeof *ends; i++) {
        const uint32_t forged[3] = {lengths[i], 1, 1};
        checkpoint c;
        memcpy(bytes + 12, forged, sizeof forged);
        memcpy(bytes + TEXTS_AT, ends[i], lengths[i]);
        forge(bytes, lengths[i]);
        write_bytes(path, bytes, TEXTS_AT + lengths[i] + 4 + 136 + 4);
        assert_int_equal(checkpoint_read(path, false, &c, NULL), FACET_OK);
        for (size_t k = 0; k < c.n_texts; k++) assert_non_null(checkpoint_text(&c, c.texts[k].key));
        checkpoint_destroy(&c);
        expect_refusal(path, i);
    }
    free(bytes);
}

static void each_refusal_has_its_reason(void **state)
{
    (void)state;
    size_t size;
    char *bytes = some_bytes(&size);
    const char *path = in_folder(folder, "c.ckpt");
    checkpoint c;
    facet_error why = {0};
    assert_int_equal(checkpoint_read(in_folder(folder, "none.ckpt"), true, &c, &why), FACET_IO);
    assert_string_equal(why.text, "cannot open: No such file or directory");
    write_text(path, "no checkpoint");
    assert_int_equal(checkpoint_read(path, true, &c, &why), FACET_BAD_FILE);
    assert_string_equal(why.text, "is not a checkpoint of facet");
    write_bytes(path, bytes, size - 1);
    assert_int_equal(checkpoint_read(path, true, &c, &why), FACET_BAD_FILE);
    assert_non_null(strstr(why.text, "bytes in place of"));
    bytes[8] = 1;
    write_bytes(path, bytes, size);
    assert_int_equal(checkpoint_read(path, true, &c, &why), FACET_UNSUPPORTED);
    assert_string_equal(why.text, "is a checkpoint of format 1; this facet reads format 2");
    bytes[8] = 2;
    bytes[size - 5] ^= 1;
    write_bytes(path, bytes, size);
    assert_int_equal(checkpoint_read(path, true, &c, &why), FACET_BAD_FILE);
    assert_non_null(strstr(why.text, "the checksum of its pixels is wrong"));
    assert_int_equal(checkpoint_read(path, false, &c, &why), FACET_OK); /* the head is whole */
    checkpoint_destroy(&c);
    free(bytes);
}

static void leftovers_of_killed_writers_are_removed(void **state)
{
    (void)state;
    /* No process has a number of nine digits; 1 is always there. */
    static const char *const names[] = {"d.ckpt",
                                        "d.ckpt.tmp-999999917-0",
                                        "d.ckpt.tmp-999999909-13",
                                        "dd.ckpt.tmp-999999917-0",
                                        "d.ckpt.tmp",
                                        "d.ckpt.tmp-1-0",
                                        "d.ckpt.tmp-notes",
                                        "d.ckpt.tmp-999999917",
                                        "d.ckpt.tmp-999999917-",
                                        "d.ckpt.tmp-999999917-0x",
                                        "d.ckpt.tmp--999999917-0",
                                        "d.ckpt.tmp-99999999999999999999-0"};
    enum { N_NAMES = sizeof names/sizeof *names };
    for (size_t i = 0; i < N_NAMES; i++) write_text(in_folder(folder, names[i]), "x");
    char own[64];
    snprintf(own, sizeof own, "d.ckpt.tmp-%ld-0", (long)getpid()); /* of an earlier process with this number */
    write_text(in_folder(folder, own), "x");
    file_remove_leftovers(in_folder(folder, "d.ckpt"));
    for (size_t i = 0; i < N_NAMES; i++)
        assert_int_equal(access(in_folder(folder, names[i]), F_OK) == 0, i != 1 && i != 2);
    assert_int_not_equal(access(in_folder(folder, own), F_OK), 0);
    file_remove_leftovers(in_folder(folder, "no such folder/d.ckpt"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_state_survives_its_file),
        cmocka_unit_test(every_flip_of_a_bit_or_byte_is_refused),
        cmocka_unit_test(every_truncation_and_extension_is_refused),
        cmocka_unit_test(exchanged_and_zeroed_rows_are_refused),
        cmocka_unit_test(forged_files_are_refused_or_read_within_their_bounds),
        cmocka_unit_test(each_refusal_has_its_reason),
        cmocka_unit_test(leftovers_of_killed_writers_are_removed),
    };
    return cmocka_run_group_tests_name("checkpoint", tests, setup, teardown);
}
