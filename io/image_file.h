/* image_file.h: pictures read from and written to files.
 *
 * Readers: Radiance HDR (hdr.c), OpenEXR (exr.c), PNG of 8 and 16 bit (png.c), JPEG (jpeg.c); the kind is
 * told by the content, not by the name.  Writers: OpenEXR and PNG.  Rows run from top to bottom.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads the file; *picture is the caller's to destroy. */
facet_status image_read(const char *path, image *picture, facet_error *why);

/* Reads a picture that lies in memory (a buffer view, a data URI). */
facet_status image_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why);

/* The same; one that would take more than `most` bytes when decoded is refused before memory is taken, with
 * FACET_UNSUPPORTED.  The two above allow FILE_MEMORY_DEFAULT. */
facet_status image_read_within(const char *path, size_t most, image *picture, facet_error *why);
facet_status image_decode_within(const unsigned char *bytes, size_t size, size_t most, image *picture,
                                 facet_error *why);

/* Bytes of the pixels. */
size_t image_byte_count(const image *picture);
/* For the decoders: refuses a picture of more than IMAGE_PIXEL_CAP pixels or `most` bytes.  `copies`: how many times
 * the pixels lie in memory while they are decoded. */
facet_status image_check_size(const image *picture, size_t copies, size_t most, facet_error *why);

/* Whether the bytes begin as a picture of some kind does, read here or not. */
bool image_is_known(const unsigned char *bytes, size_t size);

/* The decoders that image_decode chooses among by content. */
facet_status hdr_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);
facet_status exr_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);
facet_status png_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);
facet_status jpeg_decode(const unsigned char *bytes, size_t size, size_t most, image *picture, facet_error *why);

/* Text kept with a picture: facet writes its provenance (version, command line, seed, ...). */
typedef struct image_text {
    const char *key; /* "facet:seed" */
    const char *value;
} image_text;

/* What a file says of its picture beside the pixels: of OpenEXR the type of each channel, those of layers included
 * ("half", "float", "uint"), and of OpenEXR and PNG facet's own texts, up to IMAGE_MOST_NOTES in all. */
typedef struct image_note {
    bool is_channel;
    char *key, *value; /* any bytes but 0 */
} image_note;

typedef struct image_notes {
    size_t n;
    image_note *items;
} image_notes;

#define IMAGE_MOST_NOTES 1024

/* *notes is the caller's to destroy; empty for other kinds of files, and on failure. */
facet_status image_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why);
void image_notes_destroy(image_notes *notes);

/* For the decoders: adds a copy, `length` bytes of the value; FACET_NO_MEMORY. */
facet_status image_notes_add(image_notes *notes, bool is_channel, const char *key, const char *value, size_t length);
facet_status exr_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why);
facet_status png_decode_notes(const unsigned char *bytes, size_t size, image_notes *notes, facet_error *why);

/* What the keys of facet's texts begin with. */
#define IMAGE_TEXT_PREFIX "facet:"

typedef enum exr_precision { EXR_FLOAT, EXR_HALF } exr_precision;

/* OpenEXR, ZIP compressed scan lines, channels R G B [A] (or Y for one channel).  picture: F32.
 * matrices: the camera's, row vectors as OpenEXR's worldToCamera and worldToNDC ask; either may be NULL. */
facet_status exr_write(const char *path, const image *picture, exr_precision precision, const image_text *text,
                       size_t n_texts, const float *world_to_camera, const float *world_to_ndc, facet_error *why);

/* A picture among those of an OpenEXR file, F32, by the names of its channels: "R", "albedo.R", "Z". */
typedef struct exr_layer {
    const char *channels[4]; /* [picture->n_channels] */
    const image *picture;    /* all of a file have the same size */
    exr_precision precision;
} exr_layer;

enum { EXR_MOST_LAYERS = 8 };

/* The same with any pictures; names must differ. */
facet_status exr_write_layers(const char *path, const exr_layer *layers, size_t n_layers, const image_text *text,
                              size_t n_texts, const float *world_to_camera, const float *world_to_ndc,
                              facet_error *why);

/* PNG, 8 or 16 bit, of an image of type U8 or U16, marked as sRGB; text goes into tEXt/iTXt chunks. */
facet_status png_write(const char *path, const image *picture, const image_text *text, size_t n_texts,
                       facet_error *why);

/* The same into memory, without texts and compressed a little: a picture that is shown once.  The caller frees
 * *bytes. */
facet_status png_encode(const image *picture, char **bytes, size_t *size, facet_error *why);

#ifdef __cplusplus
}
#endif
