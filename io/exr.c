/* exr.c: OpenEXR read and written, through OpenEXRCore 3.1.
 *
 * Read: the first part, scan lines or tiles (full resolution of mipmaps), half, float and uint channels
 * called R G B [A] or Y [A], to float; the data window alone makes the picture.  Refused by name: deep
 * data, DWAA and DWAB (OpenEXRCore 3.1 cannot decode them), subsampled channels, layers without plain
 * channels.  Everything that a size is taken from is checked against the file's length first, because
 * the library trusts some of it.  The library only decompresses; the samples are converted here.
 *
 * Written: scan lines, ZIP, half or float, Rec.709 primaries.
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <OpenEXR/openexr.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"

/* What zlib's best ratio, 1032, and PXR24's 4 bytes in 3 can make of one byte; the other codings do less. */
#define MAX_RATIO 1400

/* Larger blocks overflow the library's int arithmetic [byte]. */
#define MAX_CHUNK ((uint64_t)1 << 30)

/* Longest attribute name without the long-names flag, that older readers refuse. */
#define SHORT_NAME 31
#define LONG_NAME 255

#define PRIMARIES                                                                                                      \
    {                                                                                                                  \
        0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f                                                     \
    }

/* In the second byte of the version field: some part holds deep pixels. */
#define DEEP_FLAG 0x08

/* The stream that the library reads or writes, and the first thing that it complained about. */
typedef struct stream {
    const unsigned char *bytes; /* reading */
    uint64_t size;
    FILE *file; /* writing */
    uint64_t at;
    bool is_io_error;
    char message[144];
} stream;

/* ---- What the library calls -------------------------------------------------------------------- */

/* Keeps the first message of a call: the ones after it only say that something failed. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *text)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) {
        return;
    }
    stream *s = user;
    if (s->message[0] == 0 && text) {
        size_t i = 0;
        for (; text[i] && i + 1 < sizeof s->message; i++) { /* it may quote the file */
            s->message[i] = (char)(text[i] >= ' ' && text[i] <= '~' ? text[i] : '?');
        }
        s->message[i] = 0;
    }
}

static int64_t read_bytes(exr_const_context_t context, void *user, void *to, uint64_t n, uint64_t offset,
                          exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    const stream *s = user;
    if (offset >= s->size) {
        return 0;
    }
    const uint64_t count = n < s->size - offset ? n : s->size - offset;
    memcpy(to, s->bytes + offset, (size_t)count);
    return (int64_t)count;
}

static int64_t tell_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const stream *)user)->size;
}

static int64_t write_bytes(exr_const_context_t context, void *user, const void *from, uint64_t n, uint64_t offset,
                           exr_stream_error_func_ptr_t complain)
{
    (void)context;
    (void)complain;
    stream *s = user;
    const bool is_there = s->at == offset || fseeko(s->file, (off_t)offset, SEEK_SET) == 0;
    if (!is_there || fwrite(from, 1, (size_t)n, s->file) != n) {
        s->is_io_error = true;
        return -1;
    }
    s->at = offset + n;
    return (int64_t)n;
}

/* The decoders leave parts of their buffers unwritten where the data is damaged. */
static void *allocate_zeroed(exr_transcoding_pipeline_buffer_id_t id, size_t n)
{
    (void)id;
    return calloc(1, n);
}

static void free_buffer(exr_transcoding_pipeline_buffer_id_t id, void *memory)
{
    (void)id;
    free(memory);
}

static exr_context_initializer_t initializer(stream *s)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.user_data = s;
    init.error_handler_fn = on_error;
    return init;
}

static facet_status library_error(facet_error *why, const stream *s, exr_result_t code, const char *place)
{
    const char *text = s->message[0]             ? s->message
                       : code == EXR_ERR_SUCCESS ? "its header contradicts itself"
                                                 : exr_get_default_error_message(code);
    return facet_error_set(why, code == EXR_ERR_OUT_OF_MEMORY ? FACET_NO_MEMORY : FACET_BAD_FILE, place,
                           "damaged OpenEXR file: %s", text);
}

