/* checkpoint.c: a render's state to and from a file (checkpoint.h).
 * SPDX-License-Identifier: MIT */
#include "io/checkpoint.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "core/error.h"
#include "io/file.h"

enum {
    TEXT_CAP = 1 << 20, /* bytes of all texts */
    SIDE_CAP = 65536
};

static const char MAGIC[8] = {'f', 'a', 'c', 'e', 't', 'c', 'k', 'p'};

/* ---- Numbers ------------------------------------------------------------------------------------- */

static void put32(unsigned char **to, uint32_t value)
{
    for (int i = 0; i < 4; i++) *(*to)++ = (unsigned char)(value >> 8*i);
}

static void put64(unsigned char **to, uint64_t value)
{
    put32(to, (uint32_t)value);
    put32(to, (uint32_t)(value >> 32));
}

static void put_double(unsigned char **to, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put64(to, bits);
}

static uint32_t get32(const unsigned char **from)
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++) value |= (uint32_t)*(*from)++ << 8*i;
    return value;
}

static uint64_t get64(const unsigned char **from)
{
    const uint64_t low = get32(from);
    return low | (uint64_t)get32(from) << 32;
}

static double get_double(const unsigned char **from)
{
    const uint64_t bits = get64(from);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* ---- The parts ----------------------------------------------------------------------------------- */

static void put_head(unsigned char *to, const render_state *state, uint32_t text_size)
{
    memcpy(to, MAGIC, sizeof MAGIC);
    to += sizeof MAGIC;
    put32(&to, CHECKPOINT_VERSION);
    put32(&to, text_size);
    put32(&to, (uint32_t)state->film.width);
    put32(&to, (uint32_t)state->film.height);
    put32(&to, state->film.features != NULL);
    put32(&to, state->spp);
    put64(&to, state->n_paths);
    put64(&to, state->n_rays);
    put64(&to, state->n_shadow_rays);
    put64(&to, state->n_bad);
    put64(&to, state->film.n_clamped);
    put_double(&to, state->seconds);
    put_double(&to, state->cpu_seconds);
    put_double(&to, state->mean_luminance);
    for (int i = 0; i < RENDER_MAX_REPORTED; i++) {
        put32(&to, state->bad[i].x);
        put32(&to, state->bad[i].y);
        put32(&to, state->bad[i].sample);
    }
}

/* Behind the magic and the version; false: a word has a value that is never written. */
static bool get_head(const unsigned char *from, checkpoint *c, uint32_t *text_size)
{
    render_state *state = &c->state;
    *state = (render_state){0};
    *text_size = get32(&from);
    state->film.width = get32(&from);
    state->film.height = get32(&from);
    const uint32_t features = get32(&from);
    c->has_features = features == 1;
    state->spp = get32(&from);
    state->n_paths = get64(&from);
    state->n_rays = get64(&from);
    state->n_shadow_rays = get64(&from);
    state->n_bad = get64(&from);
    state->film.n_clamped = get64(&from);
    state->seconds = get_double(&from);
    state->cpu_seconds = get_double(&from);
    state->mean_luminance = get_double(&from);
    for (int i = 0; i < RENDER_MAX_REPORTED; i++) {
        state->bad[i].x = get32(&from);
        state->bad[i].y = get32(&from);
        state->bad[i].sample = get32(&from);
    }
    return features <= 1;
}

static size_t row_size(size_t width, bool has_features)
{
    return width*(CHECKPOINT_PIXEL + (has_features ? CHECKPOINT_FEATURES : 0));
}

static void put_sum(unsigned char **to, exact_sum sum)
{
    put64(to, sum.low);
    put64(to, sum.high);
}

static exact_sum get_sum(const unsigned char **from)
{
    const uint64_t low = get64(from);
    return (exact_sum){low, get64(from)};
}

static void put_features(unsigned char **to, const film_features *p)
{
    for (int k = 0; k < 3; k++) put64(to, (uint64_t)p->albedo[k]);
    for (int k = 0; k < 3; k++) put64(to, (uint64_t)p->normal[k]);
    put_sum(to, p->distance);
    put32(to, p->n_hits);
}

static void get_features(const unsigned char **from, film_features *p)
{
    for (int k = 0; k < 3; k++) p->albedo[k] = (int64_t)get64(from);
    for (int k = 0; k < 3; k++) p->normal[k] = (int64_t)get64(from);
    p->distance = get_sum(from);
    p->n_hits = get32(from);
}

static void put_row(unsigned char *to, const film *f, size_t y)
{
    for (size_t i = y*f->width; i < (y + 1)*f->width; i++) {
        const film_pixel *p = &f->pixels[i];
        for (int k = 0; k < 3; k++) put_sum(&to, p->rgb[k]);
        put_sum(&to, p->luminance_squares);
        put32(&to, p->n);
        if (f->features) put_features(&to, &f->features[i]);
    }
}

static void get_row(const unsigned char *from, film *f, size_t y)
{
    for (size_t i = y*f->width; i < (y + 1)*f->width; i++) {
        film_pixel *p = &f->pixels[i];
        for (int k = 0; k < 3; k++) p->rgb[k] = get_sum(&from);
        p->luminance_squares = get_sum(&from);
        p->n = get32(&from);
        if (f->features) get_features(&from, &f->features[i]);
    }
}

/* ---- Writing ------------------------------------------------------------------------------------- */

/* The bytes and the checksum of all bytes so far; a failed write is found when the file is committed. */
static void write_part(FILE *stream, const unsigned char *bytes, size_t size, uLong *crc)
{
    unsigned char sum[CHECKPOINT_SUM], *to = sum;
    *crc = crc32(*crc, bytes, (uInt)size);
    put32(&to, (uint32_t)*crc);
    fwrite(bytes, 1, size, stream);
    fwrite(sum, 1, sizeof sum, stream);
}

/* KEY 0 VALUE 0 for each; NULL without memory. */
static unsigned char *join_texts(const image_text *texts, size_t n_texts, size_t *size)
{
    *size = 0;
    for (size_t i = 0; i < n_texts; i++) *size += strlen(texts[i].key) + strlen(texts[i].value) + 2;
    unsigned char *bytes = malloc(*size + 1), *to = bytes;
    for (size_t i = 0; bytes && i < n_texts; i++) {
        to = (unsigned char *)stpcpy((char *)to, texts[i].key) + 1;
        to = (unsigned char *)stpcpy((char *)to, texts[i].value) + 1;
    }
    return bytes;
}

facet_status checkpoint_write(const char *path, const render_state *state, const image_text *texts, size_t n_texts,
                              facet_error *why)
{
    const film *f = &state->film;
    size_t text_size;
    unsigned char head[CHECKPOINT_HEAD];
    unsigned char *text_bytes = join_texts(texts, n_texts, &text_size), *row = malloc(row_size(f->width, f->features));
    uLong crc = crc32(0, NULL, 0);
    file_writer writer;
    facet_status status = FACET_OK;
    if (!text_bytes || !row) status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory to write a checkpoint");
    else if (text_size > TEXT_CAP)
        status = facet_error_set(why, FACET_UNSUPPORTED, "", "a command line of more than %d bytes", TEXT_CAP);
    else status = file_writer_open(&writer, path, why);
    if (status == FACET_OK) {
        put_head(head, state, (uint32_t)text_size);
        write_part(writer.stream, head, sizeof head, &crc);
        write_part(writer.stream, text_bytes, text_size, &crc);
        for (size_t y = 0; y < f->height && !ferror(writer.stream); y++) {
            put_row(row, f, y);
            write_part(writer.stream, row, row_size(f->width, f->features), &crc);
        }
        status = file_writer_commit(&writer, why);
    }
    free(row);
    free(text_bytes);
    return status;
}

/* ---- Reading ------------------------------------------------------------------------------------- */

bool checkpoint_is_one(const char *path)
{
    char magic[sizeof MAGIC + 1] = "";
    memcpy(magic, MAGIC, sizeof MAGIC);
    return file_begins_with(path, magic);
}

/* The bytes of a part whose checksum is right. */
static facet_status read_part(FILE *stream, const char *part, unsigned char *bytes, size_t size, uLong *crc,
                              facet_error *why)
{
    unsigned char sum[CHECKPOINT_SUM];
    const unsigned char *from = sum;
    if (fread(bytes, 1, size, stream) != size || fread(sum, 1, sizeof sum, stream) != sizeof sum)
        return facet_error_set(why, FACET_IO, "", "cannot be read to the end of its %s", part);
    *crc = crc32(*crc, bytes, (uInt)size);
    if (get32(&from) != (uint32_t)*crc)
        return facet_error_set(why, FACET_BAD_FILE, "",
                               "is damaged: the checksum of its %s is wrong; use another copy, or start again", part);
    return FACET_OK;
}

static facet_status read_head(FILE *stream, uint64_t size, checkpoint *c, uint32_t *text_size, uLong *crc,
                              facet_error *why)
{
    unsigned char head[CHECKPOINT_HEAD];
    const unsigned char *version = head + sizeof MAGIC;
    if (size < CHECKPOINT_HEAD || fread(head, 1, sizeof MAGIC + 4, stream) != sizeof MAGIC + 4 ||
        memcmp(head, MAGIC, sizeof MAGIC) != 0)
        return facet_error_set(why, FACET_BAD_FILE, "", "is not a checkpoint of facet");
    const uint32_t number = get32(&version);
    if (number != CHECKPOINT_VERSION)
        return facet_error_set(why, FACET_UNSUPPORTED, "",
                               "is a checkpoint of format %" PRIu32 "; this facet reads format %d", number,
                               CHECKPOINT_VERSION);
    rewind(stream);
    const facet_status status = read_part(stream, "head", head, sizeof head, crc, why);
    if (status) return status;
    if (!get_head(version, c, text_size))
        return facet_error_set(why, FACET_BAD_FILE, "", "is damaged: its head makes no sense; use another copy");
    const film *f = &c->state.film;
    if (f->width < 1 || f->height < 1 || f->width > SIDE_CAP || f->height > SIDE_CAP ||
        f->width > IMAGE_PIXEL_CAP/f->height || *text_size > TEXT_CAP)
        return facet_error_set(why, FACET_UNSUPPORTED, "", "is of a picture of %zux%zu pixels, which is too large",
                               f->width, f->height);
    const uint64_t expected = CHECKPOINT_HEAD + CHECKPOINT_SUM + *text_size + CHECKPOINT_SUM +
                              f->height*(row_size(f->width, c->has_features) + CHECKPOINT_SUM);
    if (size != expected)
        return facet_error_set(why, FACET_BAD_FILE, "",
                               "is damaged: it has %" PRIu64 " bytes in place of %" PRIu64
                               "; use another copy, or start again",
                               size, expected);
    return FACET_OK;
}

static facet_status read_texts(FILE *stream, size_t size, checkpoint *c, uLong *crc, facet_error *why)
{
    c->text_bytes = calloc(size + 2, 1); /* two ends, whatever the bytes are */
    c->texts = calloc(size/2 + 1, sizeof *c->texts);
    if (!c->text_bytes || !c->texts) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for its texts");
    const facet_status status = read_part(stream, "texts", (unsigned char *)c->text_bytes, size, crc, why);
    if (status) return status;
    for (const char *p = c->text_bytes; p < c->text_bytes + size;) {
        const char *value = p + strlen(p) + 1;
        c->texts[c->n_texts++] = (image_text){p, value};
        p = value + strlen(value) + 1;
    }
    return FACET_OK;
}

static facet_status read_film(FILE *stream, checkpoint *c, uLong *crc, facet_error *why)
{
    film *f = &c->state.film;
    const uint64_t n_clamped = f->n_clamped;
    const size_t size = row_size(f->width, c->has_features);
    unsigned char *row = malloc(size);
    facet_status status = film_create(f->width, f->height, f);
    if (!status && c->has_features) status = film_keep_features(f);
    f->n_clamped = n_clamped;
    if (!row || status) status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for its pixels");
    for (size_t y = 0; y < f->height && status == FACET_OK; y++) {
        status = read_part(stream, "pixels", row, size, crc, why);
        if (status == FACET_OK) get_row(row, f, y);
    }
    free(row);
    return status;
}

facet_status checkpoint_read(const char *path, bool wants_film, checkpoint *c, facet_error *why)
{
    FILE *stream;
    uint64_t size;
    uint32_t text_size = 0;
    uLong crc = crc32(0, NULL, 0);
    facet_status status = file_open(path, &stream, &size, why);
    if (status) return status;
    checkpoint made = {0};
    status = read_head(stream, size, &made, &text_size, &crc, why);
    if (status == FACET_OK) status = read_texts(stream, text_size, &made, &crc, why);
    if (status == FACET_OK && wants_film) status = read_film(stream, &made, &crc, why);
    fclose(stream);
    if (status) checkpoint_destroy(&made);
    else *c = made;
    return status;
}

void checkpoint_destroy(checkpoint *c)
{
    render_state_destroy(&c->state);
    free(c->texts);
    free(c->text_bytes);
    *c = (checkpoint){0};
}

const char *checkpoint_text(const checkpoint *c, const char *key)
{
    for (size_t i = 0; i < c->n_texts; i++)
        if (strcmp(c->texts[i].key, key) == 0) return c->texts[i].value;
    return NULL;
}
