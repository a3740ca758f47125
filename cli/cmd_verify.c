/* cmd_verify.c: `facet verify`, whether a reflection model is right.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/json_writer.h"
#include "cli/plugin_host.h"
#include "cli/report.h"
#include "io/merl.h"
#include "verify/search.h"
#include "verify/verify.h"

enum { MOST_OPERANDS = 33, MOST_CASES = 128 };

typedef struct settings {
    bool all, json, fixed, search;
    const char *plugin, *check;
    uint64_t samples, seed;
    option_number patience;
    const char *operands[MOST_OPERANDS];
    size_t n_operands;
} settings;

/* ---- What is verified -------------------------------------------------------------------------- */

/* The materials of --all: every model, every choice that changes a formula, and the ends of the ranges. */
static const char *const every[] = {
    "lambert kd=1",
    "ggx alpha=1e-3",
    "ggx alpha=.05",
    "ggx alpha=.3",
    "ggx alpha=1",
    "ggx alpha=4",
    "ggx alpha_x=.1 alpha_y=.5",
    "ggx alpha_x=1 alpha_y=.1",
    "ggx alpha=.3 g2=separable",
    "ggx alpha=.3 sampling=ndf",
    "ggx alpha=.3 sampling=bounded",
    "ggx alpha_x=.2 alpha_y=.6 sampling=bounded",
    "ggx alpha=.2 kd=.5 ior=1.5",
    "ggx alpha=.2 metal=Au",
    "ggx alpha=.2 ks=.9,.6,.3 f82=.9,.8,.7",
    "ggx alpha=.05 energy=multi",
    "ggx alpha=.5 energy=multi",
    "ggx alpha=1 energy=multi",
    "ggx alpha_x=.1 alpha_y=.5 energy=multi",
    "ggx alpha=.5 energy=scaled",
    "beckmann alpha=1e-3",
    "beckmann alpha=.1",
    "beckmann alpha=.5",
    "beckmann alpha=1",
    "beckmann alpha_x=.1 alpha_y=.5",
    "beckmann alpha=.3 sampling=ndf",
    "beckmann alpha=.5 energy=multi",
    "phong exponent=0",
    "phong exponent=1",
    "phong exponent=50",
    "phong exponent=1e5",
    "phong alpha_x=.1 alpha_y=.4",
    "phong exponent=10 sampling=ndf",
    "phong exponent=10 energy=multi",
    "gtr alpha=.1 gamma=.05",
    "gtr alpha=.1 gamma=.7",
    "gtr alpha=.1 gamma=.999",
    "gtr alpha=.1 gamma=1",
    "gtr alpha=.1 gamma=1.001",
    "gtr alpha=.1 gamma=1.5",
    "gtr alpha=1e-3 gamma=1",
    "gtr alpha=1e-3 gamma=2",
    "gtr alpha=.3 gamma=2",
    "gtr alpha=.3 gamma=4.5",
    "gtr alpha=.5 gamma=20",
    "gtr alpha=1 gamma=.5",
    "gtr alpha=1 gamma=20",
    "gtr alpha_x=.1 alpha_y=.5 gamma=1.5",
    "gtr alpha_x=.1 alpha_y=1 gamma=3",
    "gtr alpha=.3 gamma=1.5 sampling=ndf",
    "gtr alpha=.3 gamma=.7 energy=multi",
    "ward alpha_x=.2 alpha_y=.2",
    "ward alpha_x=.1 alpha_y=.3",
    "ward variant=duer alpha_x=.1 alpha_y=.3",
    "ward variant=ward92 alpha_x=.1 alpha_y=.3",
    "cs500 ndf=ggx alpha=.3 kd=.5 ks=.5",
    "cs500 ndf=beckmann alpha=.3 masking=exact",
    "cs500 ndf=phong exponent=20 masking=exact",
    "vray sharpness=.6 masking=exact",
    "vray sharpness=.8 gamma=3 masking=exact",
    "disney",
    "disney metallic=1 roughness=.3 anisotropic=.8",
    "disney roughness=.6 sheen=1 subsurface=1",
    "disney clearcoat=1 coat_masking=exact",
    "metallic_roughness roughness=.3",
    "metallic_roughness metallic=1 roughness=.8",
    "glass",
    "glass alpha=.3",
    "glass alpha=.2 wall=thin",
    "glass alpha=.3 ndf=beckmann",
    "glass alpha=.3 ndf=gtr gamma=1.5",
};