/* ---- Half -------------------------------------------------------------------------------------- */

static float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float float_of_half(uint32_t half)
{
    const uint32_t sign = (half & 0x8000u) << 16, exponent = half >> 10 & 31, mantissa = half & 0x3ffu;
    if (exponent == 31) { /* infinity, NaN */
        return float_of_bits(sign | 0x7f800000u | mantissa << 13);
    }
    if (exponent == 0) { /* zero, subnormal: a multiple of 2^-24 */
        const float value = (float)mantissa*0x1p-24f;
        return sign ? -value : value;
    }
    return float_of_bits(sign | (exponent + 112) << 23 | mantissa << 13);
}

/* To nearest, ties to even; beyond 65504 infinity, as IEEE 754 rounds.  NaN keeps its upper bits. */
static uint32_t half_of_float(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) {
        return sign | 0x7e00u | (magnitude >> 13 & 0x3ffu);
    }
    if (magnitude >= 0x477ff000u) { /* 65520: halfway from the largest half to the next */
        return sign | 0x7c00u;
    }
    if (magnitude < 0x38800000u) { /* 2^-14: subnormal halves; adding 1/2 aligns them and rounds */
        const float aligned = float_of_bits(magnitude) + 0.5f;
        uint32_t out;
        memcpy(&out, &aligned, sizeof out);
        return sign | (out - 0x3f000000u);
    }
    const uint32_t rounded = magnitude + 0xfffu + (magnitude >> 13 & 1);
    return sign | ((rounded - 0x38000000u) >> 13);
}

/* ---- Reading: what is in the file -------------------------------------------------------------- */

/* A file being read.  channel c of the picture is the library's number source[c]. */
typedef struct reader {
    stream stream;
    exr_context_t context;
    exr_attr_box2i_t window;
    exr_storage_t storage;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    size_t bytes_per_pixel; /* of all channels in the file */
    size_t source[4];
    size_t most; /* byte */
    image picture;
} reader;

static size_t sample_size(const exr_attr_chlist_entry_t *channel)
{
    return channel->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

/* The number of the channel called `name`, or SIZE_MAX. */
static size_t find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        if (strcmp(list->entries[i].name.str, name) == 0) {
            return (size_t)i;
        }
    }
    return SIZE_MAX;
}

/* "R" where "layer.R" is there, or NULL: only to say what is missing. */
static const char *find_layer(const exr_attr_chlist_t *list)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str, *dot = strrchr(name, '.');
        if (dot && (strcmp(dot, ".R") == 0 || strcmp(dot, ".Y") == 0)) {
            return name;
        }
    }
    return NULL;
}

static facet_status choose_channels(reader *r, facet_error *why)
{
    static const char *const CHOICES[2][3] = {{"R", "G", "B"}, {"Y", NULL, NULL}};
    const exr_attr_chlist_t *list = r->channels;
    for (size_t k = 0; k < 2; k++) {
        if (find_channel(list, CHOICES[k][0]) == SIZE_MAX) {
            continue;
        }
        size_t n = 0;
        for (; n < 3 && CHOICES[k][n]; n++) {
            r->source[n] = find_channel(list, CHOICES[k][n]);
            if (r->source[n] == SIZE_MAX) {
                return facet_error_set(why, FACET_UNSUPPORTED, "channels", "has R, but no channel %s", CHOICES[k][n]);
            }
        }
        const size_t alpha = find_channel(list, "A");
        if (alpha != SIZE_MAX) {
            r->source[n++] = alpha;
        }
        r->picture.n_channels = n;
        return FACET_OK;
    }
    const char *layer = find_layer(list);
    if (layer) {
        return facet_error_set(why, FACET_UNSUPPORTED, "channels",
                               "has only layers, such as %.40s; rename one layer's channels to R, G, B", layer);
    }
    return facet_error_set(why, FACET_UNSUPPORTED, "channels",
                           "has no channels R, G, B or Y; the first of its %d is %.40s", list->num_channels,
                           list->entries[0].name.str);
}

