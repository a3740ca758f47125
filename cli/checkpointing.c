/* checkpointing.c: `facet render`'s checkpoints.
 * SPDX-License-Identifier: MIT */
#include "cli/checkpointing.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/provenance.h"
#include "cli/report.h"
#include "io/checkpoint.h"

void save_checkpoint(saver *to, const render_state *state)
{
    provenance p;
    const char *path = to->options->checkpoint;
    to->why = (facet_error){0};
    provenance_collect(&p, to->options, to->scene, to->settings, state, NULL);
    to->why.status = checkpoint_write(path, state, p.pairs, p.n_checkpoint, &to->why);
    if (to->why.status) warn("%s: %s; the render goes on", path, to->why.text);
    events_checkpoint(to->events, path, state, to->why.status == FACET_OK);
}

/* What the checkpoint and this render must have in common. */
static int check_identity(const render_options *o, const scene *s, const render_settings *settings, const checkpoint *c)
{
    provenance p;
    const render_state planned = {
        .isa = settings->isa,
        .film = {.width = settings->crop_w ? settings->crop_w : settings->width,
                 .height = settings->crop_h ? settings->crop_h : settings->height},
    };
    provenance_collect(&p, o, s, settings, &planned, NULL);
    return provenance_compare(o->resume, c, p.pairs, p.n, "this render has", false);
}

const char *static_isa(const char *name)
{
    static const char *const names[] = {"any", "sse2", "sse4.2", "avx", "avx2", "avx512", "default"};
    for (size_t i = 0; name && i < sizeof names/sizeof *names; i++)
        if (strcmp(name, names[i]) == 0) return names[i];
    return "unknown";
}

int resume_checkpoint(render_options *o, const scene *s, render_settings *settings, render_state *state)
{
    checkpoint c;
    facet_error why = {0};
    if (o->checkpoint && strcmp(o->checkpoint, o->resume) == 0 && access(o->resume, F_OK) != 0 && errno == ENOENT) {
        if (!o->quiet) note("%s is not there yet; rendering from the start", o->resume);
        return 0;
    }
    if (checkpoint_read(o->resume, true, &c, &why)) return fail_with(FROM_INPUT, o->resume, &why);
    if (!settings->isa) settings->isa = static_isa(checkpoint_text(&c, "facet:isa"));
    settings->keeps_features |= c.has_features;
    int status = check_identity(o, s, settings, &c);
    const char *line = checkpoint_text(&c, "facet:command");
    char *first_command = !status && line ? strdup(line) : NULL;
    if (!status && !first_command) status = fail_memory();
    if (!status) {
        free(o->command_line);
        o->command_line = first_command;
        *state = c.state;
        c.state = (render_state){0};
        if (!o->quiet) note("%s: going on from %" PRIu32 " samples per pixel", o->resume, state->spp);
    }
    checkpoint_destroy(&c);
    return status;
}
