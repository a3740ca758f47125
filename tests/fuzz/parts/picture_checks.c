/* picture_checks.c: see picture_checks.h.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/picture_checks.h"

#include <string.h>

#include "tests/fuzz/parts/harness.h"

/* What a small machine has to spare; a picture of more is refused. */
#define MOST ((size_t)64 << 20)

/* Bytes of the pixels, or 0 for a file that was refused, with a reason and without pixels. */
static size_t decode_once(picture_decoder *decode, const uint8_t *bytes, size_t size, size_t most)
{
    image picture = {0};
    facet_error why = {0};
    if (decode(bytes, size, most, &picture, &why) != FACET_OK) {
        require(!picture.pixels && why.status != FACET_OK && why.text[0]);
        return 0;
    }
    const size_t n = image_byte_count(&picture);
    require(n > 0 && n <= most && picture.n_channels <= 4 && picture.width <= IMAGE_PIXEL_CAP/picture.height);
    const volatile unsigned char last = ((const unsigned char *)picture.pixels)[n - 1]; /* seen by AddressSanitizer */
    (void)last;
    image_destroy(&picture);
    return n;
}

void check_decoder(picture_decoder *decode, const uint8_t *bytes, size_t size)
{
    const size_t n = decode_once(decode, bytes, size, MOST);
    if (n) require(decode_once(decode, bytes, size, n - 1) == 0);
}

void check_notes(const uint8_t *bytes, size_t size)
{
    image_notes notes;
    facet_error why = {0};
    const facet_status status = image_decode_notes(bytes, size, &notes, &why);
    require(status == FACET_OK || (notes.n == 0 && !notes.items && why.text[0]));
    for (size_t i = 0; i < notes.n; i++) require(strlen(notes.items[i].key) + strlen(notes.items[i].value) < size);
    image_notes_destroy(&notes);
}
