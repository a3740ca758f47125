/* verify_job.h: one `facet verify`: what its parts share.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/json_writer.h"
#include "cli/options.h"
#include "cli/plugin_host.h"
#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { VERIFY_MOST_OPERANDS = 33, VERIFY_MOST_CASES = 128 };

typedef struct verify_options {
    bool all, json, fixed, search;
    const char *plugin, *check, *pictures, *truth;
    uint64_t samples, seed;
    option_number patience;
    const char *operands[VERIFY_MOST_OPERANDS];
    size_t n_operands;
    const char *command_line;
} verify_options;

/* Whether --check leaves this one in. */
bool verify_is_chosen(const verify_options *o, verify_check check);

/* ---- What is verified (verify_cases.c) --------------------------------------------------------- */

/* One setting of the parameters, as the user would write it. */
typedef struct verify_case {
    char text[400];
    double values[PLUGIN_PARAMETERS]; /* of a plugin */
} verify_case;

typedef struct case_list {
    size_t n;
    verify_case items[VERIFY_MOST_CASES];
} case_list;

void cases_add(case_list *list, const char *text);

/* The materials of --all. */
void cases_add_every(case_list *list);

/* The material as it is written, and with each shape parameter that it leaves open at other values, where that is
 * allowed beside what is given. */
void cases_add_shapes(case_list *list, const char *spec, bool is_fixed);

/* A plugin at its values, and with each parameter that is not fixed at the ends of its range. */
void cases_add_plugin(case_list *list, const plugin *p, bool is_fixed);

/* ---- What is said about it (verify_report.c) --------------------------------------------------- */

typedef struct verdicts {
    const verify_options *o;
    json_writer json;
    size_t n_cases, n_done, n_failed; /* failed: checks */
} verdicts;

/* What a case is called: the material, or the plugin and its parameters. */
void case_title(const verify_options *o, const verify_case *c, char *title, size_t size);

verdicts verdicts_begin(const verify_options *o, size_t n_cases);

/* Runs the checks of one case, and draws its pictures; 0 or the exit status of an error that it printed. */
int verdicts_add(verdicts *v, const verify_case *c, const verify_subject *subject, plugin_watch *watch);

/* Where the allowed deviations come from, and the sum; the exit status. */
int verdicts_end(verdicts *v);

/* ---- Pictures (verify_pictures.c) -------------------------------------------------------------- */

/* Makes the folder of --plot, unless it is there; 0 or the exit status of an error that it printed, also if this build
 * cannot draw. */
int pictures_prepare(const verify_options *o);

/* Draws what was looked at in a case that is number n_done of v. */
int pictures_draw(const verdicts *v, const verify_case *c, const verify_subject *subject,
                  const verify_settings *settings);

/* ---- Errors of the library (verify_search.c, verify_truth.c) ----------------------------------- */

/* --search and --truth: the exit status. */
int verify_search(const verify_options *o);
int verify_truth(const verify_options *o);

#ifdef __cplusplus
}
#endif
