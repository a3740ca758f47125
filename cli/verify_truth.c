/* verify_truth.c: `facet verify --truth`, the largest errors of D, Lambda and G1 against tables of 25 digits.
 *
 * The tables are those of tests/data/README.md, whole or in part.  Single precision gets parameters and directions
 * rounded to float, so that its errors include what that changes.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/csv_reader.h"
#include "cli/report.h"
#include "cli/verify_job.h"

/* Below it a value is 0, or stands for it. */
static const double LEAST = 1e-30, DEGREE = 3.14159265358979323846/180;

enum { MODEL, GAMMA, ALPHA_X, ALPHA_Y, HEIGHT, PHI, VALUES, MOST_VALUES = 2, N_COLUMNS = VALUES + MOST_VALUES };

/* Columns in the order of the enum, by the names that the table has for them, "" where it has none. */
typedef struct truth_table {
    const char *name;
    const char *columns[N_COLUMNS];
    size_t n_values;
    bool has_cotangents; /* for HEIGHT; otherwise cosines */
} truth_table;

static const truth_table tables[] = {
    {"d.csv", {"model", "gamma", "alpha_x", "alpha_y", "cos_theta", "phi", "D"}, 1, false},
    {"g1_smith.csv", {"model", "", "alpha_x", "alpha_y", "cos_theta_v", "phi_v", "Lambda", "G1"}, 2, false},
    {"gtr_g1.csv", {"", "gamma", "alpha", "alpha", "mu", "", "Lambda", "G1"}, 2, true},
};
enum { N_TABLES = sizeof tables/sizeof *tables };

typedef struct worst {
    double error;
    char where[200];
} worst;

/* The errors of one term of one model: in double and in single precision. */
typedef struct finding {
    char model[CSV_FIELD_CAP];
    const char *term;
    size_t n_rows;
    worst of[2];
} finding;

enum { MOST_FINDINGS = 16 };

typedef struct findings {
    size_t n;
    finding items[MOST_FINDINGS];
} findings;

/* A row's material in both precisions; preparing a gtr takes long, and rows come sorted. */
typedef struct row_material {
    char text[160];
    facet_bsdf64 twice;
    facet_bsdf single;
} row_material;

/* ---- Rows -------------------------------------------------------------------------------------- */

static const char *model_of(const csv_row *row)
{
    return row->texts[MODEL][0] ? row->texts[MODEL] : "gtr";
}

static int prepare_row(const csv_reader *reader, const csv_row *row, row_material *m)
{
    const char *model = model_of(row);
    const double x = row->values[ALPHA_X], y = row->values[ALPHA_Y];
    char text[sizeof m->text];
    if (strcmp(model, "phong") == 0) snprintf(text, sizeof text, "phong exponent=%.17g", x);
    else if (strcmp(model, "gtr") == 0)
        snprintf(text, sizeof text, "gtr gamma=%.17g alpha_x=%.17g alpha_y=%.17g", row->values[GAMMA], x, y);
    else snprintf(text, sizeof text, "%.40s alpha_x=%.17g alpha_y=%.17g", model, x, y);
    if (strcmp(text, m->text) == 0) return 0;
    facet_material material;
    facet_error why = {0};
    if (facet_material_parse(text, &material, &why) || facet_bsdf64_prepare(&material, &m->twice, &why) ||
        facet_bsdf_prepare(&material, &m->single, &why))
        return csv_fail(reader, "%s: %s", why.place, why.text);
    memcpy(m->text, text, sizeof text);
    return 0;
}

static void row_direction(const truth_table *table, const csv_row *row, double m[3])
{
    const double height = row->values[HEIGHT], phi = row->values[PHI];
    const double cosine = table->has_cotangents ? height/hypot(height, 1) : height;
    const double sine = table->has_cotangents ? 1/hypot(height, 1) : sqrt((1 - height)*(1 + height));
    m[0] = sine*cos(phi);
    m[1] = sine*sin(phi);
    m[2] = cosine;
}

static finding *find(findings *all, const char *model, const char *term)
{
    for (size_t i = 0; i < all->n; i++)
        if (strcmp(all->items[i].model, model) == 0 && strcmp(all->items[i].term, term) == 0) return &all->items[i];
    if (all->n == MOST_FINDINGS) return NULL;
    finding *made = &all->items[all->n++];
    *made = (finding){.term = term};
    memcpy(made->model, model, strlen(model) + 1);
    return made;
}

