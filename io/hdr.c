/* hdr.c: Radiance pictures (.hdr, .pic), read.
 *
 * [radiance] G. Ward, "Real Pixels", Graphics Gems II (1991), and the Radiance file format reference: a
 * text header, one resolution line, and scan lines of RGBE pixels that are flat, run-length coded in
 * the old way (a pixel 1,1,1,n repeats the one before), or in the new one (each component by itself).
 *
 * A pixel (m, e) is m 2^(e-136), and (m, 0) is 0.  Radiance's own tools add 1/2 to m; the writers of
 * environment maps do not expect it, and without it white (128,128,128,129) is exactly 1.
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"

/* Lengths that the new run-length coding can hold [pixel]. */
enum { NEW_RLE_MIN = 8, NEW_RLE_MAX = 0x7fff };

/* Where reading stands. */
typedef struct cursor {
    const unsigned char *bytes;
    size_t size, at;
} cursor;

/* Axis 0 runs from one scan line to the next, axis 1 along a scan line. */
typedef struct axis {
    bool is_x;
    bool is_reversed; /* against the order of struct image: from the bottom, or from the right */
    size_t length;
} axis;

typedef struct header {
    double divisor[3]; /* the product of all EXPOSURE and COLORCORR lines */
    axis axes[2];
} header;

static facet_status bad(facet_error *why, size_t at, const char *text)
{
    char place[32];
    snprintf(place, sizeof place, "byte %zu", at);
    return facet_error_set(why, FACET_BAD_FILE, place, "%s", text);
}

/* ---- Header ------------------------------------------------------------------------------------ */

/* The next line, without its end (LF or CR LF); false if the file ends first. */
static bool next_line(cursor *c, const char **line, size_t *length)
{
    const unsigned char *begin = c->bytes + c->at;
    const unsigned char *end = memchr(begin, '\n', c->size - c->at);
    if (!end) {
        return false;
    }
    c->at = (size_t)(end - c->bytes) + 1;
    *line = (const char *)begin;
    *length = (size_t)(end - begin);
    if (*length > 0 && (*line)[*length - 1] == '\r') {
        --*length;
    }
    return true;
}

/* If the line is "KEY=value", copies the value, cut to fit, without spaces at its ends. */
static bool value_of(const char *line, size_t length, const char *key, char *value, size_t capacity)
{
    const size_t n_key = strlen(key);
    if (length < n_key || memcmp(line, key, n_key) != 0) {
        return false;
    }
    line += n_key;
    length -= n_key;
    while (length > 0 && (*line == ' ' || *line == '\t')) {
        line++;
        length--;
    }
    while (length > 0 && (line[length - 1] == ' ' || line[length - 1] == '\t')) {
        length--;
    }
    length = length < capacity ? length : capacity - 1;
    memcpy(value, line, length);
    value[length] = 0;
    return true;
}

/* Multiplies n numbers of the text into divisor; one number counts for all three. */
static bool multiply_divisor(const char *text, size_t n, double divisor[3])
{
    double factor[3] = {0};
    for (size_t i = 0; i < n; i++) {
        char *end;
        factor[i] = strtod(text, &end);
        if (end == text || !(factor[i] > 0.0) || !isfinite(factor[i])) {
            return false;
        }
        text = end;
    }
    for (size_t i = 0; i < 3; i++) {
        divisor[i] *= factor[i < n ? i : 0];
        if (!isnormal(divisor[i]) || !isnormal(1.0/divisor[i])) {
            return false;
        }
    }
    return *text == 0;
}

static facet_status read_variables(cursor *c, header *h, facet_error *why)
{
    const char *line;
    size_t length, start = c->at;
    while (next_line(c, &line, &length)) {
        char value[128];
        if (length == 0) {
            return FACET_OK;
        }
        if (value_of(line, length, "FORMAT=", value, sizeof value)) {
            if (strcmp(value, "32-bit_rle_xyze") == 0) {
                return facet_error_set(why, FACET_UNSUPPORTED, "FORMAT",
                                       "XYZE colours are not read; convert with Radiance: ra_xyze -r IN OUT");
            }
            if (strcmp(value, "32-bit_rle_rgbe") != 0) {
                return bad(why, start, "FORMAT is not 32-bit_rle_rgbe");
            }
        } else if (value_of(line, length, "EXPOSURE=", value, sizeof value)) {
            if (!multiply_divisor(value, 1, h->divisor)) {
                return bad(why, start, "EXPOSURE must be one positive number");
            }
        } else if (value_of(line, length, "COLORCORR=", value, sizeof value)) {
            if (!multiply_divisor(value, 3, h->divisor)) {
                return bad(why, start, "COLORCORR must be three positive numbers");
            }
        }
        start = c->at;
    }
    return bad(why, start, "the header does not end with an empty line");
}

