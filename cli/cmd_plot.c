/* cmd_plot.c: `facet plot`, figures of materials.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/plot_materials.h"
#include "cli/report.h"
#include "cli/suggest.h"
#include "plot/figure.h"

enum { MOST_MATERIALS = 64, LEAST_SIDE = 100, MOST_SIDE = 8192 };

typedef struct settings {
    const char *of, *out, *title, *channel, *quantity, *x, *y, *minus;
    text_list labels;
    number_list thetas, range;
    option_number phi, times, patience;
    size_t size[2];
    uint64_t n_samples, seed;
    bool is_log, is_polar;
} settings;

static const figure_kind *find_kind(const char *name)
{
    suggestion near = suggestion_start(name);
    for (size_t i = 0; i < FIGURE_KINDS; i++) {
        if (strcmp(figure_kinds[i].name, name) == 0) return &figure_kinds[i];
        suggestion_offer(&near, figure_kinds[i].name);
    }
    const char *meant = suggestion_get(&near);
    if (meant) fail(EXIT_USAGE, NULL, "--of", "`%s` is not a figure; did you mean `%s`?", name, meant);
    else fail(EXIT_USAGE, NULL, "--of", "`%s` is not a figure; `facet plot --help` lists them", name);
    return NULL;
}

/* "alpha=.1:.5" */
static int read_variable(const char *place, const char *text, figure_variable *v)
{
    int end = 0;
    if (!text) return 0;
    const int n = sscanf(text, "%31[^=]=%lf:%lf%n", v->name, &v->low, &v->high, &end);
    if (n == 3 && !text[end] && isfinite(v->low) && isfinite(v->high) && v->low < v->high) return 0;
    return fail(EXIT_USAGE, NULL, place, "`%s` is not NAME=LOW:HIGH with LOW below HIGH, such as alpha=0.1:0.5", text);
}

static int check_settings(const settings *s, size_t n_materials)
{
    if (!s->of) return fail(EXIT_USAGE, NULL, NULL, "plot needs --of: what to plot; `facet plot --help` lists it");
    if (!s->out) return fail(EXIT_USAGE, NULL, NULL, "plot needs -o OUT.svg, OUT.png or OUT.pdf");
    if (canvas_kind_of(s->out) == CANVAS_UNKNOWN)
        return fail(EXIT_USAGE, s->out, NULL, "is none of .svg, .png and .pdf; name one of these");
    if (s->labels.n > n_materials)
        return fail(EXIT_USAGE, NULL, "--label", "is given %zu times for %zu material%s; give one for each, in order",
                    s->labels.n, n_materials, n_materials == 1 ? "" : "s");
    if (s->range.n && (s->range.n != 2 || !(s->range.items[0] < s->range.items[1])))
        return fail(EXIT_USAGE, NULL, "--range", "takes two numbers LOW,HIGH with LOW below HIGH");
    if (s->is_log && s->range.n && !(s->range.items[0] > 0))
        return fail(EXIT_USAGE, NULL, "--range", "has to begin above 0 with --log");
    for (int k = 0; k < 2; k++)
        if (s->size[k] && (s->size[k] < LEAST_SIDE || s->size[k] > MOST_SIDE))
            return fail(EXIT_USAGE, NULL, "--size", "%zux%zu is out of range; each side is from %d to %d", s->size[0],
                        s->size[1], LEAST_SIDE, MOST_SIDE);
    return 0;
}

static figure_channel channel_of(const char *name)
{
    return *name == 'r' ? CHANNEL_RED : *name == 'g' ? CHANNEL_GREEN : *name == 'b' ? CHANNEL_BLUE : CHANNEL_LUMINANCE;
}

static int check_kind(const settings *s, const figure_kind *kind)
{
    const bool is_log_wrong = s->is_log && !(kind->features & FIGURE_LOG);
    if (is_log_wrong || (s->is_polar && !(kind->features & FIGURE_POLAR)))
        return fail(EXIT_USAGE, NULL, is_log_wrong ? "--log" : "--polar", "is not for --of %s; leave it out",
                    kind->name);
    if (s->thetas.n > 1 && !(kind->features & FIGURE_VIEWS))
        return fail(EXIT_USAGE, NULL, "--theta", "has %zu angles; --of %s takes one", s->thetas.n, kind->name);
    return 0;
}

static int draw(const settings *s, const figure_kind *kind, figure *f, const char *command_line)
{
    double width, height;
    figure_size(kind, f->n_materials, &width, &height);
    if (s->size[0]) {
        width = (double)s->size[0];
        height = (double)s->size[1];
    }
    if (!f->n_thetas) {
        f->thetas = &kind->theta;
        f->n_thetas = 1;
    }
    const image_text texts[] = {{"Title", f->title ? f->title : kind->name},
                                {"facet:version", facet_version()},
                                {"facet:command", command_line}};
    facet_error why = {0};
    const facet_status status = figure_write(kind, f, width, height, s->out, texts, 3, &why);
    if (!status) return 0;
    if (why.place[0]) return fail_with(FROM_ARGUMENTS, NULL, &why);
    return fail_with(FROM_OUTPUT, s->out, &why);
}

