/* cmd_eval.c: `facet eval`, values of a BSDF at given directions.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/csv_reader.h"
#include "cli/report.h"

/* Rows that are evaluated in one batch. */
enum { BATCH = 1024, N_COLUMNS = 6 };

typedef struct settings {
    option_vector wi, wo;
    bool is_double;
    const char *csv;
} settings;

static const char *const columns[N_COLUMNS] = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

/* Rows with their results, as structures of arrays for the batch functions. */
typedef struct block {
    size_t n;
    double directions[BATCH][N_COLUMNS]; /* unit wi, wo */
    char texts[BATCH][N_COLUMNS][CSV_FIELD_CAP];
    float in[N_COLUMNS][BATCH], f[3][BATCH], pdf[BATCH];
} block;

static void print_header(void)
{
    printf("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f_r,f_g,f_b,fcos_r,fcos_g,fcos_b,pdf\n");
}

static void print_texts(const block *b, size_t i)
{
    for (int k = 0; k < N_COLUMNS; k++) {
        fputs(b->texts[i][k], stdout);
        putchar(',');
    }
}

static void print_float(block *b, const facet_bsdf *bsdf)
{
    for (size_t i = 0; i < b->n; i++)
        for (int k = 0; k < N_COLUMNS; k++) b->in[k][i] = (float)b->directions[i][k];
    const facet_dirs wi = {b->in[0], b->in[1], b->in[2]}, wo = {b->in[3], b->in[4], b->in[5]};
    facet_bsdf_eval_batch(bsdf, b->n, wi, wo, (facet_rgb){b->f[0], b->f[1], b->f[2]});
    facet_bsdf_pdf_batch(bsdf, b->n, wi, wo, b->pdf);
    for (size_t i = 0; i < b->n; i++) {
        const float cosine = fabsf(b->in[2][i]);
        print_texts(b, i);
        for (int k = 0; k < 3; k++) printf("%.9g,", (double)(cosine > 0 ? b->f[k][i]/cosine : 0));
        printf("%.9g,%.9g,%.9g,%.9g\n", (double)b->f[0][i], (double)b->f[1][i], (double)b->f[2][i], (double)b->pdf[i]);
    }
}

static void print_double(const block *b, const facet_bsdf64 *bsdf)
{
    for (size_t i = 0; i < b->n; i++) {
        const double *wi = b->directions[i], *wo = wi + 3, cosine = fabs(wi[2]);
        double f[3];
        facet_bsdf64_eval(bsdf, wi, wo, f);
        print_texts(b, i);
        for (int k = 0; k < 3; k++) printf("%.17g,", cosine > 0 ? f[k]/cosine : 0);
        printf("%.17g,%.17g,%.17g,%.17g\n", f[0], f[1], f[2], facet_bsdf64_pdf(bsdf, wi, wo));
    }
}

/* The rows of a CSV file, block by block. */
static int eval_file(const settings *s, block *b, const facet_bsdf *bsdf, const facet_bsdf64 *bsdf64)
{
    csv_reader reader;
    csv_row row;
    bool is_end = false;
    int status = csv_open(&reader, s->csv, columns, N_COLUMNS, N_COLUMNS);
    if (!status) print_header();
    while (!status && !is_end && stdout_is_good()) {
        for (b->n = 0; b->n < BATCH && !status;) {
            status = csv_read(&reader, &row, &is_end);
            if (status || is_end) break;
            for (int k = 0; k < N_COLUMNS; k++) snprintf(b->texts[b->n][k], CSV_FIELD_CAP, "%s", row.texts[k]);
            status = csv_directions(&reader, &row, b->directions[b->n], b->directions[b->n] + 3);
            b->n += !status;
        }
        if (s->is_double) print_double(b, bsdf64);
        else print_float(b, bsdf);
    }
    csv_close(&reader);
    return finish_stdout(status);
}

/* The one pair of directions given as options. */
static int eval_pair(const settings *s, block *b, const facet_bsdf *bsdf, const facet_bsdf64 *bsdf64)
{
    for (int k = 0; k < N_COLUMNS; k++) {
        const double value = k < 3 ? s->wi.v[k] : s->wo.v[k - 3];
        b->directions[0][k] = value;
        snprintf(b->texts[0][k], CSV_FIELD_CAP, "%.*g", s->is_double ? 17 : 9, value);
    }
    if (!make_unit(b->directions[0]))
        return fail(EXIT_USAGE, NULL, "--wi", "is not a unit vector; its length has to be 1 within 1e-3");
    if (!make_unit(b->directions[0] + 3))
        return fail(EXIT_USAGE, NULL, "--wo", "is not a unit vector; its length has to be 1 within 1e-3");
    b->n = 1;
    print_header();
    if (s->is_double) print_double(b, bsdf64);
    else print_float(b, bsdf);
    return finish_stdout(0);
}

static int run(int argc, char **argv)
{
    settings s = {0};
    const char *text;
    int status = options_parse(&eval_command, argc, argv, &s, &text);
    if (status != PARSE_GO) return status;
    const bool has_pair = s.wi.is_given && s.wo.is_given;
    if (s.csv && (s.wi.is_given || s.wo.is_given))
        return fail(EXIT_USAGE, NULL, NULL, "--csv and --wi/--wo exclude each other; give one or the other");
    if (!s.csv && !has_pair)
        return fail(EXIT_USAGE, NULL, NULL, "eval needs directions: --wi X,Y,Z and --wo X,Y,Z, or --csv FILE");
    facet_bsdf bsdf;
    facet_bsdf64 bsdf64;
    if ((status = prepare_bsdf(text, "SPEC", &bsdf)) || (status = prepare_bsdf64(text, "SPEC", &bsdf64))) return status;
    block *b = malloc(sizeof *b);
    if (!b) return fail_memory();
    status = s.csv ? eval_file(&s, b, &bsdf, &bsdf64) : eval_pair(&s, b, &bsdf, &bsdf64);
    free(b);
    return status;
}

static const option options[] = {
    {"wi", 0, OPTION_VECTOR, offsetof(settings, wi), "X,Y,Z", "direction to the light", 0, 0, NULL},
    {"wo", 0, OPTION_VECTOR, offsetof(settings, wo), "X,Y,Z", "direction to the viewer", 0, 0, NULL},
    {"csv", 0, OPTION_TEXT, offsetof(settings, csv), "FILE",
     "read pairs of directions from a CSV file, or from stdin for `-`", 0, 0, NULL},
    {"double", 0, OPTION_FLAG, offsetof(settings, is_double), NULL,
     "compute in double precision and print 17 digits (default: float, 9 digits)", 0, 0, NULL},
};

const command eval_command = {
    .name = "eval",
    .summary = "evaluate a material at given directions",
    .operands = "SPEC",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Prints CSV with the columns wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (as given), f_r,f_g,f_b (the BRDF [1/sr]),\n"
        "fcos_r,fcos_g,fcos_b (times |cos theta_i|) and pdf (of sampling wi [1/sr]).\n"
        "A CSV file needs the first six columns, in any order; other columns are left out.  Directions have unit\n"
        "length within 1e-3 and are normalised.  Mirrors and smooth glass are 0 here: see `facet sample`.\n",
    .examples = "  facet eval 'ggx alpha=.3' --wi 0,0.6,0.8 --wo 0,-0.6,0.8\n"
                "  facet eval 'beckmann alpha=.1' --csv directions.csv --double > values.csv\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