/* Reads "-Y 512" and what follows of it; false if it is not like that.  Numbers too long become huge. */
static bool read_axis(const char **line, const char *end, axis *a)
{
    const char *p = *line;
    while (p < end && *p == ' ') {
        p++;
    }
    if (end - p < 4 || (p[0] != '+' && p[0] != '-') || (p[1] != 'X' && p[1] != 'Y') || p[2] != ' ') {
        return false;
    }
    a->is_x = p[1] == 'X';
    a->is_reversed = a->is_x ? p[0] == '-' : p[0] == '+'; /* Radiance's y points up */
    for (p += 3; p < end && *p == ' '; p++) {}
    size_t length = 0;
    const char *first = p;
    for (; p < end && *p >= '0' && *p <= '9'; p++) {
        length = length > IMAGE_PIXEL_CAP ? length : length*10 + (size_t)(*p - '0');
    }
    a->length = length;
    *line = p;
    return p > first && length > 0;
}

static facet_status read_resolution(cursor *c, header *h, facet_error *why)
{
    const size_t start = c->at;
    const char *line;
    size_t length;
    if (!next_line(c, &line, &length)) {
        return bad(why, start, "the resolution line is missing, such as -Y 512 +X 1024");
    }
    const char *end = line + length;
    if (!read_axis(&line, end, &h->axes[0]) || !read_axis(&line, end, &h->axes[1]) ||
        h->axes[0].is_x == h->axes[1].is_x || line != end) {
        return bad(why, start, "the resolution line is not like -Y 512 +X 1024, both numbers positive");
    }
    const size_t n_lines = h->axes[0].length, n = h->axes[1].length;
    if (n > IMAGE_PIXEL_CAP/n_lines) {
        return facet_error_set(why, FACET_UNSUPPORTED, "resolution", "is more than %zu pixels", IMAGE_PIXEL_CAP);
    }
    /* The shortest scan line of all: one pixel, and in the old coding one run that repeats it. */
    const size_t shortest = n > 1 ? 8 : 4;
    if ((c->size - c->at)/shortest < n_lines) {
        return bad(why, c->size, "the file is truncated: it is too short for its resolution");
    }
    return FACET_OK;
}

static facet_status read_header(cursor *c, header *h, facet_error *why)
{
    const char *line;
    size_t length;
    if (!next_line(c, &line, &length) ||
        !((length >= 10 && memcmp(line, "#?RADIANCE", 10) == 0) || (length >= 6 && memcmp(line, "#?RGBE", 6) == 0))) {
        return bad(why, 0, "does not begin with #?RADIANCE or #?RGBE: not a Radiance picture");
    }
    *h = (header){.divisor = {1.0, 1.0, 1.0}};
    const facet_status status = read_variables(c, h, why);
    return status == FACET_OK ? read_resolution(c, h, why) : status;
}

/* ---- Scan lines -------------------------------------------------------------------------------- */

static const char TRUNCATED[] = "the file is truncated inside a scan line";

/* Old coding, of which flat pixels are the case without runs. */
static facet_status read_old_line(cursor *c, unsigned char (*line)[4], size_t n, facet_error *why)
{
    unsigned shift = 0; /* successive runs are the digits of one count, lowest first */
    for (size_t i = 0; i < n;) {
        if (c->size - c->at < 4) {
            return bad(why, c->size, TRUNCATED);
        }
        const unsigned char *p = c->bytes + c->at;
        if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
            if (i == 0 || shift > 24) {
                return bad(why, c->at, "a run has no pixel to repeat");
            }
            const size_t count = (size_t)p[3] << shift;
            if (count > n - i) {
                return bad(why, c->at, "a run is longer than its scan line");
            }
            for (size_t k = 0; k < count; k++) {
                memcpy(line[i + k], line[i - 1], 4);
            }
            i += count;
            shift += 8;
        } else {
            memcpy(line[i++], p, 4);
            shift = 0;
        }
        c->at += 4;
    }
    return FACET_OK;
}