/* One setting of the parameters, as the user would write it. */
typedef struct verify_case {
    char text[400];
    double values[PLUGIN_PARAMETERS]; /* of a plugin */
} verify_case;

typedef struct case_list {
    size_t n;
    verify_case items[MOST_CASES];
} case_list;

/* The values over which a shape parameter is run unless it is fixed. */
typedef struct shape_range {
    const char *name;
    double values[3];
} shape_range;
static const shape_range shapes[] = {{"alpha", {.02, .3, 1}},      {"gamma", {.5, 2, 8}},
                                     {"exponent", {2, 50, 2000}},  {"roughness", {.1, .5, 1}},
                                     {"sharpness", {.1, .5, .85}}, {"anisotropic", {0, .5, 1}}};

static void add_case(case_list *list, const char *text)
{
    if (list->n == MOST_CASES) return;
    snprintf(list->items[list->n].text, sizeof list->items[0].text, "%s", text);
    list->n++;
}

/* The material as it is written, and with each shape parameter that it leaves open at other values, where that is
 * allowed beside what is given. */
static void add_shapes(case_list *list, const char *spec, bool is_fixed)
{
    facet_material m;
    add_case(list, spec);
    if (is_fixed || facet_material_parse(spec, &m, NULL)) return;
    const facet_model_info *model = facet_model_get(m.model);
    for (size_t k = 0; k < model->n_parameters; k++)
        for (size_t s = 0; s < sizeof shapes/sizeof *shapes; s++) {
            if (strcmp(model->parameters[k].name, shapes[s].name) != 0 || m.given >> k & 1) continue;
            for (int v = 0; v < 3; v++) {
                char text[400];
                facet_material changed;
                facet_bsdf64 bsdf;
                snprintf(text, sizeof text, "%s %s=%g", spec, shapes[s].name, shapes[s].values[v]);
                if (shapes[s].values[v] == m.values[k][0]) continue;
                if (facet_material_parse(text, &changed, NULL) || facet_bsdf64_prepare(&changed, &bsdf, NULL)) continue;
                add_case(list, text);
            }
        }
}

/* A plugin at its values, and with each parameter that is not fixed at the ends of its range. */
static void add_plugin_case(case_list *list, const plugin *p, const double values[PLUGIN_PARAMETERS])
{
    char text[400] = "";
    for (int i = 0; i < p->model->parameter_count; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s=%.9g", i ? " " : "", p->model->parameters[i].name, values[i]);
    }
    add_case(list, text);
    memcpy(list->items[list->n - 1].values, values, PLUGIN_PARAMETERS*sizeof *values);
}

static void add_plugin_cases(case_list *list, const plugin *p, bool is_fixed)
{
    add_plugin_case(list, p, p->values);
    for (int i = 0; i < p->model->parameter_count && !is_fixed; i++)
        for (int end = 0; end < 2 && !p->is_fixed[i]; end++) {
            double values[PLUGIN_PARAMETERS];
            memcpy(values, p->values, sizeof values);
            values[i] = end ? p->model->parameters[i].highest : p->model->parameters[i].lowest;
            if (values[i] != p->values[i]) add_plugin_case(list, p, values);
        }
}

/* ---- What is said about it --------------------------------------------------------------------- */

typedef struct verdicts {
    const settings *s;
    json_writer json;
    size_t n_cases, n_done, n_failed; /* failed: checks */
    bool is_terminal;
} verdicts;

static const char *const verdict_names[] = {"holds", "FAILS", "-"};

