/* png.c: PNG read and written, through libpng.
 *
 * Read: every colour type and depth.  Palettes and depths below 8 are expanded to 8 bits, a tRNS chunk
 * becomes an alpha channel, 16 bits stay 16.  gAMA, cHRM and iCCP are ignored, as glTF 2.0 (3.9.2) asks.
 * Damage of any kind is an error, missing last rows and wrong check sums of critical chunks included.
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <png.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"

/* Ancillary chunks (text, profiles) are read into memory before they are dropped. */
#define CHUNK_MEMORY ((png_alloc_size_t)8 << 20)
#define CHUNK_COUNT 1000

/* zlib codes at best 258 bytes in 2 bits. */
#define DEFLATE_RATIO 1032

#define MAX_SIDE 0x7fffffffu

/* All that one reading or writing holds.  It lives in the caller of the function that calls setjmp, so
 * that nothing in it is lost when libpng jumps. */
typedef struct job {
    png_structp png;
    png_infop info;
    const unsigned char *bytes; /* reading */
    size_t size, at, most;
    FILE *stream; /* writing */
    unsigned char *pixels;
    png_bytepp rows;
    png_textp texts;
    image picture;
    bool is_fast; /* compressed a little, for a picture that is shown once */
    bool is_out_of_memory, is_io_error;
    facet_error refusal; /* of a size */
    char message[160];
} job;

static PNG_FUNCTION(void, on_error, (png_structp png, png_const_charp text), PNG_NORETURN)
{
    job *j = png_get_error_ptr(png);
    snprintf(j->message, sizeof j->message, "%s", text);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static void *allocate(job *j, size_t n)
{
    void *memory = malloc(n);
    if (!memory) {
        j->is_out_of_memory = true;
        png_error(j->png, "no memory for the pixels");
    }
    return memory;
}

/* ---- Reading ----------------------------------------------------------------------------------- */

static void read_bytes(png_structp png, png_bytep to, size_t n)
{
    job *j = png_get_io_ptr(png);
    if (n > j->size - j->at) {
        j->at = j->size;
        png_error(png, "the file is truncated");
    }
    memcpy(to, j->bytes + j->at, n);
    j->at += n;
}

/* Checks that all chunks lie inside the file, up to the last one, because libpng clears as much memory as a
 * chunk claims before it reads.  *at is where the check stopped; NULL if all is well. */
static const char *check_chunks(const unsigned char *bytes, size_t size, size_t *at)
{
    *at = 0;
    if (size < 8 || memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) != 0) return "its first 8 bytes are not those of a PNG file";
    for (*at = 8; size - *at >= 12;) { /* length, name, data, check sum */
        const unsigned char *p = bytes + *at;
        const size_t length = (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | p[3];
        if (length > size - *at - 12) return "the file is truncated, or the length of a chunk is wrong";
        if (memcmp(p + 4, "IEND", 4) == 0) return NULL;
        *at += length + 12;
    }
    return "the file is truncated: it has no IEND chunk";
}

/* Checks the declared size before memory is taken for it, and chooses the conversions. */
static void prepare_read(job *j)
{
    png_read_info(j->png, j->info);
    const size_t width = png_get_image_width(j->png, j->info);
    const size_t height = png_get_image_height(j->png, j->info);
    if (png_get_rowbytes(j->png, j->info) > (j->size*DEFLATE_RATIO)/height) {
        png_error(j->png, "the file is truncated: it is too short for its width and height");
    }
    png_set_expand(j->png); /* palettes, depths below 8, tRNS */
    if (png_get_bit_depth(j->png, j->info) == 16 && is_little_endian()) {
        png_set_swap(j->png);
    }
    png_set_interlace_handling(j->png);
    png_read_update_info(j->png, j->info);
    j->picture = (image){.width = width,
                         .height = height,
                         .n_channels = png_get_channels(j->png, j->info),
                         .type = png_get_bit_depth(j->png, j->info) == 16 ? PIXEL_U16 : PIXEL_U8};
    if (image_check_size(&j->picture, 1, j->most, &j->refusal) != FACET_OK) {
        png_error(j->png, "the picture is too large");
    }
}

static void limit_reading(job *j)
{
    png_set_read_fn(j->png, j, read_bytes);
    png_set_user_limits(j->png, MAX_SIDE, MAX_SIDE); /* prepare_read bounds the product */
    png_set_chunk_malloc_max(j->png, CHUNK_MEMORY);
    png_set_chunk_cache_max(j->png, CHUNK_COUNT);
    png_set_keep_unknown_chunks(j->png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
}

/* Only what comes before the pixels, where facet writes its texts; false if libpng jumped out. */
static bool read_info(job *j)
{
    if (setjmp(png_jmpbuf(j->png))) {
        return false;
    }
    limit_reading(j);
    png_read_info(j->png, j->info);
    return true;
}

/* false if libpng jumped out. */
static bool read_picture(job *j)
{
    if (setjmp(png_jmpbuf(j->png))) {
        return false;
    }
    limit_reading(j);
    prepare_read(j);
    const size_t row_size = png_get_rowbytes(j->png, j->info), height = j->picture.height;
    j->pixels = allocate(j, row_size*height);
    j->rows = allocate(j, height*sizeof *j->rows);
    for (size_t y = 0; y < height; y++) {
        j->rows[y] = j->pixels + y*row_size;
    }
    png_read_image(j->png, j->rows);
    png_read_end(j->png, NULL);
    return true;
}

/* Does one reading of a file. */
static facet_status run_reading(job *j, bool (*read)(job *j), facet_error *why)
{
    char place[32];
    size_t at;
    const char *damage = check_chunks(j->bytes, j->size, &at);
    if (damage) {
        snprintf(place, sizeof place, "byte %zu", at);
        return facet_error_set(why, FACET_BAD_FILE, place, "PNG: %s", damage);
    }
    j->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, j, on_error, on_warning);
    j->info = j->png ? png_create_info_struct(j->png) : NULL;
    if (!j->info) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory to read a PNG file");
    if (read(j)) return FACET_OK;
    snprintf(place, sizeof place, "byte %zu", j->at);
    if (j->refusal.status != FACET_OK) return facet_error_set(why, j->refusal.status, "", "PNG: %s", j->refusal.text);
    return facet_error_set(why, j->is_out_of_memory ? FACET_NO_MEMORY : FACET_BAD_FILE, place, "PNG: %s", j->message);
}

facet_status png_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why)
{
    job j = {.bytes = bytes, .size = size};
    facet_status status = run_reading(&j, read_info, why);
    png_textp texts = NULL;
    const int n = status == FACET_OK ? png_get_text(j.png, j.info, &texts, NULL) : 0;
    for (int i = 0; i < n && !status; i++) {
        if (strncmp(texts[i].key, IMAGE_TEXT_PREFIX, strlen(IMAGE_TEXT_PREFIX)) != 0) continue;
        status = image_notes_add(notes, false, texts[i].key, texts[i].text, strlen(texts[i].text));
        if (status) facet_error_set(why, status, "", "no memory for its texts");
    }
    png_destroy_read_struct(&j.png, &j.info, NULL);
    return status;
}

