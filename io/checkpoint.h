/* checkpoint.h: a render's state in a file, with texts that say what it is a state of.
 *
 * The layout is in docs/reliability.md: little-endian, a version, and one CRC-32 (zlib's) that runs through the file
 * and stands after its head, its texts and each row of pixels; every change of up to 32 neighbouring bits, and every
 * truncation, is noticed.  Written beside, synced and renamed, as all files (file.h).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"
#include "io/image_file.h"
#include "render/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of the file's parts, in bytes: the head behind magic and version too, a pixel, and what features add to it. */
enum {
    CHECKPOINT_VERSION = 2,
    CHECKPOINT_HEAD = 8 + 4*6 + 8*8 + 12*RENDER_MAX_REPORTED,
    CHECKPOINT_PIXEL = 4*16 + 4,
    CHECKPOINT_FEATURES = 6*8 + 16 + 4,
    CHECKPOINT_SUM = 4
};

typedef struct checkpoint {
    render_state state; /* isa is NULL */
    bool has_features;
    image_text *texts; /* [n_texts], into text_bytes */
    size_t n_texts;
    char *text_bytes;
} checkpoint;

facet_status checkpoint_write(const char *path, const render_state *state, const image_text *texts, size_t n_texts,
                              facet_error *why);

/* Whether the file begins as checkpoints do, of whatever format and however damaged. */
bool checkpoint_is_one(const char *path);

/* Reads and checks.  Without its film only the head and the texts are, and state.film has sizes alone.  *c is the
 * caller's to destroy on success. */
facet_status checkpoint_read(const char *path, bool wants_film, checkpoint *c, facet_error *why);
void checkpoint_destroy(checkpoint *c);

/* The value of a key, or NULL. */
const char *checkpoint_text(const checkpoint *c, const char *key);

#ifdef __cplusplus
}
#endif