/* The command that runs this check of this case alone. */
static void reproduction(const verdicts *v, const verify_case *c, const verify_result *r, char *text, size_t size)
{
    char quoted[512];
    if (v->s->plugin) {
        shell_quote(quoted, sizeof quoted, v->s->plugin);
        snprintf(text, size, "facet verify --plugin %s %s --check %s --fixed --samples %llu --seed %llu", quoted,
                 c->text, verify_names[r->check], (unsigned long long)v->s->samples, (unsigned long long)v->s->seed);
    } else {
        shell_quote(quoted, sizeof quoted, c->text);
        snprintf(text, size, "facet verify %s --check %s --fixed --samples %llu --seed %llu", quoted,
                 verify_names[r->check], (unsigned long long)v->s->samples, (unsigned long long)v->s->seed);
    }
}

static void print_row(const verdicts *v, const verify_case *c, const verify_result *r)
{
    char again[1024], worst[24] = "", allowed[24] = "";
    if (r->verdict != VERIFY_LEFT_OUT) snprintf(worst, sizeof worst, "%.2g", r->worst);
    if (r->verdict != VERIFY_LEFT_OUT && isfinite(r->tolerance))
        snprintf(allowed, sizeof allowed, "%.2g", r->tolerance);
    printf("  %-18s %-6s %-9s %-9s %s\n", verify_names[r->check], verdict_names[r->verdict], worst, allowed, r->found);
    if (r->verdict != VERIFY_FAILED) return;
    const bool is_pair = r->wi[0] != 0 || r->wi[1] != 0 || r->wi[2] != 0;
    printf("    at wo %.9g,%.9g,%.9g", r->wo[0], r->wo[1], r->wo[2]);
    if (is_pair) printf(" wi %.9g,%.9g,%.9g", r->wi[0], r->wi[1], r->wi[2]);
    reproduction(v, c, r, again, sizeof again);
    printf("\n    again: %s\n", again);
}

static void write_row(verdicts *v, const verify_case *c, const verify_result *r)
{
    static const char *const names[] = {"passed", "failed", "left out"};
    json_writer *j = &v->json;
    char again[1024];
    json_put_open(j, NULL, '{');
    json_put_text(j, "check", verify_names[r->check]);
    json_put_text(j, "verdict", names[r->verdict]);
    if (r->verdict != VERIFY_LEFT_OUT) {
        json_put_number(j, "worst", r->worst);
        json_put_number(j, "allowed", r->tolerance);
        json_put_text(j, "reason", verify_reasons[r->check]);
        json_put_numbers(j, "wo", r->wo, 3);
        json_put_numbers(j, "wi", r->wi, 3);
    }
    json_put_text(j, "found", r->found);
    if (r->verdict == VERIFY_FAILED) {
        reproduction(v, c, r, again, sizeof again);
        json_put_text(j, "command", again);
    }
    json_put_close(j, '}');
}

static bool is_chosen(const settings *s, int check)
{
    return !s->check || strcmp(s->check, verify_names[check]) == 0;
}

/* A line on a terminal's stderr, which the next one replaces. */
static void show_progress(const verdicts *v, const char *text)
{
    enum { WIDTH = 24 };
    if (!v->is_terminal || v->n_cases < 2) return;
    const int full = (int)(WIDTH*v->n_done/v->n_cases);
    fprintf(stderr, "\r[%.*s%*s] %zu/%zu %-60.60s", full, "########################", WIDTH - full, "", v->n_done + 1,
            v->n_cases, text);
    fflush(stderr);
}

static void end_progress(const verdicts *v)
{
    if (v->is_terminal && v->n_cases > 1) fprintf(stderr, "\r%100s\r", "");
}