facet_status png_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why)
{
    job j = {.bytes = bytes, .size = size, .most = most};
    const facet_status status = run_reading(&j, read_picture, why);
    png_destroy_read_struct(&j.png, &j.info, NULL);
    free(j.rows);
    if (status != FACET_OK) {
        free(j.pixels);
        return status;
    }
    j.picture.pixels = j.pixels;
    *picture = j.picture;
    return FACET_OK;
}

/* ---- Writing ----------------------------------------------------------------------------------- */

static void write_bytes(png_structp png, png_bytep from, size_t n)
{
    job *j = png_get_io_ptr(png);
    if (fwrite(from, 1, n, j->stream) != n) {
        j->is_io_error = true;
        png_error(png, "a write failed");
    }
}

static void flush_bytes(png_structp png)
{
    (void)png; /* file_writer_commit flushes */
}

/* PNG asks for keywords of 1 to 79 characters without spaces at the ends or in a row. */
static bool is_keyword(const char *key)
{
    const size_t n = key ? strlen(key) : 0;
    for (size_t i = 0; i < n; i++) {
        if (key[i] < '!' || key[i] > '~') {
            return false;
        }
    }
    return n >= 1 && n <= 79;
}

static bool is_ascii(const char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text >= 128) {
            return false;
        }
    }
    return true;
}

/* ASCII is the same in tEXt (Latin-1) and iTXt (UTF-8); the rest goes into iTXt. */
static void set_texts(job *j, const image_text *text, size_t n_texts)
{
    j->texts = allocate(j, n_texts*sizeof *j->texts + 1);
    for (size_t i = 0; i < n_texts; i++) {
        /* libpng only reads through the two pointers that it wants without const. */
        j->texts[i] = (png_text){.compression = PNG_TEXT_COMPRESSION_NONE,
                                 .key = (png_charp)text[i].key,
                                 .text = (png_charp)text[i].value,
                                 .text_length = strlen(text[i].value)};
        if (!is_ascii(text[i].value)) {
            j->texts[i].compression = PNG_ITXT_COMPRESSION_NONE;
            j->texts[i].itxt_length = j->texts[i].text_length;
            j->texts[i].text_length = 0;
        }
    }
    png_set_text(j->png, j->info, j->texts, (int)n_texts);
}

