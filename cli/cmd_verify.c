/* cmd_verify.c: `facet verify`, whether a reflection model is right.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/verify_job.h"
#include "io/merl.h"

/* ---- facet's own materials --------------------------------------------------------------------- */

static int verify_listed(const verify_options *o, const case_list *list)
{
    verdicts v = verdicts_begin(o, list->n);
    for (size_t i = 0; i < list->n && stdout_is_good(); i++) {
        facet_material m;
        facet_bsdf64 bsdf;
        facet_error why = {0};
        if (facet_material_parse(list->items[i].text, &m, &why) || facet_bsdf64_prepare(&m, &bsdf, &why))
            return fail_with(FROM_ARGUMENTS, "SPEC", &why);
        const verify_subject subject = verify_material(&m, &bsdf);
        const int status = verdicts_add(&v, &list->items[i], &subject, NULL);
        if (status) return status;
    }
    return verdicts_end(&v);
}

static int verify_materials(const verify_options *o)
{
    facet_bsdf64 bsdf;
    int status = o->all ? 0 : prepare_bsdf64(o->operands[0], "SPEC", &bsdf);
    if (status) return status;
    case_list *list = calloc(1, sizeof *list);
    if (!list) return fail_memory();
    if (o->all) cases_add_every(list);
    else cases_add_shapes(list, o->operands[0], o->fixed);
    status = verify_listed(o, list);
    free(list);
    return status;
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

static int verify_measured(const verify_options *o, const char *path)
{
    merl m;
    facet_error why = {0};
    if (merl_read(path, &m, &why)) return fail_with(FROM_INPUT, path, &why);
    const verify_subject subject = {
        .self = &m,
        .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
        .eval = eval_measured,
    };
    verify_case c = {0};
    snprintf(c.text, sizeof c.text, "%s", o->operands[0]);
    verdicts v = verdicts_begin(o, 1);
    const int status = verdicts_add(&v, &c, &subject, NULL);
    merl_free(&m);
    return status ? status : verdicts_end(&v);
}

static int verify_plugin(void *context, plugin_watch *watch)
{
    const verify_options *o = context;
    plugin p;
    int status = plugin_open(o->plugin, o->operands, o->n_operands, watch, &p);
    if (status) return status;
    case_list *list = calloc(1, sizeof *list);
    if (!list) return fail_memory();
    cases_add_plugin(list, &p, o->fixed);
    verdicts v = verdicts_begin(o, list->n);
    for (size_t i = 0; i < list->n && stdout_is_good() && !status; i++) {
        memcpy(p.values, list->items[i].values, sizeof p.values);
        const verify_subject subject = plugin_subject(&p);
        status = verdicts_add(&v, &list->items[i], &subject, watch);
    }
    free(list);
    return status ? status : verdicts_end(&v);
}

static int run(int argc, char **argv);

static const option options[] = {
    {"all", 0, OPTION_FLAG, offsetof(verify_options, all), NULL, "every model over its range, one line a material", 0,
     0, NULL},
    {"plugin", 0, OPTION_TEXT, offsetof(verify_options, plugin), "FILE.so",
     "a model of your own (include/facet/plugin.h); the operands are NAME=VALUE of its parameters", 0, 0, NULL},
    {"check", 0, OPTION_CHOICE, offsetof(verify_options, check), "NAME", "one check alone", 0, 0,
     "positive|normalisation|projected-area|weak-furnace|furnace|reciprocity|isotropy|pdf-normalisation|chi-square|"
     "weight|efficiency"},
    {"plot", 0, OPTION_TEXT, offsetof(verify_options, pictures), "FOLDER",
     "draws pictures too: N-chi-square.png and N-furnace.png for the Nth setting of the parameters; the folder is made "
     "if it is missing, older pictures of these names are replaced",
     0, 0, NULL},
    {"fixed", 0, OPTION_FLAG, offsetof(verify_options, fixed), NULL,
     "the parameters as given and at their defaults, not over their ranges", 0, 0, NULL},
    {"search", 0, OPTION_FLAG, offsetof(verify_options, search), NULL,
     "hunt for the largest errors of D, Lambda and G1 in single precision, and of the albedo, instead, over what SPEC "
     "leaves open",
     0, 0, NULL},
    {"truth", 0, OPTION_TEXT, offsetof(verify_options, truth), "FOLDER",
     "the largest errors of D, Lambda and G1 against tables of 25 digits instead, such as tests/data/reference", 0, 0,
     NULL},
    {"samples", 0, OPTION_INTEGER, offsetof(verify_options, samples), "N", "of each chi-square test (default 200000)",
     10000, 1e8, NULL},
    {"seed", 0, OPTION_INTEGER, offsetof(verify_options, seed), "N", "of all samples (default 1)", 0, 1e15, NULL},
    {"patience", 0, OPTION_NUMBER, offsetof(verify_options, patience), "SECONDS",
     "how long one call of a plugin may take (default 10)", 0.1, 1e6, NULL},
    {"json", 0, OPTION_FLAG, offsetof(verify_options, json), NULL, "one JSON object instead of tables", 0, 0, NULL},
};

const command verify_command = {
    .name = "verify",
    .summary = "check that a reflection model is right, or show where it is wrong",
    .operands = "SPEC | --plugin FILE.so [NAME=VALUE ...] | --all | --truth FOLDER",
    .min_operands = 0,
    .max_operands = VERIFY_MOST_OPERANDS,
    .description =
        "Checks identities that every right model satisfies, over a grid of views and of the shape parameters that\n"
        "SPEC leaves open: numbers finite and not negative, the normalisation of D, the projected area of the\n"
        "normals, the weak white furnace, the furnace (albedo at most 1, or 1 where the model claims it),\n"
        "reciprocity, isotropy, the integral of the pdf against the share of draws that give no sample, a chi-square\n"
        "test of the sampler, and weight = f cos/pdf.  A check that fails names the view, the numbers and the command\n"
        "that shows it again.\n"
        "\n"
        "--plot draws the samples of the chi-square tests beside the pdf and their difference, the albedo over the\n"
        "angle of the view, and how far the furnace and the weak furnace are from 1.\n"
        "\n"
        "SPEC may be `merl file=FILE.binary`, a measured BRDF of the MERL database.\n"
        "\n"
        "A plugin runs in a process of its own, which may crash or hang: then the exit status is 3.\n",
    .examples = "  facet verify ggx\n"
                "  facet verify 'gtr alpha=.1 gamma=1.5 masking=published' --check weak-furnace\n"
                "  facet verify 'disney roughness=.4' --plot pictures\n"
                "  facet verify gtr --search\n"
                "  facet verify --plugin ./plugin_phong.so exponent=20\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};

static int check_options(const verify_options *o)
{
    const char *const other = o->search ? "--search" : o->truth ? "--truth" : o->all ? "--all" : NULL;
    if (o->plugin) return other ? fail(EXIT_USAGE, NULL, other, "does not go with --plugin") : 0;
    if (o->truth && (o->search || o->all))
        return fail(EXIT_USAGE, NULL, "--truth", "goes neither with --search nor with --all");
    if (o->pictures && (o->search || o->truth)) return fail(EXIT_USAGE, NULL, "--plot", "does not go with %s", other);
    if (o->all || o->truth)
        return o->n_operands ? fail(EXIT_USAGE, NULL, o->all ? "--all" : "--truth", "takes no material") : 0;
    if (o->n_operands != 1)
        return fail(EXIT_USAGE, NULL, "SPEC", "one material is needed, in quotes; or --all, or --plugin FILE.so");
    if (o->search && measured_path(o->operands[0]))
        return fail(EXIT_USAGE, NULL, "--search", "takes one material with a distribution of normals");
    return 0;
}

static int verify(verify_options *o)
{
    const int status = o->pictures ? pictures_prepare(o) : 0;
    if (status) return status;
    if (o->plugin) return plugin_supervise(o->plugin, o->patience.value, verify_plugin, o);
    if (o->truth) return verify_truth(o);
    if (o->search) return verify_search(o);
    if (!o->all && measured_path(o->operands[0])) return verify_measured(o, measured_path(o->operands[0]));
    return verify_materials(o);
}

static int run(int argc, char **argv)
{
    verify_options o = {.samples = 200000, .seed = 1, .patience = {false, 10}};
    int status = options_parse(&verify_command, argc, argv, &o, o.operands);
    if (status != PARSE_GO) return status;
    while (o.n_operands < VERIFY_MOST_OPERANDS && o.operands[o.n_operands]) o.n_operands++;
    if ((status = check_options(&o))) return status;
    char *command_line = quote_command(argc, argv);
    if (!command_line) return fail_memory();
    o.command_line = command_line;
    status = verify(&o);
    free(command_line);
    return status;
}