/* Runs the checks of one case.  brief: one line unless something fails. */
static void verify_one(verdicts *v, const verify_case *c, const verify_subject *subject, plugin_watch *watch)
{
    const settings *s = v->s;
    const bool is_brief = s->all;
    int n_tests = verify_chi_square_tests(subject)*(int)v->n_cases;
    const verify_settings how = {s->seed, (int)s->samples, n_tests > 0 ? n_tests : 1};
    verify_result results[VERIFY_CHECKS];
    size_t failed = 0, held = 0;
    show_progress(v, c->text);
    for (int k = 0; k < VERIFY_CHECKS; k++) {
        if (!is_chosen(s, k)) continue;
        if (watch) watch->check = verify_names[k];
        results[k] = verify_run(subject, (verify_check)k, &how);
        if (watch) watch->check = NULL;
        failed += results[k].verdict == VERIFY_FAILED;
        held += results[k].verdict == VERIFY_PASSED;
    }
    end_progress(v);
    if (s->json) {
        json_put_open(&v->json, NULL, '{');
        json_put_text(&v->json, s->plugin ? "parameters" : "material", c->text);
        json_put_open(&v->json, "checks", '[');
        for (int k = 0; k < VERIFY_CHECKS; k++)
            if (is_chosen(s, k)) write_row(v, c, &results[k]);
        json_put_close(&v->json, ']');
        json_put_close(&v->json, '}');
    } else {
        printf("%s%s%s", s->plugin ? s->plugin : c->text, s->plugin && *c->text ? " " : "", s->plugin ? c->text : "");
        if (is_brief) printf(": %zu hold", held);
        putchar('\n');
        for (int k = 0; k < VERIFY_CHECKS; k++)
            if (is_chosen(s, k) && (!is_brief || results[k].verdict == VERIFY_FAILED)) print_row(v, c, &results[k]);
        fflush(stdout);
    }
    v->n_failed += failed;
    v->n_done++;
}

/* Where the allowed deviations come from, and the sum. */
static int conclude(verdicts *v)
{
    if (v->s->json) {
        json_put_close(&v->json, ']');
        json_put_integer(&v->json, "failed", v->n_failed);
        json_put_close(&v->json, '}');
        putchar('\n');
        return finish_stdout(v->n_failed ? EXIT_DIFFERS : 0);
    }
    if (!v->s->all) {
        printf("\nallowed:\n");
        for (int k = 0; k < VERIFY_CHECKS; k++)
            if (is_chosen(v->s, k)) printf("  %-18s %s\n", verify_names[k], verify_reasons[k]);
        putchar('\n');
    }
    if (v->n_failed)
        printf("%zu check%s in %zu setting%s of the parameters\n", v->n_failed, v->n_failed == 1 ? " fails" : "s fail",
               v->n_cases, v->n_cases == 1 ? "" : "s");
    else printf("all checks hold\n");
    return finish_stdout(v->n_failed ? EXIT_DIFFERS : 0);
}

static verdicts begin(const settings *s, size_t n_cases)
{
    verdicts v = {.s = s, .n_cases = n_cases, .is_terminal = isatty(STDERR_FILENO)};
    if (s->json) {
        v.json = json_put_start(stdout);
        json_put_open(&v.json, NULL, '{');
        if (s->plugin) json_put_text(&v.json, "plugin", s->plugin);
        json_put_open(&v.json, "cases", '[');
    }
    return v;
}

/* ---- The command ------------------------------------------------------------------------------- */

static int verify_materials(const settings *s, const case_list *list)
{
    verdicts v = begin(s, list->n);
    for (size_t i = 0; i < list->n && stdout_is_good(); i++) {
        facet_material m;
        facet_bsdf64 bsdf;
        facet_error why = {0};
        if (facet_material_parse(list->items[i].text, &m, &why) || facet_bsdf64_prepare(&m, &bsdf, &why))
            return fail_with(FROM_ARGUMENTS, "SPEC", &why);
        const verify_subject subject = verify_material(&m, &bsdf);
        verify_one(&v, &list->items[i], &subject, NULL);
    }
    return conclude(&v);
}

/* ---- The search for the largest errors --------------------------------------------------------- */

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

static void write_worst(json_writer *j, const search_result *r, const search_parameter *parameters, int n,
                        search_term term)
{
    const double m[3] = {(double)r->m[0], (double)r->m[1], (double)r->m[2]};
    json_put_open(j, NULL, '{');
    json_put_text(j, "term", search_names[term]);
    json_put_text(j, "error_is", term == SEARCH_G1 ? "absolute" : "relative");
    json_put_number(j, "error", r->error);
    json_put_number(j, "single", r->found);
    json_put_number(j, "double", r->truth);
    for (int i = 0; i < n; i++) json_put_number(j, parameters[i].name, r->values[i]);
    json_put_numbers(j, "m", m, 3);
    json_put_close(j, '}');
}

