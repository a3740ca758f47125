/* checkpointing.h: `facet render`'s checkpoints: written as it goes, and resumed from.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/events.h"
#include "cli/render_job.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes checkpoints of one render. */
typedef struct saver {
    const render_options *options;
    const struct scene *scene;
    const render_settings *settings;
    event_log *events;
    facet_error why; /* of the last one; status FACET_OK if it was written */
} saver;

/* One that fails is a warning: the one before stays, and the render goes on. */
void save_checkpoint(saver *to, const render_state *state);

/* The instruction set's name as a text that stays. */
const char *static_isa(const char *name);

/* Reads --resume FILE into *state and checks that this render made it; takes over its instruction set and command
 * line.  A file that is not there yet but will be written leaves the state empty.  Returns 0 or the exit status. */
int resume_checkpoint(render_options *o, const scene *s, render_settings *settings, render_state *state);

#ifdef __cplusplus
}
#endif
