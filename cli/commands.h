/* commands.h: the program's commands, and what several of them share.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/options.h"
#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const command render_command, compare_command, eval_command, sample_command, terms_command, albedo_command,
    materials_command, scenes_command, info_command, verify_command, fit_command, plot_command, merge_command,
    explore_command;

/* All of them. */
extern const command *const commands[];
extern const size_t n_commands;

/* The helps of all commands as one JSON object on stdout. */
void print_help_json(void);

/* Parses the text form of a material that was given as `place` on the command line.  Returns 0, or the exit
 * status of the error that it printed, with a suggestion for a mistyped model. */
int read_material(const char *text, const char *place, facet_material *m);

/* The same, prepared. */
int prepare_bsdf(const char *text, const char *place, facet_bsdf *bsdf);
int prepare_bsdf64(const char *text, const char *place, facet_bsdf64 *bsdf);

/* Scales v to unit length; false if its length is not within 1e-3 of 1. */
bool make_unit(double v[3]);

#ifdef __cplusplus
}
#endif
