/* cmd_fit.c: `facet fit`, the parameters with which models come nearest to measured values.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/fit_points.h"
#include "cli/json_writer.h"
#include "cli/progress.h"
#include "cli/report.h"

enum { MOST_MODELS = 16, SPEC_SIZE = 2048 };

typedef struct settings {
    text_list models;
    const char *keys;
    bool json, quiet;
} settings;

/* A model that is fitted, from how it was asked for to its place in the ranking. */
typedef struct candidate {
    facet_material material;
    fit_keys keys;
    fit_result result;
    char spec[SPEC_SIZE];
} candidate;

/* ---- What is asked for ----------------------------------------------------------------------------------------- */

/* The parameter called by the first n letters of name; the number of parameters if there is none. */
static size_t find_parameter(const facet_model_info *model, const char *name, size_t n)
{
    size_t k = 0;
    while (k < model->n_parameters &&
           !(strlen(model->parameters[k].name) == n && memcmp(model->parameters[k].name, name, n) == 0))
        k++;
    return k;
}

/* The keys of --keys, taken into the material. */
static int take_keys(const char *list, candidate *c)
{
    const facet_model_info *model = facet_model_get(c->material.model);
    for (const char *name = list; *name;) {
        const size_t n = strcspn(name, ","), k = find_parameter(model, name, n);
        if (k == model->n_parameters || model->parameters[k].kind == FACET_CHOICE)
            return fail(EXIT_USAGE, "--keys", NULL,
                        "%s has no number or colour `%.*s`; `facet materials %s` lists them", model->name, (int)n, name,
                        model->name);
        const facet_parameter *p = &model->parameters[k];
        facet_error why = {0};
        if (c->material.given >> k & 1)
            return fail(EXIT_USAGE, "--keys", NULL, "`%s` is to be found and has a value in --model", p->name);
        if (facet_material_set(&c->material, p->name, p->initial, p->kind == FACET_COLOUR ? 3 : 1, &why))
            return fail_with(FROM_ARGUMENTS, "--keys", &why);
        c->keys |= 1u << k;
        name += n + (name[n] == ',');
    }
    return 0;
}

static int read_candidate(const settings *s, const char *text, candidate *c)
{
    *c = (candidate){.keys = 0};
    const int status = read_material(text, "--model", &c->material);
    if (status) return status;
    if (s->keys) return take_keys(s->keys, c);
    c->keys = fit_usual_keys(&c->material);
    if (c->keys) return 0;
    return fail(EXIT_USAGE, "--model", NULL, "`%s` leaves nothing to be found; leave out the keys to be found", text);
}

/* ---- What is told ---------------------------------------------------------------------------------------------- */

/* The name of a choice. */
static void add_choice(FILE *stream, const char *choices, size_t index)
{
    for (; index > 0; index--) choices = strchr(choices, '|') + 1;
    fprintf(stream, "%.*s", (int)strcspn(choices, "|"), choices);
}

/* Five digits: more than measurements tell. */
static void write_spec(const facet_material *m, char *spec, size_t size)
{
    const facet_model_info *model = facet_model_get(m->model);
    FILE *stream = fmemopen(spec, size, "w");
    spec[0] = 0;
    if (!stream) return;
    fputs(model->name, stream);
    for (size_t k = 0; k < model->n_parameters; k++) {
        const facet_parameter *p = &model->parameters[k];
        const double *v = m->values[k];
        if (!(m->given >> k & 1)) continue;
        fprintf(stream, " %s=", p->name);
        if (p->kind == FACET_CHOICE) add_choice(stream, p->choices, (size_t)v[0]);
        else if (p->kind == FACET_COLOUR) fprintf(stream, "%.5g,%.5g,%.5g", v[0], v[1], v[2]);
        else fprintf(stream, "%.5g", v[0]);
    }
    fclose(stream);
}

static bool is_at_end(double value, const facet_parameter *p)
{
    const double near = 1e-6*(p->high - p->low);
    return p->kind == FACET_NUMBER && (value <= p->low*(1 + 1e-6) + 1e-12 || value >= p->high - near);
}

static void tell_on_stderr(const candidate *c, size_t n_points)
{
    const facet_model_info *model = facet_model_get(c->material.model);
    note(
        "%s: error %.4g, the root mean square of ln(1 + f cos) over %zu pairs of directions; %zu of %zu searches ended "
        "there",
        model->name, c->result.error, n_points, c->result.n_least, (size_t)FIT_STARTS);
    for (size_t k = 0; k < model->n_parameters; k++)
        if (c->keys >> k & 1 && is_at_end(c->result.material.values[k][0], &model->parameters[k]))
            note("%s: %s ends at an end of its range", model->name, model->parameters[k].name);
}

