/* cmd_compare.c: `facet compare`, how much two pictures differ.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/json_writer.h"
#include "cli/render_job.h"
#include "cli/report.h"
#include "io/file.h"
#include "io/image_file.h"
#include "render/image_metrics.h"
#include "render/view.h"

typedef struct settings {
    const char *metric, *view, *diff;
    option_number max, exposure;
    uint64_t max_memory; /* 0: the default */
    bool json;
} settings;

/* One of the two pictures: in linear light, and as a screen shows it. */
typedef struct side {
    const char *path;
    image linear, shown;
} side;

typedef struct comparison {
    image_difference linear, shown;
    double value;  /* of the chosen metric */
    float *errors; /* of flip, one per pixel; else NULL */
} comparison;

/* Reads the picture.  High dynamic range is exposed and viewed; what a file already encoded stays as it is. */
static int read_side(side *p, const settings *s)
{
    facet_error why = {0};
    image raw = {0};
    const size_t most = s->max_memory ? s->max_memory : FILE_MEMORY_DEFAULT;
    if (image_read_within(p->path, most, &raw, &why)) return fail_with(FROM_INPUT, p->path, &why);
    view v = VIEW_STANDARD;
    double exposure = 0;
    if (raw.type == PIXEL_F32) {
        view_find(s->view, &v);
        exposure = s->exposure.value;
    }
    facet_status status = image_to_linear(&raw, &p->linear, &why);
    if (!status) status = view_picture(v, (float)exposure, &p->linear, PIXEL_F32, &p->shown, &why);
    image_destroy(&raw);
    return status ? fail_with(FROM_INPUT, p->path, &why) : 0;
}

static double mean3(const double v[3])
{
    return (v[0] + v[1] + v[2])/3;
}

static int measure(const settings *s, side sides[2], comparison *c)
{
    const image *a = &sides[0].linear, *b = &sides[1].linear;
    c->linear = image_compare(a, b);
    c->shown = image_compare(&sides[0].shown, &sides[1].shown);
    if (strcmp(s->metric, "mse") == 0) {
        c->value = mean3(c->linear.mse);
    } else if (strcmp(s->metric, "rmse") == 0) {
        c->value = sqrt(mean3(c->linear.mse));
    } else if (strcmp(s->metric, "relmse") == 0) {
        c->value = mean3(c->linear.rel_mse);
    } else if (strcmp(s->metric, "psnr") == 0) {
        c->value = -10*log10(mean3(c->shown.mse));
    } else if (strcmp(s->metric, "mean") == 0) {
        const double mean_a = mean3(c->linear.mean_a), mean_b = mean3(c->linear.mean_b);
        c->value = mean_a == mean_b ? 0 : fabs(mean_a - mean_b)/fabs(mean_b);
    } else {
        facet_error why = {0};
        c->errors = malloc(a->width*a->height*sizeof *c->errors);
        if (!c->errors) return fail_memory();
        if (image_flip(&sides[0].shown, &sides[1].shown, c->errors, &c->value, &why))
            return fail_with(FROM_INPUT, NULL, &why);
        if (c->linear.n_bad) c->value = NAN; /* the view has hidden it */
    }
    if (c->linear.n_bad)
        warn("%zu pixels are NaN or infinite in one of the pictures; the metrics are not meaningful", c->linear.n_bad);
    return 0;
}

/* The differences as a picture: flip's errors as greys, otherwise those of the display values, with the
 * largest one white. */
static int write_difference(const settings *s, const side sides[2], const comparison *c)
{
    const size_t n = sides[0].shown.width*sides[0].shown.height;
    const float(*a)[3] = (const float(*)[3])sides[0].shown.pixels, (*b)[3] = (const float(*)[3])sides[1].shown.pixels;
    const double largest = fmax(c->shown.largest[0], fmax(c->shown.largest[1], c->shown.largest[2]));
    const double scale = largest > 0 ? 1/largest : 1;
    image picture = {sides[0].shown.width, sides[0].shown.height, 3, PIXEL_U8, malloc(n*3)};
    uint8_t *out = picture.pixels;
    facet_error why = {0};
    if (!out) return fail_memory();
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < 3; k++) {
            const double e = c->errors ? (double)c->errors[i] : fabs((double)a[i][k] - (double)b[i][k])*scale;
            out[3*i + k] = (uint8_t)(255*fmin(fmax(e, 0), 1) + 0.5);
        }
    const facet_status status = png_write(s->diff, &picture, NULL, 0, &why);
    image_destroy(&picture);
    if (status) return fail_with(FROM_OUTPUT, s->diff, &why);
    if (!c->errors) note("%s: white is a difference of %.4g in display values", s->diff, largest);
    return 0;
}

static void print_table(const settings *s, const side sides[2], const comparison *c)
{
    const image_difference *d = &c->linear;
    printf("%zu x %zu pixels, %zu differ\n", sides[0].linear.width, sides[0].linear.height, d->n_different);
    printf("channel  mean A        mean B        A/B           MSE           relMSE        largest\n");
    for (int k = 0; k < 3; k++)
        printf("%c        %-13.7g %-13.7g %-13.7g %-13.7g %-13.7g %.7g\n", "RGB"[k], d -> mean_a[k], d -> mean_b[k],
               d -> mean_a[k]/d -> mean_b[k], d -> mse[k], d -> rel_mse[k], d -> largest[k]);
    printf("%s %.9g\n", s->metric, c->value);
}

