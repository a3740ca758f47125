/* provenance.h: texts that say how a render was made: metadata of its pictures, and what a checkpoint is a checkpoint
 * of.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/render_job.h"
#include "io/checkpoint.h"
#include "io/image_file.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PROVENANCE_MOST = 32, PROVENANCE_TEXT_SIZE = 320 };

/* The first n_exr texts go into EXR, where the matrices have attributes of their own; the first n_checkpoint, which
 * do not depend on a kind of picture, into checkpoints. */
typedef struct provenance {
    image_text pairs[PROVENANCE_MOST];
    char values[PROVENANCE_MOST][PROVENANCE_TEXT_SIZE];
    size_t n, n_exr, n_checkpoint;
    float world_to_camera[16], world_to_ndc[16];
} provenance;

/* The texts borrow from all of them.  denoiser: what the pictures went through, or NULL. */
void provenance_collect(provenance *p, const render_options *o, const scene *s, const render_settings *settings,
                        const render_state *state, const char *denoiser);

/* The same for a checkpoint's render, with the figures of another state: that of all shards. */
void provenance_recollect(provenance *p, const render_options *o, const checkpoint *c, const render_state *state,
                          const char *denoiser);

/* Refuses checkpoint `path` if it was made by another render than the texts say, `other` saying whose these are: "this
 * render has".  any_shard: of the same render, but perhaps another shard.  Returns 0 or the exit status. */
int provenance_compare(const char *path, const checkpoint *c, const image_text *texts, size_t n_texts,
                       const char *other, bool any_shard);

#ifdef __cplusplus
}
#endif
