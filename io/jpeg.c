/* jpeg.c: JPEG read, through libjpeg (turbo).
 *
 * Baseline and progressive, grey and YCbCr or RGB, 8 bits, Huffman coded.  CMYK, arithmetic coding and
 * lossless JPEG are refused by name.  What libjpeg would only warn of, lost picture data, is an error.
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <setjmp.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <jpeglib.h>
/* jerror.h needs jpeglib.h before it. */
#include <jerror.h>

#include "core/error.h"

/* A progressive file may repeat scans of the whole picture without end; real ones have about ten. */
#define MAX_SCANS 200

/* One coded block takes at least one bit, and holds 8x8 samples of which one may stand for 4x4 pixels. */
#define MAX_PIXELS_PER_BYTE ((size_t)8*64*16)

/* All that one reading holds; it lives in the caller of the function that calls setjmp. */
typedef struct job {
    struct jpeg_error_mgr errors; /* first: libjpeg hands back a pointer to it */
    struct jpeg_progress_mgr progress;
    struct jpeg_decompress_struct jpeg;
    jmp_buf jump;
    size_t most; /* byte */
    image picture;
    facet_status status;
    char message[JMSG_LENGTH_MAX];
} job;

static void fail(job *j, facet_status status, const char *text)
{
    j->status = status;
    snprintf(j->message, sizeof j->message, "%s", text);
    longjmp(j->jump, 1);
}

static void on_error(j_common_ptr common)
{
    job *j = (job *)common->err;
    char text[JMSG_LENGTH_MAX];
    (*common->err->format_message)(common, text);
    switch (common->err->msg_code) {
    case JERR_OUT_OF_MEMORY: fail(j, FACET_NO_MEMORY, text); break;
    case JERR_BAD_PRECISION:
    case JERR_SOF_UNSUPPORTED:
    case JERR_CONVERSION_NOTIMPL: fail(j, FACET_UNSUPPORTED, text); break;
    default: fail(j, FACET_BAD_FILE, text);
    }
}

/* level < 0: libjpeg found damage and would go on with invented pixels. */
static void on_message(j_common_ptr common, int level)
{
    if (level >= 0) {
        return;
    }
    switch (common->err->msg_code) {
    case JWRN_JPEG_EOF: fail((job *)common->err, FACET_BAD_FILE, "the file is truncated"); break;
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_BOGUS_PROGRESSION: on_error(common); break;
    default: break; /* surplus bytes and odd header versions lose nothing */
    }
}

static void on_progress(j_common_ptr common)
{
    if (((j_decompress_ptr)common)->input_scan_number > MAX_SCANS) {
        fail((job *)common->err, FACET_BAD_FILE, "more than 200 progressive scans");
    }
}

/* Checks the header, and takes memory only then. */
static void prepare(job *j, size_t size)
{
    struct jpeg_decompress_struct *jpeg = &j->jpeg;
    jpeg_read_header(jpeg, TRUE);
    const size_t width = jpeg->image_width, height = jpeg->image_height;
    if (jpeg->arith_code) {
        fail(j, FACET_UNSUPPORTED, "arithmetic coding is not read; convert it with: jpegtran -optimize");
    }
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK) {
        fail(j, FACET_UNSUPPORTED, "CMYK colours are not read; convert it to RGB");
    }
    if (jpeg->jpeg_color_space == JCS_UNKNOWN) {
        fail(j, FACET_UNSUPPORTED, "colours other than grey, YCbCr and RGB are not read");
    }
    if (width*height/MAX_PIXELS_PER_BYTE > size) {
        fail(j, FACET_BAD_FILE, "the file is truncated: it is too short for its width and height");
    }
    const bool is_grey = jpeg->jpeg_color_space == JCS_GRAYSCALE;
    jpeg->out_color_space = is_grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    j->picture = (image){.width = width, .height = height, .n_channels = is_grey ? 1 : 3, .type = PIXEL_U8};
    /* All coefficients of a picture in several scans, 16 bits each, lie in memory, too. */
    const size_t copies = jpeg_has_multiple_scans(jpeg) ? 3 : 1;
    facet_error refusal;
    if (image_check_size(&j->picture, copies, j->most, &refusal) != FACET_OK) {
        fail(j, FACET_UNSUPPORTED, refusal.text);
    }
    j->picture.pixels = malloc(width*height*j->picture.n_channels);
    if (!j->picture.pixels) {
        fail(j, FACET_NO_MEMORY, "no memory for the pixels");
    }
}

/* On return j->status tells the result. */
static void read_picture(job *j, const unsigned char *bytes, size_t size)
{
    if (setjmp(j->jump)) {
        return;
    }
    jpeg_create_decompress(&j->jpeg);
    j->progress.progress_monitor = on_progress;
    j->jpeg.progress = &j->progress;
    jpeg_mem_src(&j->jpeg, bytes, (unsigned long)size);
    prepare(j, size);
    jpeg_start_decompress(&j->jpeg);
    const size_t row_size = j->picture.width*j->picture.n_channels;
    while (j->jpeg.output_scanline < j->jpeg.output_height) {
        JSAMPROW row = (JSAMPROW)j->picture.pixels + j->jpeg.output_scanline*row_size;
        jpeg_read_scanlines(&j->jpeg, &row, 1);
    }
    jpeg_finish_decompress(&j->jpeg);
}

facet_status jpeg_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why)
{
    if (size == 0) {
        return facet_error_set(why, FACET_BAD_FILE, "", "is empty; a JPEG picture was expected");
    }
    job *j = calloc(1, sizeof *j);
    if (!j) {
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory to read a JPEG file");
    }
    j->most = most;
    j->jpeg.err = jpeg_std_error(&j->errors);
    j->errors.error_exit = on_error;
    j->errors.emit_message = on_message;
    read_picture(j, bytes, size);
    char place[32] = "";
    if (j->status != FACET_OK && j->jpeg.src) {
        const size_t left = j->jpeg.src->bytes_in_buffer;
        snprintf(place, sizeof place, "byte %zu", left < size ? size - left : 0);
    }
    jpeg_destroy_decompress(&j->jpeg);
    const facet_status status = j->status;
    if (status == FACET_OK) {
        *picture = j->picture;
    } else {
        free(j->picture.pixels);
        facet_error_set(why, status, place, "JPEG: %s", j->message);
    }
    free(j);
    return status;
}
