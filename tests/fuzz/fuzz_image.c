/* fuzz_image.c: libFuzzer's way into every picture decoder.
 *
 * Beyond crashes, it checks what callers rely on: a picture that decodes has pixels of its declared size,
 * and a file that is refused says why and leaves the result alone.
 * SPDX-License-Identifier: MIT */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "io/image_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static size_t sample_size(pixel_type type)
{
    return type == PIXEL_U8 ? 1 : type == PIXEL_U16 ? 2 : 4;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    image picture = {0};
    facet_error why = {0};
    if (image_decode(bytes, size, &picture, &why) != FACET_OK) {
        if (picture.pixels || why.status == FACET_OK || !why.text[0]) {
            abort();
        }
        return 0;
    }
    const size_t n = picture.width*picture.height*picture.n_channels*sample_size(picture.type);
    if (n == 0 || picture.n_channels > 4 || picture.width > IMAGE_PIXEL_CAP/picture.height) {
        abort();
    }
    volatile unsigned char last = ((const unsigned char *)picture.pixels)[n - 1]; /* seen by AddressSanitizer */
    (void)last;
    image_destroy(&picture);
    return 0;
}
