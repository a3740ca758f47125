/* fuzz_jpeg.c: libFuzzer's way into the JPEG decoder.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/picture_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_decoder(jpeg_decode, bytes, size);
    return 0;
}