/* All that is known before a material is loaded, which plugins are in a process of their own. */
typedef struct plot_job {
    const settings *s;
    const figure_kind *kind;
    figure f;
    plot_spec *specs; /* of the materials, and of the one to be subtracted */
    figure_material *materials;
    const char *command_line;
} plot_job;

static int load_and_draw(void *context, plugin_watch *watch)
{
    plot_job *job = context;
    const size_t n = job->f.n_materials;
    const settings *s = job->s;
    int status = 0;
    for (size_t k = 0; k < n + (s->minus != NULL) && !status; k++) {
        const char *label = k < s->labels.n ? s->labels.items[k] : job->specs[k].text;
        status = plot_spec_open(&job->specs[k], label, watch, &job->materials[k]);
    }
    return status ? status : draw(s, job->kind, &job->f, job->command_line);
}

static int plot(plot_job *job, const char *const *texts)
{
    const size_t n = job->f.n_materials + (job->s->minus != NULL);
    const char *plugin_path = NULL;
    int status = 0;
    for (size_t k = 0; k < n && !status; k++) {
        status = plot_spec_read(k < job->f.n_materials ? texts[k] : job->s->minus, &job->specs[k]);
        if (!plugin_path && job->specs[k].kind == SPEC_PLUGIN) plugin_path = job->specs[k].path;
    }
    if (!status) {
        status = plugin_path ? plugin_supervise(plugin_path, job->s->patience.value, load_and_draw, job)
                             : load_and_draw(job, NULL);
    }
    for (size_t k = 0; k < n; k++) plot_spec_free(&job->specs[k]);
    return status;
}

static int run(int argc, char **argv)
{
    settings s = {.channel = "luminance", .quantity = "G1", .n_samples = 1000, .patience = {false, 10}};
    const char *texts[MOST_MATERIALS];
    int status = options_parse(&plot_command, argc, argv, &s, texts);
    if (status != PARSE_GO) return status;
    size_t n = 0;
    while (n < MOST_MATERIALS && texts[n]) n++;
    if ((status = check_settings(&s, n))) return status;
    const figure_kind *kind = find_kind(s.of);
    if (!kind) return EXIT_USAGE;
    if ((status = check_kind(&s, kind))) return status;
    figure f = {.n_materials = n,
                .title = s.title,
                .thetas = s.thetas.items,
                .n_thetas = s.thetas.n,
                .phi = s.phi.value,
                .channel = channel_of(s.channel),
                .is_log = s.is_log,
                .is_polar = s.is_polar,
                .low = s.range.items[0],
                .high = s.range.items[1],
                .n_samples = s.n_samples,
                .seed = s.seed,
                .quantity = s.quantity,
                .x = {"alpha", 0.1, 0.5},
                .y = {"theta", 0, 90},
                .times = s.times.is_given ? s.times.value : 1};
    if ((status = read_variable("--x", s.x, &f.x)) || (status = read_variable("--y", s.y, &f.y))) return status;
    figure_material *materials = calloc(n + 1, sizeof *materials);
    plot_spec *specs = calloc(n + 1, sizeof *specs);
    char *command_line = quote_command(argc, argv);
    f.materials = materials;
    f.minus = s.minus ? &materials[n] : NULL;
    plot_job job = {&s, kind, f, specs, materials, command_line};
    status = materials && specs && command_line ? plot(&job, texts) : fail_memory();
    free(command_line);
    free(specs);
    free(materials);
    return status;
}

