/* verify_search.c: `facet verify --search`, the hunt for the largest errors.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/verify_job.h"
#include "verify/search.h"

enum { SEARCH_EVALUATIONS = 20000 };

/* The distribution's own parameters, as far as the material leaves them open, over their whole range. */
static int searched_parameters(const facet_material *m, search_parameter parameters[SEARCH_PARAMETERS])
{
    static const char *const names[] = {"alpha", "gamma", "exponent"};
    const facet_model_info *model = facet_model_get(m->model);
    int n = 0;
    for (size_t i = 0; i < model->n_parameters; i++)
        for (size_t k = 0; k < sizeof names/sizeof *names; k++) {
            const facet_parameter *p = &model->parameters[i];
            if (strcmp(p->name, names[k]) != 0 || m->given >> i & 1 || n == SEARCH_PARAMETERS) continue;
            parameters[n++] = (search_parameter){p->name, fmax(p->low, 1e-8*p->high), p->high};
        }
    return n;
}

static const char *kind_of_error(search_term term)
{
    return term == SEARCH_G1 || term == SEARCH_ALBEDO ? "absolute" : "relative";
}

static void write_worst(json_writer *j, const search_result *r, const search_parameter *parameters, int n,
                        search_term term)
{
    const double m[3] = {(double)r->m[0], (double)r->m[1], (double)r->m[2]};
    json_put_open(j, NULL, '{');
    json_put_text(j, "term", search_names[term]);
    json_put_text(j, "error_is", kind_of_error(term));
    json_put_number(j, "error", r->error);
    json_put_number(j, "found", r->found);
    json_put_number(j, "truth", r->truth);
    for (int i = 0; i < n; i++) json_put_number(j, parameters[i].name, r->values[i]);
    json_put_numbers(j, "m", m, 3);
    json_put_close(j, '}');
}

int verify_search(const verify_options *o)
{
    facet_material m;
    search_parameter parameters[SEARCH_PARAMETERS];
    const int status = read_material(o->operands[0], "SPEC", &m);
    if (status) return status;
    const int n = searched_parameters(&m, parameters);
    json_writer j = json_put_start(stdout);
    if (o->json) json_put_open(&j, NULL, '[');
    else printf("largest errors found: of single precision, of values above 1e-30; of the albedo\n");
    for (int term = 0; term < SEARCH_TERMS && stdout_is_good(); term++) {
        const search_result r = search_worst(&m, parameters, n, (search_term)term, SEARCH_EVALUATIONS, o->seed);
        if (o->json) {
            write_worst(&j, &r, parameters, n, (search_term)term);
            continue;
        }
        printf("  %-7s %-9.3g %s: %.9g for %.9g, at", search_names[term], r.error, kind_of_error((search_term)term),
               r.found, r.truth);
        for (int i = 0; i < n; i++) printf(" %s=%.9g", parameters[i].name, r.values[i]);
        printf(" m %.9g,%.9g,%.9g\n", (double)r.m[0], (double)r.m[1], (double)r.m[2]);
    }
    if (o->json) {
        json_put_close(&j, ']');
        putchar('\n');
    }
    return finish_stdout(0);
}
