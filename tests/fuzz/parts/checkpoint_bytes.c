/* checkpoint_bytes.c: see checkpoint_bytes.h.  The format is in docs/reliability.md.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/checkpoint_bytes.h"

#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "io/checkpoint.h"
#include "tests/fuzz/parts/harness.h"

enum { HEAD = CHECKPOINT_HEAD, SUM = CHECKPOINT_SUM, MOST_PIXELS = 4096, MOST_TEXT = 65536 };

static uint32_t get32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* What is left of the input, and the file as far as it is. */
typedef struct assembly {
    const uint8_t *input;
    size_t left, size;
    uint8_t *file;
    uLong crc;
} assembly;

/* A part of the file, and the checksum so far. */
static void add_part(assembly *a, size_t size)
{
    uint8_t *to = a->file + a->size;
    const size_t n = size < a->left ? size : a->left;
    if (n) memcpy(to, a->input, n);
    memset(to + n, 0, size - n);
    a->input += n;
    a->left -= n;
    if (a->size == 0) memcpy(to, (const uint8_t[12]){'f', 'a', 'c', 'e', 't', 'c', 'k', 'p', CHECKPOINT_VERSION}, 12);
    a->crc = crc32(a->crc, to, (uInt)size);
    for (int i = 0; i < SUM; i++) to[size + (size_t)i] = (uint8_t)(a->crc >> 8*i);
    a->size += size + SUM;
}

uint8_t *checkpoint_bytes(const uint8_t *input, size_t size, size_t *file_size)
{
    if (size < 1 + HEAD || input[0]%2 == 0) {
        *file_size = size ? size - 1 : 0;
        return copy_bytes(input + (size > 0), *file_size);
    }
    size_t text = get32(input + 1 + 12), width = get32(input + 1 + 16), height = get32(input + 1 + 20);
    if (text > MOST_TEXT) text = MOST_TEXT;
    if (width > MOST_PIXELS || height > MOST_PIXELS/(width ? width : 1)) width = height = 0;
    const size_t pixel = CHECKPOINT_PIXEL + (get32(input + 1 + 24) ? CHECKPOINT_FEATURES : 0);
    *file_size = HEAD + SUM + text + SUM + height*(width*pixel + SUM);
    assembly a = {input + 1, size - 1, 0, malloc(*file_size), crc32(0, NULL, 0)};
    require(a.file != NULL);
    add_part(&a, HEAD);
    add_part(&a, text);
    for (size_t y = 0; y < height; y++) add_part(&a, width*pixel);
    require(a.size == *file_size);
    return a.file;
}
