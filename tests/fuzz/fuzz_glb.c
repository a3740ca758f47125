/* fuzz_glb.c: libFuzzer's way into the binary container of glTF: as it is, and with its lengths made right, so that a
 * change in one chunk still reaches what comes after the container.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "tests/fuzz/parts/harness.h"
#include "tests/fuzz/parts/scene_checks.h"

enum { HEADER = 12, CHUNK_HEADER = 8 };

static uint32_t get32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void put32(uint8_t *at, size_t value)
{
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> 8*i);
}

/* Version 2, the file's length, a JSON chunk of at most what there is, and a binary one of the rest.  Returns how many
 * bytes that is. */
static size_t make_lengths_right(uint8_t *bytes, size_t size)
{
    size &= ~(size_t)3;
    const size_t left = size - HEADER - CHUNK_HEADER;
    size_t json = get32(bytes + HEADER) & ~(uint32_t)3;
    if (json > left) json = left;
    memcpy(bytes, "glTF\2\0\0\0", 8);
    put32(bytes + 8, size);
    put32(bytes + HEADER, json);
    memcpy(bytes + HEADER + 4, "JSON", 4);
    if (left - json < CHUNK_HEADER) {
        put32(bytes + HEADER, left);
    } else {
        uint8_t *binary = bytes + HEADER + CHUNK_HEADER + json;
        put32(binary, left - json - CHUNK_HEADER);
        memcpy(binary + 4, "BIN\0", 4);
    }
    return size;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    check_scene_file(write_input("input.glb", bytes, size));
    if (size < HEADER + CHUNK_HEADER + 4) return 0;
    uint8_t *copy = copy_bytes(bytes, size);
    const size_t length = make_lengths_right(copy, size);
    if (length != size || memcmp(copy, bytes, size) != 0) check_scene_file(write_input("input.glb", copy, length));
    free(copy);
    return 0;
}