/* One component of a new scan line. */
static facet_status read_component(cursor *c, unsigned char (*line)[4], size_t n, size_t component, facet_error *why)
{
    for (size_t i = 0; i < n;) {
        if (c->at >= c->size) {
            return bad(why, c->size, TRUNCATED);
        }
        const size_t start = c->at;
        const unsigned code = c->bytes[c->at++];
        const bool is_run = code > 128;
        const size_t count = is_run ? code - 128 : code;
        if (count == 0 || count > n - i) {
            return bad(why, start, count == 0 ? "a literal of length 0" : "a run is longer than its scan line");
        }
        if (c->size - c->at < (is_run ? 1 : count)) {
            return bad(why, c->size, TRUNCATED);
        }
        for (size_t k = 0; k < count; k++) {
            line[i + k][component] = c->bytes[c->at + (is_run ? 0 : k)];
        }
        c->at += is_run ? 1 : count;
        i += count;
    }
    return FACET_OK;
}

static facet_status read_line(cursor *c, unsigned char (*line)[4], size_t n, facet_error *why)
{
    const unsigned char *p = c->bytes + c->at;
    if (n < NEW_RLE_MIN || n > NEW_RLE_MAX || c->size - c->at < 4 || p[0] != 2 || p[1] != 2 || p[2] >= 128) {
        return read_old_line(c, line, n, why);
    }
    if (((size_t)p[2] << 8 | p[3]) != n) {
        return bad(why, c->at, "a scan line says another length than the resolution line");
    }
    c->at += 4;
    facet_status status = FACET_OK;
    for (size_t component = 0; component < 4 && status == FACET_OK; component++) {
        status = read_component(c, line, n, component, why);
    }
    return status;
}

/* Stores scan line i where the axes say. */
static void store_line(const header *h, size_t i, unsigned char (*line)[4], size_t width, float (*pixels)[3])
{
    const axis *slow = &h->axes[0], *fast = &h->axes[1];
    const size_t at_slow = slow->is_reversed ? slow->length - 1 - i : i;
    for (size_t j = 0; j < fast->length; j++) {
        const size_t at_fast = fast->is_reversed ? fast->length - 1 - j : j;
        float *pixel = pixels[slow->is_x ? at_fast*width + at_slow : at_slow*width + at_fast];
        const double unit = line[j][3] ? ldexp(1.0, (int)line[j][3] - 136) : 0.0;
        for (size_t k = 0; k < 3; k++) {
            pixel[k] = (float)(line[j][k]*unit/h->divisor[k]);
        }
    }
}

facet_status hdr_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why)
{
    cursor c = {bytes, size, 0};
    header h;
    facet_status status = read_header(&c, &h, why);
    if (status != FACET_OK) {
        return status;
    }
    const size_t n_lines = h.axes[0].length, n = h.axes[1].length;
    const size_t width = h.axes[0].is_x ? n_lines : n;
    image decoded = {.width = width, .height = n_lines*n/width, .n_channels = 3, .type = PIXEL_F32};
    status = image_check_size(&decoded, 1, most, why);
    if (status != FACET_OK) {
        return status;
    }
    float(*pixels)[3] = malloc(n_lines*n*sizeof *pixels);
    unsigned char(*line)[4] = malloc(n*sizeof *line);
    if (!pixels || !line) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for %zu x %zu pixels", n_lines, n);
    }
    for (size_t i = 0; i < n_lines && status == FACET_OK; i++) {
        status = read_line(&c, line, n, why);
        if (status == FACET_OK) {
            store_line(&h, i, line, width, pixels);
        }
    }
    free(line);
    if (status != FACET_OK) {
        free(pixels);
        return status;
    }
    decoded.pixels = pixels;
    *picture = decoded;
    return FACET_OK;
}