static facet_status check_channels(reader *r, facet_error *why)
{
    const exr_attr_chlist_t *list = r->channels;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *c = &list->entries[i];
        if ((unsigned)c->pixel_type >= EXR_PIXEL_LAST_TYPE) {
            return facet_error_set(why, FACET_BAD_FILE, "channels", "channel %.40s has the unknown type %d",
                                   c->name.str, (int)c->pixel_type);
        }
        if (c->x_sampling != 1 || c->y_sampling != 1) {
            return facet_error_set(why, FACET_UNSUPPORTED, "channels",
                                   "channel %.40s is subsampled (luminance/chroma); convert the file to RGB",
                                   c->name.str);
        }
        r->bytes_per_pixel += sample_size(c);
    }
    return choose_channels(r, why);
}

static facet_status check_window(reader *r, facet_error *why)
{
    const int64_t width = (int64_t)r->window.max.x - r->window.min.x + 1;
    const int64_t height = (int64_t)r->window.max.y - r->window.min.y + 1;
    if (width < 1 || height < 1 || width > INT_MAX || height > INT_MAX) {
        return facet_error_set(why, FACET_BAD_FILE, "dataWindow", "is empty or too large: %d,%d to %d,%d",
                               r->window.min.x, r->window.min.y, r->window.max.x, r->window.max.y);
    }
    r->picture.width = (size_t)width;
    r->picture.height = (size_t)height;
    if (r->picture.width > IMAGE_PIXEL_CAP/r->picture.height) {
        return facet_error_set(why, FACET_UNSUPPORTED, "dataWindow", "has more than %zu pixels", IMAGE_PIXEL_CAP);
    }
    /* At most 2^28 pixels of at most 2^31/18 channels, the shortest entry in a file of 2 GiB: below 2^58. */
    if ((uint64_t)r->picture.width*r->picture.height*r->bytes_per_pixel/MAX_RATIO > r->stream.size) {
        return facet_error_set(why, FACET_BAD_FILE, "dataWindow",
                               "the file is truncated: it is too short for its %zu x %zu pixels", r->picture.width,
                               r->picture.height);
    }
    return FACET_OK;
}

static facet_status refuse_deep(facet_error *why)
{
    return facet_error_set(why, FACET_UNSUPPORTED, "",
                           "deep pixels are not read; flatten the file first, such as "
                           "with: oiiotool IN --flatten -o OUT");
}

static facet_status check_coding(const reader *r, facet_error *why)
{
    if (r->storage == EXR_STORAGE_DEEP_SCANLINE || r->storage == EXR_STORAGE_DEEP_TILED) {
        return refuse_deep(why);
    }
    if (r->storage != EXR_STORAGE_SCANLINE && r->storage != EXR_STORAGE_TILED) {
        return facet_error_set(why, FACET_BAD_FILE, "type", "is neither scan lines nor tiles");
    }
    if (r->compression == EXR_COMPRESSION_DWAA || r->compression == EXR_COMPRESSION_DWAB) {
        return facet_error_set(why, FACET_UNSUPPORTED, "compression",
                               "%s is not read; convert it with: oiiotool IN --compression zip -o OUT",
                               r->compression == EXR_COMPRESSION_DWAA ? "DWAA" : "DWAB");
    }
    if ((unsigned)r->compression > EXR_COMPRESSION_B44A) {
        return facet_error_set(why, FACET_BAD_FILE, "compression", "has the unknown number %d", (int)r->compression);
    }
    return FACET_OK;
}

static facet_status read_header(reader *r, facet_error *why)
{
    exr_context_initializer_t init = initializer(&r->stream);
    init.read_fn = read_bytes;
    init.size_fn = tell_size;
    /* Without the first flag, damaged and missing attributes become invented defaults. */
    init.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t code = exr_start_read(&r->context, "memory", &init);
    if (code == EXR_ERR_SUCCESS) {
        code = exr_get_storage(r->context, 0, &r->storage);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_get_compression(r->context, 0, &r->compression);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_get_channels(r->context, 0, &r->channels);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_get_data_window(r->context, 0, &r->window);
    }
    if (code != EXR_ERR_SUCCESS || !r->channels || r->channels->num_channels < 1) {
        return library_error(why, &r->stream, code != EXR_ERR_SUCCESS ? code : EXR_ERR_FILE_BAD_HEADER, "header");
    }
    facet_status status = check_coding(r, why);
    if (status == FACET_OK) {
        status = check_channels(r, why);
    }
    return status == FACET_OK ? check_window(r, why) : status;
}