static void tell_as_json(const candidate *items, size_t n, const char *path, size_t n_points)
{
    json_writer j = json_put_start(stdout);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "file", path);
    json_put_integer(&j, "pairs", n_points);
    json_put_open(&j, "fits", '[');
    for (size_t i = 0; i < n; i++) {
        json_put_open(&j, NULL, '{');
        json_put_text(&j, "material", items[i].spec);
        json_put_number(&j, "error", items[i].result.error);
        json_put_integer(&j, "searches", FIT_STARTS);
        json_put_integer(&j, "searches_that_agree", items[i].result.n_least);
        json_put_close(&j, '}');
    }
    json_put_close(&j, ']');
    json_put_close(&j, '}');
}

static int by_error(const void *a, const void *b)
{
    const double x = ((const candidate *)a)->result.error, y = ((const candidate *)b)->result.error;
    return (x > y) - (x < y);
}

/* Searches of all models. */
typedef struct searches {
    size_t n_before, n;
    const char *model;
} searches;

/* A fit_progress. */
static void tell_search(void *user, size_t n_done)
{
    const searches *all = user;
    progress_show_step(all->n_before + n_done, all->n, all->model);
}

static int fit_all(const settings *s, const char *path, candidate *items, size_t n)
{
    fit_points points;
    int status = fit_points_read(path, &points);
    for (size_t i = 0; i < n && !status; i++) {
        facet_error why = {0};
        searches all = {i*FIT_STARTS, n*FIT_STARTS, facet_model_get(items[i].material.model)->name};
        if (fit_material(&items[i].material, items[i].keys, points, s->quiet ? NULL : tell_search, &all,
                         &items[i].result, &why))
            status = fail_with(FROM_INPUT, path, &why);
        else write_spec(&items[i].result.material, items[i].spec, SPEC_SIZE);
    }
    if (!s->quiet) progress_end_steps(n*FIT_STARTS);
    if (!status) {
        qsort(items, n, sizeof *items, by_error);
        if (s->json) tell_as_json(items, n, path, points.n);
        for (size_t i = 0; i < n && !s->json; i++) {
            if (!s->quiet) tell_on_stderr(&items[i], points.n);
            puts(items[i].spec);
        }
    }
    fit_points_free(&points);
    return finish_stdout(status);
}

static int run(int argc, char **argv)
{
    settings s = {0};
    const char *path;
    int status = options_parse(&fit_command, argc, argv, &s, &path);
    if (status != PARSE_GO) return status;
    if (s.models.n == 0) return fail(EXIT_USAGE, NULL, "--model", "is needed, such as --model ggx");
    if (s.models.n > MOST_MODELS) return fail(EXIT_USAGE, NULL, "--model", "at most %d are compared", MOST_MODELS);
    candidate *items = malloc(s.models.n*sizeof *items);
    if (!items) return fail_memory();
    status = 0;
    for (size_t i = 0; i < s.models.n && !status; i++) status = read_candidate(&s, s.models.items[i], &items[i]);
    if (!status) status = fit_all(&s, path, items, s.models.n);
    free(items);
    return status;
}

static const option options[] = {
    {"model", 0, OPTION_TEXTS, offsetof(settings, models), "SPEC",
     "the model, such as gtr; keys that are given a value, as in 'ggx ior=1.5', keep it; may be repeated to compare", 0,
     0, NULL},
    {"keys", 0, OPTION_TEXT, offsetof(settings, keys), "KEY,...",
     "find these parameters (default: all numbers and colours but alpha_x, alpha_y, anisotropic, f82, ior, eta, k and "
     "specular_color)",
     0, 0, NULL},
    {"json", 0, OPTION_FLAG, offsetof(settings, json), NULL, "print one JSON object", 0, 0, NULL},
    {"quiet", 0, OPTION_FLAG, offsetof(settings, quiet), NULL, "no notes on how good the fit is", 0, 0, NULL},
};

const command fit_command = {
    .name = "fit",
    .summary = "find a model's parameters for measured values",
    .operands = "FILE",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Prints the material of each --model that comes nearest to the values in FILE, the nearest first, as other\n"
        "commands take it.  Near is a small root mean square of ln(1 + f cos theta_i) less that of the values (Low et\n"
        "al. 2012), over three channels; 16 searches from different starts go downhill.\n"
        "FILE.binary is a measurement of the MERL database, looked at in directions up to 80 degrees from the normal;\n"
        "all else is CSV with the columns wi_x,wi_y,wi_z,wo_x,wo_y,wo_z and f_r,f_g,f_b (the BRDF [1/sr]), as\n"
        "`facet eval` prints it, or - for stdin.  Of more than 20000 rows as many are looked at, evenly taken; the\n"
        "error is that of all.\n",
    .examples = "  facet fit gold-metallic-paint.binary --model gtr --model ggx --model beckmann\n"
                "  facet plot \"$(facet fit measured.csv --model 'gtr kd=0')\" --of f -o fitted.svg\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
