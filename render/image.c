/* image.c: a picture in memory.
 * SPDX-License-Identifier: MIT */
#include "render/image.h"

#include <stdlib.h>

void image_destroy(image *picture)
{
    if (picture) {
        free(picture->pixels);
        *picture = (image){0};
    }
}
