/* image_file.c: tells pictures apart by their first bytes and calls the decoder (image_file.h).
 * SPDX-License-Identifier: MIT */
#include "io/image_file.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "io/file.h"

typedef facet_status decoder(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);

/* A kind of file: `length` bytes of `magic` at `offset`.  Without a decoder it is refused by name. */
typedef struct kind {
    const char *name;
    size_t offset, length;
    const char *magic;
    decoder *decode;
} kind;

/* Magics that hold no printable text come first; short ones that could begin other files come last. */
static const kind KINDS[] = {
    {"PNG", 0, 4, "\x89PNG", png_decode},
    {"JPEG", 0, 3, "\xff\xd8\xff", jpeg_decode},
    {"OpenEXR", 0, 4, "\x76\x2f\x31\x01", exr_decode},
    {"Radiance HDR", 0, 2, "#?", hdr_decode},
    {"WebP", 8, 4, "WEBP", NULL},
    {"KTX2", 0, 7, "\xabKTX 20", NULL},
    {"KTX", 0, 4, "\xabKTX", NULL},
    {"AVIF", 4, 8, "ftypavif", NULL},
    {"AVIF", 4, 8, "ftypavis", NULL},
    {"HEIF", 4, 4, "ftyp", NULL},
    {"GIF", 0, 4, "GIF8", NULL},
    {"TIFF", 0, 4, "II*\0", NULL},
    {"TIFF", 0, 4, "MM\0*", NULL},
    {"JPEG XL", 0, 12, "\0\0\0\x0cJXL \r\n\x87\n", NULL},
    {"JPEG XL", 0, 2, "\xff\x0a", NULL},
    {"JPEG 2000", 0, 12, "\0\0\0\x0cjP  \r\n\x87\n", NULL},
    {"DDS", 0, 4, "DDS ", NULL},
    {"Photoshop", 0, 4, "8BPS", NULL},
    {"QOI", 0, 4, "qoif", NULL},
    {"PFM", 0, 3, "PF\n", NULL},
    {"PFM", 0, 3, "Pf\n", NULL},
    {"PPM", 0, 2, "P6", NULL},
    {"PGM", 0, 2, "P5", NULL},
    {"Basis Universal", 0, 2, "sB", NULL},
    {"BMP", 0, 2, "BM", NULL},
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
