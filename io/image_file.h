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

/* Whether the bytes begin as a picture of some kind does, read here or not. */
bool image_is_known(const unsigned char *bytes, size_t size);

/* The decoders that image_decode chooses among by content. */
facet_status hdr_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why);
facet_status exr_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why);
facet_status png_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why);
facet_status jpeg_decode(const unsigned char *bytes, size_t size, image *picture, facet_error *why);

/* Text kept with a picture: facet writes its provenance (version, command line, seed, ...). */
typedef struct image_text {
    const char *key; /* "facet:seed" */
    const char *value;
} image_text;

typedef enum exr_precision { EXR_FLOAT, EXR_HALF } exr_precision;

/* OpenEXR, ZIP compressed scan lines, channels R G B [A] (or Y for one channel).  picture: F32.
 * matrices: the camera's, row vectors as OpenEXR's worldToCamera and worldToNDC ask; either may be NULL. */
facet_status exr_write(const char *path, const image *picture, exr_precision precision, const image_text *text,
                       size_t n_texts, const float *world_to_camera, const float *world_to_ndc, facet_error *why);

/* PNG, 8 or 16 bit, of an image of type U8 or U16, marked as sRGB; text goes into tEXt/iTXt chunks. */
facet_status png_write(const char *path, const image *picture, const image_text *text, size_t n_texts,
                       facet_error *why);

/* The same into memory, without texts and compressed a little: a picture that is shown once.  The caller frees
 * *bytes. */
facet_status png_encode(const image *picture, char **bytes, size_t *size, facet_error *why);

#ifdef __cplusplus
}
#endif
