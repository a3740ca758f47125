/* fuzz_image.c: libFuzzer's way into the choice among the picture decoders, by a file's first bytes.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/picture_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_decoder(image_decode_within, bytes, size);
    return 0;
}
