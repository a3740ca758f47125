/* checkpoint_bytes.h: checkpoints whose checksums are right, whatever their content.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The file that an input describes; free it.  Behind an even first byte the input is the file.  Behind an odd one it is
 * the file without its checksums: the head, whose magic and version are set, the texts and the rows; up to 4096 pixels
 * and 65536 bytes of texts, what the input lacks of the length that the head tells is zero. */
uint8_t *checkpoint_bytes(const uint8_t *input, size_t size, size_t *file_size);