/* ---- Reading: the pixels ----------------------------------------------------------------------- */

static float sample_at(const unsigned char *p, exr_pixel_type_t type)
{
    if (type == EXR_PIXEL_HALF) {
        return float_of_half((uint32_t)p[0] | (uint32_t)p[1] << 8);
    }
    const uint32_t bits = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    return type == EXR_PIXEL_UINT ? (float)bits : float_of_bits(bits);
}

/* Copies a decompressed block, [row][channel of the file][column], to x, y of the picture. */
static void store_block(const reader *r, const unsigned char *block, size_t x, size_t y, size_t width, size_t height)
{
    const size_t n = r->picture.n_channels;
    for (size_t c = 0; c < n; c++) {
        size_t offset = 0; /* of this channel in a row of the block */
        for (size_t k = 0; k < r->source[c]; k++) {
            offset += sample_size(&r->channels->entries[k])*width;
        }
        const exr_attr_chlist_entry_t *channel = &r->channels->entries[r->source[c]];
        const size_t size = sample_size(channel);
        for (size_t j = 0; j < height; j++) {
            const unsigned char *from = block + j*width*r->bytes_per_pixel + offset;
            float *to = (float *)r->picture.pixels + ((y + j)*r->picture.width + x)*n + c;
            for (size_t i = 0; i < width; i++) {
                to[i*n] = sample_at(from + i*size, channel->pixel_type);
            }
        }
    }
}

/* Decompresses one chunk and stores it with its corner at x, y of the picture. */
static facet_status read_chunk(reader *r, exr_decode_pipeline_t *decode, const exr_chunk_info_t *chunk, size_t x,
                               size_t y, const char *place, facet_error *why)
{
    const size_t width = (size_t)chunk->width, height = (size_t)chunk->height;
    if (chunk->width < 1 || chunk->height < 1 || width > r->picture.width - x || height > r->picture.height - y ||
        chunk->unpacked_size != (uint64_t)width*height*r->bytes_per_pixel ||
        (r->compression == EXR_COMPRESSION_NONE && chunk->packed_size != chunk->unpacked_size)) {
        return facet_error_set(why, FACET_BAD_FILE, place, "a block has another size than the header says");
    }
    if (chunk->unpacked_size > MAX_CHUNK) {
        return facet_error_set(why, FACET_UNSUPPORTED, place, "a block has more than %llu bytes",
                               (unsigned long long)MAX_CHUNK);
    }
    exr_result_t code = decode->context ? exr_decoding_update(r->context, 0, chunk, decode)
                                        : exr_decoding_initialize(r->context, 0, chunk, decode);
    if (code == EXR_ERR_SUCCESS && !decode->read_fn) {
        decode->alloc_fn = allocate_zeroed;
        decode->free_fn = free_buffer;
        code = exr_decoding_choose_default_routines(r->context, 0, decode);
        decode->unpack_and_convert_fn = NULL;
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_decoding_run(r->context, 0, decode);
    }
    if (code != EXR_ERR_SUCCESS || !decode->unpacked_buffer) {
        return library_error(why, &r->stream, code, place);
    }
    store_block(r, decode->unpacked_buffer, x, y, width, height);
    return FACET_OK;
}

static facet_status read_lines(reader *r, exr_decode_pipeline_t *decode, facet_error *why)
{
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(r->context, 0, &lines);
    if (code != EXR_ERR_SUCCESS || lines < 1) {
        return library_error(why, &r->stream, code, "header");
    }
    facet_status status = FACET_OK;
    for (size_t y = 0; y < r->picture.height && status == FACET_OK; y += (size_t)lines) {
        char place[48];
        snprintf(place, sizeof place, "scan line %zu", y);
        exr_chunk_info_t chunk = {0};
        r->stream.message[0] = 0;
        code = exr_read_scanline_chunk_info(r->context, 0, (int)(r->window.min.y + (int64_t)y), &chunk);
        status = code == EXR_ERR_SUCCESS ? read_chunk(r, decode, &chunk, 0, y, place, why)
                                         : library_error(why, &r->stream, code, place);
    }
    return status;
}