/* false if libpng jumped out. */
static bool write_picture(job *j, const image *picture, const image_text *text, size_t n_texts)
{
    static const int TYPES[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                PNG_COLOR_TYPE_RGB_ALPHA};
    if (setjmp(png_jmpbuf(j->png))) {
        return false;
    }
    const size_t sample = picture->type == PIXEL_U16 ? 2 : 1;
    png_set_write_fn(j->png, j, write_bytes, flush_bytes);
    png_set_user_limits(j->png, MAX_SIDE, MAX_SIDE);
    png_set_IHDR(j->png, j->info, (png_uint_32)picture->width, (png_uint_32)picture->height, (int)sample*8,
                 TYPES[picture->n_channels], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (j->is_fast) {
        png_set_compression_level(j->png, 1);
        png_set_filter(j->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    }
    png_set_sRGB(j->png, j->info, PNG_sRGB_INTENT_PERCEPTUAL);
    set_texts(j, text, n_texts);
    png_write_info(j->png, j->info);
    if (sample == 2 && is_little_endian()) {
        png_set_swap(j->png);
    }
    for (size_t y = 0; y < picture->height; y++) {
        png_write_row(j->png, (png_const_bytep)picture->pixels + y*picture->width*picture->n_channels*sample);
    }
    png_write_end(j->png, j->info);
    return true;
}

static facet_status check_arguments(const image *picture, const image_text *text, size_t n_texts, facet_error *why)
{
    if (!picture || !picture->pixels || (n_texts > 0 && !text) || n_texts > CHUNK_COUNT) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "png_write needs a picture and at most %d texts",
                               CHUNK_COUNT);
    }
    if ((picture->type != PIXEL_U8 && picture->type != PIXEL_U16) || picture->n_channels < 1 ||
        picture->n_channels > 4 || picture->width < 1 || picture->height < 1 || picture->height > MAX_SIDE ||
        picture->width > IMAGE_PIXEL_CAP/picture->height) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "",
                               "PNG holds 1 to 4 channels of 8 or 16 bits, and is written up to 2^28 pixels");
    }
    for (size_t i = 0; i < n_texts; i++) {
        if (!is_keyword(text[i].key) || !text[i].value) {
            return facet_error_set(why, FACET_BAD_ARGUMENT, text[i].key,
                                   "a PNG keyword has 1 to 79 printable ASCII characters without spaces");
        }
    }
    return FACET_OK;
}

/* Writes to a stream; whether the stream took it is for its owner to find out. */
static facet_status write_stream(FILE *stream, bool is_fast, const image *picture, const image_text *text,
                                 size_t n_texts, facet_error *why)
{
    facet_status status = FACET_OK;
    job j = {.stream = stream, .is_fast = is_fast};
    j.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &j, on_error, on_warning);
    j.info = j.png ? png_create_info_struct(j.png) : NULL;
    if (!j.info) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory to write a PNG file");
    } else if (!write_picture(&j, picture, text, n_texts) && !j.is_io_error) {
        status = facet_error_set(why, j.is_out_of_memory ? FACET_NO_MEMORY : FACET_BAD_ARGUMENT, "", "PNG: %s",
                                 j.message);
    }
    png_destroy_write_struct(&j.png, &j.info);
    free(j.texts);
    return status;
}

facet_status png_write(const char *path, const image *picture, const image_text *text, size_t n_texts, facet_error *why)
{
    facet_status status = check_arguments(picture, text, n_texts, why);
    if (status != FACET_OK) {
        return status;
    }
    file_writer writer;
    status = file_writer_open(&writer, path, why);
    if (status != FACET_OK) {
        return status;
    }
    status = write_stream(writer.stream, false, picture, text, n_texts, why);
    if (status != FACET_OK) {
        file_writer_discard(&writer);
        return status;
    }
    return file_writer_commit(&writer, why); /* a failed write is found here, with its cause */
}

facet_status png_encode(const image *picture, char **bytes, size_t *size, facet_error *why)
{
    facet_status status = check_arguments(picture, NULL, 0, why);
    if (status != FACET_OK) {
        return status;
    }
    char *made = NULL;
    size_t n_made = 0;
    FILE *stream = open_memstream(&made, &n_made);
    if (!stream) {
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a PNG picture");
    }
    status = write_stream(stream, true, picture, NULL, 0, why);
    const bool is_whole = !ferror(stream);
    if (fclose(stream) != 0 || !is_whole) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a PNG picture");
    }
    if (status != FACET_OK) {
        free(made);
        return status;
    }
    *bytes = made;
    *size = n_made;
    return FACET_OK;
}
