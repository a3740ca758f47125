/* image_file.c: tells pictures apart by their first bytes and calls the decoder (image_file.h).
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"

typedef facet_status decoder(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);
typedef facet_status note_decoder(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why);

/* A kind of file: `length` bytes of `magic` at `offset`.  Without a decoder it is refused by name. */
typedef struct kind {
    const char *name;
    size_t offset, length;
    const char *magic;
    decoder *decode;
    note_decoder *decode_notes; /* or NULL */
} kind;

/* Magics that hold no printable text come first; short ones that could begin other files come last. */
static const kind KINDS[] = {
    {"PNG", 0, 4, "\x89PNG", png_decode, png_decode_notes},
    {"JPEG", 0, 3, "\xff\xd8\xff", jpeg_decode, NULL},
    {"OpenEXR", 0, 4, "\x76\x2f\x31\x01", exr_decode, exr_decode_notes},
    {"Radiance HDR", 0, 2, "#?", hdr_decode, NULL},
    {"WebP", 8, 4, "WEBP", NULL, NULL},
    {"KTX2", 0, 7, "\xabKTX 20", NULL, NULL},
    {"KTX", 0, 4, "\xabKTX", NULL, NULL},
    {"AVIF", 4, 8, "ftypavif", NULL, NULL},
    {"AVIF", 4, 8, "ftypavis", NULL, NULL},
    {"HEIF", 4, 4, "ftyp", NULL, NULL},
    {"GIF", 0, 4, "GIF8", NULL, NULL},
    {"TIFF", 0, 4, "II*\0", NULL, NULL},
    {"TIFF", 0, 4, "MM\0*", NULL, NULL},
    {"JPEG XL", 0, 12, "\0\0\0\x0cJXL \r\n\x87\n", NULL, NULL},
    {"JPEG XL", 0, 2, "\xff\x0a", NULL, NULL},
    {"JPEG 2000", 0, 12, "\0\0\0\x0cjP  \r\n\x87\n", NULL, NULL},
    {"DDS", 0, 4, "DDS ", NULL, NULL},
    {"Photoshop", 0, 4, "8BPS", NULL, NULL},
    {"QOI", 0, 4, "qoif", NULL, NULL},
    {"PFM", 0, 3, "PF\n", NULL, NULL},
    {"PFM", 0, 3, "Pf\n", NULL, NULL},
    {"PPM", 0, 2, "P6", NULL, NULL},
    {"PGM", 0, 2, "P5", NULL, NULL},
    {"Basis Universal", 0, 2, "sB", NULL, NULL},
    {"BMP", 0, 2, "BM", NULL, NULL},
};

static bool is_kind(const kind *k, const unsigned char *bytes, size_t size)
{
    return size >= k->offset + k->length && memcmp(bytes + k->offset, k->magic, k->length) == 0;
}

size_t image_byte_count(const image *picture)
{
    const size_t channel = picture->type == PIXEL_U8 ? 1 : picture->type == PIXEL_U16 ? 2 : 4;
    return picture->width*picture->height*picture->n_channels*channel;
}

facet_status image_check_size(const image *picture, size_t copies, size_t most, facet_error *why)
{
    if (picture->width > IMAGE_PIXEL_CAP/picture->height)
        return facet_error_set(why, FACET_UNSUPPORTED, "", "has %zu x %zu pixels; at most 2^28 are read",
                               picture->width, picture->height);
    const size_t size = copies*image_byte_count(picture);
    if (size > most)
        return facet_error_set(
            why, FACET_UNSUPPORTED, "",
            "its %zu x %zu pixels take %zu bytes, and %zu are allowed; --max-memory SIZE sets another "
            "limit",
            picture->width, picture->height, size, most);
    return FACET_OK;
}

facet_status image_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why)
{
    return image_decode_within(bytes, size, FILE_MEMORY_DEFAULT, picture, why);
}

facet_status image_decode_within(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why)
{
    if (!picture || (!bytes && size > 0)) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "image_decode needs bytes and a result");
    }
    if (size == 0) {
        return facet_error_set(why, FACET_BAD_FILE, "", "is empty; a picture was expected");
    }
    for (size_t i = 0; i < sizeof KINDS/sizeof KINDS[0]; i++) {
        if (is_kind(&KINDS[i], bytes, size)) {
            return KINDS[i].decode ? KINDS[i].decode(bytes, size, most, picture, why)
                                   : facet_error_set(why, FACET_UNSUPPORTED, "",
                                                     "%s pictures are not read; convert it to PNG, JPEG, Radiance "
                                                     "HDR or OpenEXR",
                                                     KINDS[i].name);
        }
    }
    return facet_error_set(why, FACET_BAD_FILE, "byte 0",
                           "is not a picture; PNG, JPEG, Radiance HDR and OpenEXR are read");
}

bool image_is_known(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < sizeof KINDS/sizeof KINDS[0]; i++)
        if (is_kind(&KINDS[i], bytes, size)) return true;
    return false;
}

facet_status image_read(const char *path, image *picture, facet_error *why)
{
    return image_read_within(path, FILE_MEMORY_DEFAULT, picture, why);
}

facet_status image_read_within(const char *path, size_t most, image *picture, facet_error *why)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_status status = file_read(path, &bytes, &size, why);
    if (status == FACET_OK) {
        status = image_decode_within(bytes, size, most, picture, why);
        free(bytes);
    }
    return status;
}

facet_status image_notes_add(image_notes *notes, bool is_channel, const char *key, const char *value, size_t length)
{
    if (notes->n == IMAGE_MOST_NOTES) return FACET_OK;
    if (!notes->items && !(notes->items = malloc(IMAGE_MOST_NOTES*sizeof *notes->items))) return FACET_NO_MEMORY;
    const image_note made = {is_channel, strdup(key), strndup(value, length)};
    if (!made.key || !made.value) {
        free(made.key);
        free(made.value);
        return FACET_NO_MEMORY;
    }
    notes->items[notes->n++] = made;
    return FACET_OK;
}

void image_notes_destroy(image_notes *notes)
{
    for (size_t i = 0; i < notes->n; i++) {
        free(notes->items[i].key);
        free(notes->items[i].value);
    }
    free(notes->items);
    *notes = (image_notes){0};
}

facet_status image_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why)
{
    *notes = (image_notes){0};
    facet_status status = FACET_OK;
    for (size_t i = 0; i < sizeof KINDS/sizeof KINDS[0]; i++)
        if (is_kind(&KINDS[i], bytes, size)) {
            if (KINDS[i].decode_notes) status = KINDS[i].decode_notes(bytes, size, notes, why);
            break;
        }
    if (status) image_notes_destroy(notes);
    return status;
}
