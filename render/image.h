/* image.h: a picture in memory.  Rows run from top to bottom.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum pixel_type { PIXEL_U8, PIXEL_U16, PIXEL_F32 } pixel_type;

/* Pixels of more than this are refused before memory is taken. */
#define IMAGE_PIXEL_CAP ((size_t)1 << 28)

/* U8 and U16 hold the file's own values (sRGB-encoded or data, as the caller knows); F32 is linear. */
typedef struct image {
    size_t width, height;
    size_t n_channels; /* 1 grey, 2 grey+alpha, 3 RGB, 4 RGBA */
    pixel_type type;
    void *pixels; /* [height][width][n_channels], rows from the top */
} image;

/* Frees the pixels and zeroes the struct; NULL and an empty image are fine. */
void image_destroy(image *picture);

#ifdef __cplusplus
}
#endif