static facet_status read_tiles(reader *r, exr_decode_pipeline_t *decode, facet_error *why)
{
    uint32_t tile_width = 0, tile_height = 0;
    exr_result_t code = exr_get_tile_descriptor(r->context, 0, &tile_width, &tile_height, NULL, NULL);
    if (code != EXR_ERR_SUCCESS || tile_width < 1 || tile_height < 1) {
        return library_error(why, &r->stream, code, "tiles");
    }
    const size_t n_x = (r->picture.width + tile_width - 1)/tile_width;
    const size_t n_y = (r->picture.height + tile_height - 1)/tile_height;
    facet_status status = FACET_OK;
    for (size_t i = 0; i < n_x*n_y && status == FACET_OK; i++) {
        const size_t x = i%n_x, y = i/n_x;
        char place[64];
        snprintf(place, sizeof place, "tile %zu,%zu", x, y);
        exr_chunk_info_t chunk = {0};
        r->stream.message[0] = 0;
        code = exr_read_tile_chunk_info(r->context, 0, (int)x, (int)y, 0, 0, &chunk);
        status = code == EXR_ERR_SUCCESS ? read_chunk(r, decode, &chunk, x*tile_width, y*tile_height, place, why)
                                         : library_error(why, &r->stream, code, place);
    }
    return status;
}

static facet_status read_pixels(reader *r, facet_error *why)
{
    image *p = &r->picture;
    p->type = PIXEL_F32;
    const facet_status refused = image_check_size(p, 1, r->most, why);
    if (refused != FACET_OK) {
        return refused;
    }
    /* The library unpacks a chunk with all its channels at once, and a tile may be the whole picture. */
    if ((uint64_t)p->width*p->height*r->bytes_per_pixel > r->most) {
        return facet_error_set(why, FACET_UNSUPPORTED, "channels",
                               "all %d of its channels take more than %zu MiB; --max-memory SIZE sets another limit",
                               r->channels->num_channels, r->most >> 20);
    }
    p->pixels = calloc(p->width*p->height, p->n_channels*sizeof(float));
    if (!p->pixels) {
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for %zu x %zu pixels", p->width, p->height);
    }
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    const facet_status status = r->storage == EXR_STORAGE_TILED ? read_tiles(r, &decode, why)
                                                                : read_lines(r, &decode, why);
    if (decode.context) {
        exr_decoding_destroy(r->context, &decode);
    }
    return status;
}

/* To be closed whatever the status is. */
static facet_status open_reader(reader *r, const unsigned char *bytes, size_t size, size_t most, facet_error *why)
{
    *r = (reader){.stream = {.bytes = bytes, .size = size}, .most = most};
    if (size < 8 || memcmp(bytes, "\x76\x2f\x31\x01", 4) != 0) {
        return facet_error_set(why, FACET_BAD_FILE, "byte 0", "is not an OpenEXR file");
    }
    return bytes[5] & DEEP_FLAG ? refuse_deep(why) : read_header(r, why);
}

static void close_reader(reader *r)
{
    if (r->context) {
        exr_finish(&r->context);
    }
}

facet_status exr_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why)
{
    reader r;
    facet_status status = open_reader(&r, bytes, size, most, why);
    if (status == FACET_OK) {
        status = read_pixels(&r, why);
    }
    close_reader(&r);
    if (status != FACET_OK) {
        image_destroy(&r.picture);
        return status;
    }
    *picture = r.picture;
    return FACET_OK;
}