static void print_json(const settings *s, const side sides[2], const comparison *c, bool is_passed)
{
    json_writer j = json_put_start(stdout);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "a", sides[0].path);
    json_put_text(&j, "b", sides[1].path);
    json_put_integer(&j, "width", sides[0].linear.width);
    json_put_integer(&j, "height", sides[0].linear.height);
    json_put_integer(&j, "different_pixels", c->linear.n_different);
    json_put_integer(&j, "bad_pixels", c->linear.n_bad);
    json_put_numbers(&j, "mean_a", c->linear.mean_a, 3);
    json_put_numbers(&j, "mean_b", c->linear.mean_b, 3);
    json_put_numbers(&j, "mse", c->linear.mse, 3);
    json_put_numbers(&j, "relmse", c->linear.rel_mse, 3);
    json_put_numbers(&j, "largest", c->linear.largest, 3);
    json_put_text(&j, "metric", s->metric);
    json_put_number(&j, "value", c->value);
    if (s->max.is_given) json_put_number(&j, "max", s->max.value);
    json_put_bool(&j, "passed", is_passed);
    json_put_close(&j, '}');
}

static int compare(const settings *s, side sides[2])
{
    int status;
    if ((status = read_side(&sides[0], s)) || (status = read_side(&sides[1], s))) return status;
    const image *a = &sides[0].linear, *b = &sides[1].linear;
    if (a->width != b->width || a->height != b->height)
        return fail(EXIT_INPUT, sides[1].path, NULL, "has %zu x %zu pixels where %s has %zu x %zu; sizes have to match",
                    b->width, b->height, sides[0].path, a->width, a->height);
    comparison c = {0};
    status = measure(s, sides, &c);
    if (!status && s->diff) status = write_difference(s, sides, &c);
    if (!status) {
        const bool is_psnr = strcmp(s->metric, "psnr") == 0;
        const bool is_passed = !s->max.is_given || (is_psnr ? c.value >= s->max.value : c.value <= s->max.value);
        if (s->json) print_json(s, sides, &c, is_passed);
        else print_table(s, sides, &c);
        status = finish_stdout(is_passed ? 0 : EXIT_DIFFERS);
    }
    free(c.errors);
    return status;
}

static int run(int argc, char **argv)
{
    settings s = {.metric = "rmse", .view = "standard"};
    const char *paths[2];
    int status = options_parse(&compare_command, argc, argv, &s, paths);
    if (status != PARSE_GO) return status;
    if (s.diff && !has_extension(s.diff, "png"))
        return fail(EXIT_USAGE, NULL, "--diff", "`%s` is not the name of a .png file", s.diff);
    for (int k = 0; k < 2 && s.diff; k++)
        if ((status = check_spares(s.diff, paths[k]))) return status;
    side sides[2] = {{.path = paths[0]}, {.path = paths[1]}};
    status = compare(&s, sides);
    for (int k = 0; k < 2; k++) {
        image_destroy(&sides[k].linear);
        image_destroy(&sides[k].shown);
    }
    return status;
}

static const option options[] = {
    {"metric", 0, OPTION_CHOICE, offsetof(settings, metric), NULL, "what is compared (default rmse)", 0, 0,
     "mse|rmse|psnr|relmse|flip|mean"},
    {"max", 0, OPTION_NUMBER, offsetof(settings, max), "X",
     "exit with status 1 if the metric is above X (psnr: below X)", -1e300, 1e300, NULL},
    {"exposure", 0, OPTION_NUMBER, offsetof(settings, exposure), "EV",
     "psnr and flip: brighten EXR and HDR pictures by 2^EV first (default 0)", -50, 50, NULL},
    {"view", 0, OPTION_CHOICE, offsetof(settings, view), NULL,
     "psnr and flip: how EXR and HDR pictures are shown (default standard)", 0, 0, "standard|filmic|agx"},
    {"diff", 0, OPTION_TEXT, offsetof(settings, diff), "FILE.png", "write a picture of the differences", 0, 0, NULL},
    {"max-memory", 0, OPTION_BYTES, offsetof(settings, max_memory), "SIZE",
     "refuse a picture that takes more memory to read, such as 512M (default 8G)", 0, 0, NULL},
    {"json", 0, OPTION_FLAG, offsetof(settings, json), NULL, "print one JSON object instead of a table", 0, 0, NULL},
};

const command compare_command = {
    .name = "compare",
    .summary = "compare two pictures",
    .operands = "A B",
    .min_operands = 2,
    .max_operands = 2,
    .description =
        "A and B are EXR, HDR, PNG or JPEG files of the same size; B is the reference.  Prints per channel the\n"
        "means, their ratio and the errors, in linear light (PNG and JPEG are decoded from sRGB), then the metric:\n"
        "  mse, rmse  mean of (A - B)^2 over pixels and channels, and its root\n"
        "  relmse     mean of (A - B)^2/(B^2 + 0.01)\n"
        "  mean       |mean A/mean B - 1|\n"
        "  psnr       10 log10(1/MSE) of the display values [dB]; inf for equal pictures\n"
        "  flip       mean LDR-FLIP of the display values (Andersson et al. 2020), 0 to 1, at 67 pixels per degree\n",
    .examples = "  facet compare a.exr b.exr --metric relmse --max 0.01\n"
                "  facet compare a.png b.png --metric flip --diff difference.png\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