static void keep_worst(worst *w, double error, const truth_table *table, const csv_reader *reader, const csv_row *row,
                       const double m[3])
{
    if (!(error > w->error) && !isnan(error)) return;
    const bool is_phong = strcmp(model_of(row), "phong") == 0;
    char gamma[32] = "", y[32] = "";
    if (row->texts[GAMMA][0] && row->values[GAMMA] > 0)
        snprintf(gamma, sizeof gamma, "gamma=%.3g ", row->values[GAMMA]);
    if (!is_phong && row->values[ALPHA_X] != row->values[ALPHA_Y]) snprintf(y, sizeof y, ",%.3g", row->values[ALPHA_Y]);
    w->error = isnan(error) ? INFINITY : error;
    snprintf(w->where, sizeof w->where, "%s%s=%.3g%s, %.4g°, %s:%zu", gamma, is_phong ? "exponent" : "alpha",
             row->values[ALPHA_X], y, atan2(hypot(m[0], m[1]), m[2])/DEGREE, table->name, reader->line);
}

static int compare_row(findings *all, const truth_table *table, const csv_reader *reader, const csv_row *row,
                       row_material *material)
{
    double m[3];
    const int status = prepare_row(reader, row, material);
    if (status) return status;
    row_direction(table, row, m);
    const float rounded[3] = {(float)m[0], (float)m[1], (float)m[2]};
    const facet_terms64 twice = facet_bsdf64_terms(&material->twice, m);
    const facet_terms single = facet_bsdf_terms(&material->single, rounded);
    for (size_t k = 0; k < table->n_values; k++) {
        const char *term = table->columns[VALUES + k];
        const double truth = row->values[VALUES + k];
        const double found[2] = {*term == 'D'   ? twice.D
                                 : *term == 'L' ? twice.Lambda
                                                : twice.G1,
                                 (double)(*term == 'D'   ? single.D
                                          : *term == 'L' ? single.Lambda
                                                         : single.G1)};
        finding *f = find(all, model_of(row), term);
        if (!f) return csv_fail(reader, "there are more than %d models and terms", MOST_FINDINGS);
        if (!(truth > LEAST)) continue;
        f->n_rows++;
        for (int i = 0; i < 2; i++)
            keep_worst(&f->of[i], fabs(found[i] - truth)/(*term == 'G' ? 1 : truth), table, reader, row, m);
    }
    return 0;
}

/* ---- Tables ------------------------------------------------------------------------------------ */

static int check_columns(const csv_reader *reader)
{
    for (size_t i = 0; i < reader->n_columns; i++)
        if (reader->columns[i][0] && reader->position[i] == (size_t)-1)
            return csv_fail(reader, "no column `%s`; the header has to name it", reader->columns[i]);
    return 0;
}

static int compare_table(findings *all, const truth_table *table, const char *path)
{
    csv_reader reader;
    csv_row row;
    row_material material = {.text = ""};
    bool is_end = false;
    int status = csv_open(&reader, path, table->columns, VALUES + table->n_values, 0);
    reader.n_words = 1;
    if (!status) status = check_columns(&reader);
    while (!status && !(status = csv_read(&reader, &row, &is_end)) && !is_end)
        status = compare_row(all, table, &reader, &row, &material);
    csv_close(&reader);
    return status;
}

static void write_finding(json_writer *j, const finding *f)
{
    json_put_open(j, NULL, '{');
    json_put_text(j, "model", f->model);
    json_put_text(j, "term", f->term);
    json_put_text(j, "error_is", *f->term == 'G' ? "absolute" : "relative");
    json_put_integer(j, "rows", f->n_rows);
    json_put_number(j, "double", f->of[0].error);
    json_put_text(j, "double_at", f->of[0].where);
    json_put_number(j, "single", f->of[1].error);
    json_put_text(j, "single_at", f->of[1].where);
    json_put_close(j, '}');
}

static void print_finding(const finding *f)
{
    printf("| %s | %s | %s | %zu | %.1e | %s | %.1e | %s |\n", f->model, f->term,
           *f->term == 'G' ? "absolute" : "relative", f->n_rows, f->of[0].error, f->of[0].where, f->of[1].error,
           f->of[1].where);
}

int verify_truth(const verify_options *o)
{
    findings all = {0};
    size_t n_tables = 0;
    for (size_t i = 0; i < N_TABLES; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", o->truth, tables[i].name);
        if (access(path, F_OK)) continue;
        const int status = compare_table(&all, &tables[i], path);
        if (status) return status;
        n_tables++;
    }
    if (n_tables == 0)
        return fail(EXIT_INPUT, o->truth, NULL, "has none of the tables d.csv, g1_smith.csv and gtr_g1.csv");
    json_writer j = json_put_start(stdout);
    if (o->json) json_put_open(&j, NULL, '[');
    else
        printf("| model | term | error | rows | double | at | single | at |\n"
               "|---|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < all.n; i++) {
        if (o->json) write_finding(&j, &all.items[i]);
        else print_finding(&all.items[i]);
    }
    if (o->json) {
        json_put_close(&j, ']');
        putchar('\n');
    }
    return finish_stdout(0);
}