static facet_status note_channels(const exr_attr_chlist_t *list, image_notes *notes)
{
    static const char *const types[] = {"uint", "half", "float"};
    facet_status status = FACET_OK;
    for (int i = 0; i < list->num_channels && !status; i++) {
        const char *type = types[list->entries[i].pixel_type];
        status = image_notes_add(notes, true, list->entries[i].name.str, type, strlen(type));
    }
    return status;
}

static facet_status note_texts(const reader *r, image_notes *notes)
{
    int32_t n = 0;
    facet_status status = FACET_OK;
    exr_get_attribute_count(r->context, 0, &n);
    for (int32_t i = 0; i < n && !status; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(r->context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a) != EXR_ERR_SUCCESS) break;
        if (a->type == EXR_ATTR_STRING && strncmp(a->name, IMAGE_TEXT_PREFIX, strlen(IMAGE_TEXT_PREFIX)) == 0)
            status = image_notes_add(notes, false, a->name, a->string->str, (size_t)a->string->length);
    }
    return status;
}

facet_status exr_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why)
{
    reader r;
    facet_status status = open_reader(&r, bytes, size, SIZE_MAX, why);
    if (status == FACET_OK && (status = note_channels(r.channels, notes)) == FACET_OK) status = note_texts(&r, notes);
    if (status == FACET_NO_MEMORY) facet_error_set(why, status, "", "no memory for its texts");
    close_reader(&r);
    return status;
}

/* ---- Writing ----------------------------------------------------------------------------------- */

/* What is written: channels of pictures that have the same size. */
typedef struct channel {
    const char *name;
    const float *first; /* its value in the first pixel */
    size_t stride;      /* [float] to the next pixel */
    exr_precision precision;
} channel;

typedef struct channel_list {
    channel items[4*EXR_MOST_LAYERS];
    size_t n;
    size_t width, height;
} channel_list;

static size_t bytes_of(exr_precision precision)
{
    return precision == EXR_HALF ? 2 : 4;
}

static exr_pixel_type_t type_of(exr_precision precision)
{
    return precision == EXR_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
}

static channel_list list_channels(const exr_layer *layers, size_t n_layers)
{
    channel_list list = {.width = layers[0].picture->width, .height = layers[0].picture->height};
    for (size_t i = 0; i < n_layers; i++) {
        const image *p = layers[i].picture;
        for (size_t c = 0; c < p->n_channels; c++)
            list.items[list.n++] = (channel){layers[i].channels[c], (const float *)p->pixels + c, p->n_channels,
                                             layers[i].precision};
    }
    return list;
}

static exr_result_t set_attributes(exr_context_t context, const image_text *text, size_t n_texts,
                                   const float *world_to_camera, const float *world_to_ndc)
{
    const exr_attr_chromaticities_t primaries = PRIMARIES;
    exr_result_t code = exr_attr_set_chromaticities(context, 0, "chromaticities", &primaries);
    const float *const matrices[2] = {world_to_camera, world_to_ndc};
    static const char *const NAMES[2] = {"worldToCamera", "worldToNDC"};
    for (size_t i = 0; i < 2 && code == EXR_ERR_SUCCESS; i++) {
        if (matrices[i]) {
            exr_attr_m44f_t m;
            memcpy(m.m, matrices[i], sizeof m.m);
            code = exr_attr_set_m44f(context, 0, NAMES[i], &m);
        }
    }
    for (size_t i = 0; i < n_texts && code == EXR_ERR_SUCCESS; i++) {
        code = exr_attr_set_string(context, 0, text[i].key, text[i].value);
    }
    return code;
}