static int search_material(const settings *s)
{
    facet_material m;
    search_parameter parameters[SEARCH_PARAMETERS];
    const int status = read_material(s->operands[0], "SPEC", &m);
    if (status) return status;
    const int n = searched_parameters(&m, parameters);
    json_writer j = json_put_start(stdout);
    if (s->json) json_put_open(&j, NULL, '[');
    else printf("largest errors of single precision found, of values above 1e-30\n");
    for (int term = 0; term < SEARCH_TERMS && stdout_is_good(); term++) {
        const search_result r = search_worst(&m, parameters, n, (search_term)term, SEARCH_EVALUATIONS, s->seed);
        if (s->json) {
            write_worst(&j, &r, parameters, n, (search_term)term);
            continue;
        }
        printf("  %-7s %-9.3g %s: %.9g, in double %.9g, at", search_names[term], r.error,
               term == SEARCH_G1 ? "absolute" : "relative", r.found, r.truth);
        for (int i = 0; i < n; i++) printf(" %s=%.9g", parameters[i].name, r.values[i]);
        printf(" m %.9g,%.9g,%.9g\n", (double)r.m[0], (double)r.m[1], (double)r.m[2]);
    }
    if (s->json) {
        json_put_close(&j, ']');
        putchar('\n');
    }
    return finish_stdout(0);
}

/* ---- Measurements and plugins ------------------------------------------------------------------ */

static void eval_measured(const void *self, const double wi[3], const double wo[3], double f[3])
{
    merl_eval(self, wi, wo, f);
}

/* The path in "merl file=PATH", NULL if the material is another. */
static const char *measured_path(const char *spec)
{
    static const char form[] = "merl file=";
    return strncmp(spec, form, strlen(form)) == 0 ? spec + strlen(form) : NULL;
}

static int verify_measured(const settings *s, const char *path)
{
    merl m;
    facet_error why = {0};
    if (merl_read(path, &m, &why)) return fail_with(FROM_INPUT, path, &why);
    const verify_subject subject = {
        .self = &m,
        .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
        .eval = eval_measured,
    };
    case_list *list = calloc(1, sizeof *list);
    if (!list) {
        merl_free(&m);
        return fail_memory();
    }
    add_case(list, s->operands[0]);
    verdicts v = begin(s, list->n);
    verify_one(&v, &list->items[0], &subject, NULL);
    free(list);
    merl_free(&m);
    return conclude(&v);
}

static int verify_plugin(void *context, plugin_watch *watch)
{
    const settings *s = context;
    plugin p;
    int status = plugin_open(s->plugin, s->operands, s->n_operands, watch, &p);
    if (status) return status;
    case_list *list = calloc(1, sizeof *list);
    if (!list) return fail_memory();
    add_plugin_cases(list, &p, s->fixed);
    verdicts v = begin(s, list->n);
    for (size_t i = 0; i < list->n && stdout_is_good(); i++) {
        memcpy(p.values, list->items[i].values, sizeof p.values);
        const verify_subject subject = plugin_subject(&p);
        verify_one(&v, &list->items[i], &subject, watch);
    }
    free(list);
    return conclude(&v);
}

static int run(int argc, char **argv);

