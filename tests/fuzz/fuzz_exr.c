/* fuzz_exr.c: libFuzzer's way into the OpenEXR decoder.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/picture_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_decoder(exr_decode, bytes, size);
    check_notes(bytes, size);
    return 0;
}
