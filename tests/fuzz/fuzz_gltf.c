/* fuzz_gltf.c: libFuzzer's way into the glTF reader, by way of a file in a folder of its own.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/scene_checks.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_scene_file(write_input("input.gltf", bytes, size));
    return 0;
}