static exr_result_t write_header(exr_context_t context, const channel_list *list, const image_text *text,
                                 size_t n_texts, const float *world_to_camera, const float *world_to_ndc)
{
    int part = 0;
    bool has_long_name = false;
    for (size_t i = 0; i < n_texts; i++) {
        has_long_name = has_long_name || strlen(text[i].key) > SHORT_NAME;
    }
    exr_result_t code = has_long_name ? exr_set_longname_support(context, 1) : EXR_ERR_SUCCESS;
    if (code == EXR_ERR_SUCCESS) {
        code = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = exr_initialize_required_attr_simple(context, part, (int32_t)list->width, (int32_t)list->height,
                                                   EXR_COMPRESSION_ZIP);
    }
    for (size_t c = 0; c < list->n && code == EXR_ERR_SUCCESS; c++) {
        code = exr_add_channel(context, part, list->items[c].name, type_of(list->items[c].precision),
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = set_attributes(context, text, n_texts, world_to_camera, world_to_ndc);
    }
    return code == EXR_ERR_SUCCESS ? exr_write_header(context) : code;
}

/* A channel's rows from y on, as half or float in host order. */
static void gather_rows(const channel *c, size_t width, size_t y, size_t n_rows, unsigned char *to)
{
    const size_t size = bytes_of(c->precision);
    const float *from = c->first + y*width*c->stride;
    for (size_t i = 0; i < n_rows*width; i++, from += c->stride) {
        const uint16_t half = (uint16_t)half_of_float(*from);
        memcpy(to + i*size, c->precision == EXR_HALF ? (const void *)&half : (const void *)from, size);
    }
}

/* Lays out rows of all channels in the block, and tells the library where they lie. */
static void gather_block(exr_encode_pipeline_t *encode, const channel_list *list, size_t y, size_t n_rows,
                         unsigned char *block)
{
    for (size_t c = 0; c < list->n; c++) {
        const channel *from = &list->items[c];
        const size_t size = bytes_of(from->precision);
        gather_rows(from, list->width, y, n_rows, block);
        for (int k = 0; k < encode->channel_count; k++) { /* the library keeps them sorted by name */
            exr_coding_channel_info_t *info = &encode->channels[k];
            if (strcmp(info->channel_name, from->name) != 0) continue;
            info->encode_from_ptr = block;
            info->user_pixel_stride = (int32_t)size;
            info->user_line_stride = (int32_t)(list->width*size);
            info->user_bytes_per_element = (int16_t)size;
            info->user_data_type = type_of(from->precision);
        }
        block += n_rows*list->width*size;
    }
}

static size_t row_size(const channel_list *list)
{
    size_t size = 0;
    for (size_t c = 0; c < list->n; c++) size += list->width*bytes_of(list->items[c].precision);
    return size;
}

static exr_result_t write_pixels(exr_context_t context, const channel_list *list)
{
    int32_t lines = 0;
    exr_result_t code = exr_get_scanlines_per_chunk(context, 0, &lines);
    if (code != EXR_ERR_SUCCESS) {
        return code;
    }
    const size_t step = (size_t)lines;
    unsigned char *block = malloc(step*row_size(list));
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    code = block ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
    for (size_t y = 0; y < list->height && code == EXR_ERR_SUCCESS; y += step) {
        const size_t n_rows = list->height - y < step ? list->height - y : step;
        exr_chunk_info_t chunk = {0};
        code = exr_write_scanline_chunk_info(context, 0, (int)y, &chunk);
        const bool is_first = !encode.context;
        if (code == EXR_ERR_SUCCESS) {
            code = is_first ? exr_encoding_initialize(context, 0, &chunk, &encode)
                            : exr_encoding_update(context, 0, &chunk, &encode);
        }
        if (code == EXR_ERR_SUCCESS) {
            gather_block(&encode, list, y, n_rows, block);
            code = is_first ? exr_encoding_choose_default_routines(context, 0, &encode) : code;
        }
        if (code == EXR_ERR_SUCCESS) {
            code = exr_encoding_run(context, 0, &encode);
        }
    }
    if (encode.context) {
        exr_encoding_destroy(context, &encode);
    }
    free(block);
    return code;
}

static facet_status check_layers(const exr_layer *layers, size_t n_layers, facet_error *why)
{
    bool is_good = n_layers >= 1 && n_layers <= EXR_MOST_LAYERS;
    for (size_t i = 0; i < n_layers && is_good; i++) {
        const image *p = layers[i].picture;
        is_good = p && p->pixels && p->type == PIXEL_F32 && p->n_channels >= 1 && p->n_channels <= 4 && p->width >= 1 &&
                  p->height >= 1 && p->width <= IMAGE_PIXEL_CAP/p->height && p->width == layers[0].picture->width &&
                  p->height == layers[0].picture->height;
    }
    if (is_good) return FACET_OK;
    return facet_error_set(why, FACET_BAD_ARGUMENT, "",
                           "OpenEXR is written from 1 to %d pictures of 1 to 4 channels of floats, up to 2^28 pixels",
                           EXR_MOST_LAYERS);
}

/* The library would wait for a lock of its own that it holds while it complains. */
static facet_status check_names(const channel_list *list, facet_error *why)
{
    for (size_t i = 0; i < list->n; i++)
        for (size_t k = 0; k < i; k++)
            if (strcmp(list->items[i].name, list->items[k].name) == 0)
                return facet_error_set(why, FACET_BAD_ARGUMENT, list->items[i].name,
                                       "there are two channels of this name");
    return FACET_OK;
}

static facet_status check_texts(const image_text *text, size_t n_texts, facet_error *why)
{
    if (n_texts > 0 && !text) return facet_error_set(why, FACET_BAD_ARGUMENT, "", "there are no texts");
    for (size_t i = 0; i < n_texts; i++) {
        const size_t n = text[i].key ? strlen(text[i].key) : 0;
        if (n < 1 || n > LONG_NAME || !text[i].value || strlen(text[i].value) > INT_MAX/2) {
            return facet_error_set(why, FACET_BAD_ARGUMENT, text[i].key,
                                   "an OpenEXR attribute has a name of 1 to %d characters and a value", LONG_NAME);
        }
    }
    return FACET_OK;
}

facet_status exr_write(const char *path, const image *picture, exr_precision precision, const image_text *text,
                       size_t n_texts, const float *world_to_camera, const float *world_to_ndc, facet_error *why)
{
    static const char *const NAMES[5][4] = {{NULL}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    exr_layer layer = {.picture = picture, .precision = precision};
    if (picture && picture->n_channels <= 4) memcpy(layer.channels, NAMES[picture->n_channels], sizeof layer.channels);
    return exr_write_layers(path, &layer, 1, text, n_texts, world_to_camera, world_to_ndc, why);
}

facet_status exr_write_layers(const char *path, const exr_layer *layers, size_t n_layers, const image_text *text,
                              size_t n_texts, const float *world_to_camera, const float *world_to_ndc, facet_error *why)
{
    facet_status status = check_layers(layers, n_layers, why);
    if (status == FACET_OK) status = check_texts(text, n_texts, why);
    if (status != FACET_OK) return status;
    const channel_list list = list_channels(layers, n_layers);
    status = check_names(&list, why);
    if (status != FACET_OK) return status;
    file_writer writer;
    status = file_writer_open(&writer, path, why);
    if (status != FACET_OK) {
        return status;
    }
    stream s = {.file = writer.stream};
    exr_context_initializer_t init = initializer(&s);
    init.write_fn = write_bytes;
    exr_context_t context = NULL;
    exr_result_t code = exr_start_write(&context, "stream", EXR_WRITE_FILE_DIRECTLY, &init);
    if (code == EXR_ERR_SUCCESS) {
        code = write_header(context, &list, text, n_texts, world_to_camera, world_to_ndc);
    }
    if (code == EXR_ERR_SUCCESS) {
        code = write_pixels(context, &list);
    }
    if (context) {
        const exr_result_t last = exr_finish(&context);
        code = code == EXR_ERR_SUCCESS ? last : code;
    }
    if (code != EXR_ERR_SUCCESS && !s.is_io_error) {
        file_writer_discard(&writer);
        return facet_error_set(why, code == EXR_ERR_OUT_OF_MEMORY ? FACET_NO_MEMORY : FACET_BAD_ARGUMENT, "",
                               "OpenEXR: %s", s.message[0] ? s.message : exr_get_default_error_message(code));
    }
    if (s.is_io_error && !ferror(writer.stream)) {
        file_writer_discard(&writer);
        return facet_error_set(why, FACET_IO, "", "cannot seek: OpenEXR is not written to pipes");
    }
    return file_writer_commit(&writer, why); /* a failed write is found here, with its cause */
}