static const option options[] = {
    {"all", 0, OPTION_FLAG, offsetof(settings, all), NULL, "every model over its range, one line a material", 0, 0,
     NULL},
    {"plugin", 0, OPTION_TEXT, offsetof(settings, plugin), "FILE.so",
     "a model of your own (include/facet/plugin.h); the operands are NAME=VALUE of its parameters", 0, 0, NULL},
    {"check", 0, OPTION_CHOICE, offsetof(settings, check), "NAME", "one check alone", 0, 0,
     "positive|normalisation|projected-area|weak-furnace|furnace|reciprocity|isotropy|pdf-normalisation|chi-square|"
     "weight|efficiency"},
    {"fixed", 0, OPTION_FLAG, offsetof(settings, fixed), NULL,
     "the parameters as given and at their defaults, not over their ranges", 0, 0, NULL},
    {"search", 0, OPTION_FLAG, offsetof(settings, search), NULL,
     "hunt for the largest errors of D, Lambda and G1 in single precision instead, over what SPEC leaves open", 0, 0,
     NULL},
    {"samples", 0, OPTION_INTEGER, offsetof(settings, samples), "N", "of each chi-square test (default 200000)", 10000,
     1e8, NULL},
    {"seed", 0, OPTION_INTEGER, offsetof(settings, seed), "N", "of all samples (default 1)", 0, 1e15, NULL},
    {"patience", 0, OPTION_NUMBER, offsetof(settings, patience), "SECONDS",
     "how long one call of a plugin may take (default 10)", 0.1, 1e6, NULL},
    {"json", 0, OPTION_FLAG, offsetof(settings, json), NULL, "one JSON object instead of tables", 0, 0, NULL},
};

const command verify_command = {
    .name = "verify",
    .summary = "check that a reflection model is right, or show where it is wrong",
    .operands = "SPEC | --plugin FILE.so [NAME=VALUE ...] | --all",
    .min_operands = 0,
    .max_operands = MOST_OPERANDS,
    .description =
        "Checks identities that every right model satisfies, over a grid of views and of the shape parameters that\n"
        "SPEC leaves open: numbers finite and not negative, the normalisation of D, the projected area of the\n"
        "normals, the weak white furnace, the furnace (albedo at most 1, or 1 where the model claims it),\n"
        "reciprocity, isotropy, the integral of the pdf against the share of draws that give no sample, a chi-square\n"
        "test of the sampler, and weight = f cos/pdf.  A check that fails names the view, the numbers and the command\n"
        "that shows it again.\n"
        "\n"
        "SPEC may be `merl file=FILE.binary`, a measured BRDF of the MERL database.\n"
        "\n"
        "A plugin runs in a process of its own, which may crash or hang: then the exit status is 3.\n",
    .examples = "  facet verify ggx\n"
                "  facet verify 'gtr alpha=.1 gamma=1.5 masking=published' --check weak-furnace\n"
                "  facet verify gtr --search\n"
                "  facet verify --plugin ./plugin_phong.so exponent=20\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};

static int run(int argc, char **argv)
{
    settings s = {.samples = 200000, .seed = 1, .patience = {false, 10}};
    int status = options_parse(&verify_command, argc, argv, &s, s.operands);
    if (status != PARSE_GO) return status;
    while (s.n_operands < MOST_OPERANDS && s.operands[s.n_operands]) s.n_operands++;
    if (s.plugin && (s.all || s.search))
        return fail(EXIT_USAGE, NULL, s.all ? "--all" : "--search", "does not go with --plugin");
    if (s.plugin) return plugin_supervise(s.plugin, s.patience.value, verify_plugin, &s);
    if (s.all ? s.n_operands > 0 : s.n_operands != 1)
        return fail(EXIT_USAGE, NULL, s.all ? "--all" : "SPEC", "%s",
                    s.all ? "takes no material" : "one material is needed, in quotes; or --all, or --plugin FILE.so");
    if (s.search && (s.all || measured_path(s.operands[0])))
        return fail(EXIT_USAGE, NULL, "--search", "takes one material with a distribution of normals");
    if (s.search) return search_material(&s);
    if (!s.all && measured_path(s.operands[0])) return verify_measured(&s, measured_path(s.operands[0]));
    case_list *list = calloc(1, sizeof *list);
    if (!list) return fail_memory();
    if (s.all) {
        for (size_t i = 0; i < sizeof every/sizeof *every; i++) add_case(list, every[i]);
    } else {
        facet_bsdf64 bsdf;
        status = prepare_bsdf64(s.operands[0], "SPEC", &bsdf);
        if (!status) add_shapes(list, s.operands[0], s.fixed);
        else {
            free(list);
            return status;
        }
    }
    status = verify_materials(&s, list);
    free(list);
    return status;
}
