/* fuzz_png.c: libFuzzer's way into the PNG decoder: as it is, and with the checksums of its chunks made right, so that
 * a change in a chunk is not only a wrong checksum.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/picture_checks.h"

static void make_checksums_right(uint8_t *bytes, size_t size)
{
    for (size_t at = 8; at < size && size - at >= 12;) { /* length, name, data, checksum */
        uint8_t *chunk = bytes + at;
        const size_t length = (size_t)chunk[0] << 24 | (size_t)chunk[1] << 16 | (size_t)chunk[2] << 8 | chunk[3];
        if (length > size - at - 12) return;
        const uLong sum = crc32(crc32(0, NULL, 0), chunk + 4, (uInt)length + 4);
        for (int i = 0; i < 4; i++) chunk[8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8*i));
        at += 12 + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_decoder(png_decode, bytes, size);
    uint8_t *copy = copy_bytes(bytes, size);
    make_checksums_right(copy, size);
    if (size && memcmp(copy, bytes, size) != 0) check_decoder(png_decode, copy, size);
    check_notes(copy, size);
    free(copy);
    return 0;
}