static const option options[] = {
    {"of", 0, OPTION_TEXT, offsetof(settings, of), "WHAT", "what to plot; it is required", 0, 0, NULL},
    {"output", 'o', OPTION_TEXT, offsetof(settings, out), "FILE", "the picture: .svg, .png or .pdf; it is required", 0,
     0, NULL},
    {"theta", 0, OPTION_NUMBERS, offsetof(settings, thetas), "DEG,...",
     "angle of the view from the normal, or of theta-h and theta-d the angle that stays; for several, a curve each "
     "(default 45, or 0 for theta-h and theta-d)",
     0, 89.9, NULL},
    {"phi", 0, OPTION_NUMBER, offsetof(settings, phi), "DEG",
     "azimuth of the plane that is shown from the tangent, for anisotropic materials (default 0)", -360, 360, NULL},
    {"log", 0, OPTION_FLAG, offsetof(settings, is_log), NULL, "values on a logarithmic axis", 0, 0, NULL},
    {"polar", 0, OPTION_FLAG, offsetof(settings, is_polar), NULL, "values as distances in the direction of the angle",
     0, 0, NULL},
    {"channel", 0, OPTION_CHOICE, offsetof(settings, channel), NULL, "of colours (default luminance)", 0, 0,
     "r|g|b|luminance"},
    {"range", 0, OPTION_NUMBERS, offsetof(settings, range), "LOW,HIGH",
     "of the values shown (default: all, at most eight decades with --log)", -1e30, 1e30, NULL},
    {"label", 0, OPTION_TEXTS, offsetof(settings, labels), "TEXT",
     "names the next material in the legend (default: SPEC as given)", 0, 0, NULL},
    {"title", 0, OPTION_TEXT, offsetof(settings, title), "TEXT", "above the figure", 0, 0, NULL},
    {"size", 0, OPTION_SIZE, offsetof(settings, size), "WxH",
     "of the picture in pixels, text in proportion (default 800x600, or about 420x440 for each panel)", 0, 0, NULL},
    {"quantity", 0, OPTION_CHOICE, offsetof(settings, quantity), NULL, "of heightfield (default G1)", 0, 0,
     "D|Lambda|G1|albedo"},
    {"x", 0, OPTION_TEXT, offsetof(settings, x), "NAME=LOW:HIGH",
     "variable of heightfield and G1-error: a number among the material's parameters, or for heightfield theta "
     "[degrees], cos, tan or cot of the angle to the normal (default alpha=0.1:0.5)",
     0, 0, NULL},
    {"y", 0, OPTION_TEXT, offsetof(settings, y), "NAME=LOW:HIGH", "the other one (default theta=0:90)", 0, 0, NULL},
    {"minus", 0, OPTION_TEXT, offsetof(settings, minus), "SPEC",
     "heightfield of the absolute difference from this material", 0, 0, NULL},
    {"times", 0, OPTION_NUMBER, offsetof(settings, times), "FACTOR", "that heightfield's values are multiplied by",
     1e-6, 1e6, NULL},
    {"samples", 'n', OPTION_INTEGER, offsetof(settings, n_samples), "N",
     "number of samples, the largest one of convergence (default 1000)", 10, 1e6, NULL},
    {"seed", 0, OPTION_INTEGER, offsetof(settings, seed), "N", "seed of the random numbers (default 0)", 0, 0x1p53,
     NULL},
    {"patience", 0, OPTION_NUMBER, offsetof(settings, patience), "SECONDS",
     "how long one call of a plugin may take (default 10)", 0.1, 1e6, NULL},
};

const command plot_command = {
    .name = "plot",
    .summary = "draw figures of materials",
    .operands = "SPEC...",
    .min_operands = 1,
    .max_operands = MOST_MATERIALS,
    .description =
        "Draws one or several materials as WHAT, into an SVG, PNG or PDF file:\n"
        "  D, Lambda, G1  of the distribution over the angle of the normal or the direction\n"
        "  F              Fresnel's term over the angle between light and half vector\n"
        "  f, fcos        the BRDF, and times |cos theta_i|, over the angle of the light\n"
        "  pdf            the sampler's density against f cos over its integral\n"
        "  albedo         the share of light that is reflected, over the angle of the view\n"
        "  theta-h        f over the angle between half vector and normal\n"
        "  theta-d        f over the angle between light and half vector\n"
        "  slice          picture of f over both, at phi_d = 90 degrees, with a gamma of 2.2\n"
        "  lobe           f cos over all directions of light, in three dimensions\n"
        "  heightfield    a quantity over two variables, in three dimensions\n"
        "  samples        directions that the sampler draws\n"
        "  convergence    the error of the sampled albedo against the number of samples\n"
        "  G1-error       how far G1 in single precision is from masking=exact in double, over the variable --x\n"
        "Curves of several materials share a chart; slice, lobe, heightfield and samples give each its own panel.\n"
        "\n"
        "SPEC may also be `merl file=FILE.binary`, a measured BRDF of the MERL database, or\n"
        "`plugin file=FILE.so NAME=VALUE ...`, a model of your own (`facet verify --help`), with what they have: a\n"
        "measurement has no D and no sampler.  F, heightfield and G1-error are of facet's own models alone.  Plugins\n"
        "run in a process of their own, which may crash or hang: then the exit status is 3.\n",
    .examples = "  facet plot 'ggx alpha=.2' 'beckmann alpha=.2' --of D --log -o D.svg\n"
                "  facet plot 'ggx alpha=.3' --of fcos --theta 0,45,80 --polar -o lobes.pdf\n"
                "  facet plot 'merl file=gold-metallic-paint.binary' 'ggx alpha=.1 metal=Au' --of f --log -o gold.svg\n"
                "  facet plot 'plugin file=my_model.so alpha=.3' 'ggx alpha=.3' --of G1 -o mine.svg\n"
                "  facet plot 'gtr gamma=4' --of heightfield --x alpha=.1:.5 --y cot=0:5 -o G1.png\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
