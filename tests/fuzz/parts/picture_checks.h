/* picture_checks.h: what every caller of a picture decoder relies on.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "io/image_file.h"

typedef facet_status picture_decoder(const unsigned char *bytes, size_t size, size_t most, image *picture,
                                     facet_error *why);

/* Decodes with much memory allowed, then with just as much and one byte less than the picture took. */
void check_decoder(picture_decoder *decode, const uint8_t *bytes, size_t size);

/* Reads what the file says beside its pixels. */
void check_notes(const uint8_t *bytes, size_t size);
