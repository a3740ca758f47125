/* cmd_terms.c: `facet terms`, the distribution's own functions along the angles of a CSV file.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "cli/commands.h"
#include "cli/csv_reader.h"
#include "cli/report.h"

typedef struct settings {
    bool is_double;
    const char *csv;
} settings;

static const char *const columns[] = {"cos_theta", "phi"};

static void print_terms(const facet_bsdf *bsdf, const facet_bsdf64 *bsdf64, bool is_double, double cosine, double phi)
{
    /* (1 - c)(1 + c) keeps the sine's digits near the normal, where 1 - c^2 would lose them. */
    const double sine = sqrt((1 - cosine)*(1 + cosine));
    const double m[3] = {sine*cos(phi), sine*sin(phi), cosine};
    if (is_double) {
        const facet_terms64 t = facet_bsdf64_terms(bsdf64, m);
        printf(",%.17g,%.17g,%.17g\n", t.D, t.Lambda, t.G1);
    } else {
        const float single[3] = {(float)m[0], (float)m[1], (float)m[2]};
        const facet_terms t = facet_bsdf_terms(bsdf, single);
        printf(",%.9g,%.9g,%.9g\n", (double)t.D, (double)t.Lambda, (double)t.G1);
    }
}

static int run(int argc, char **argv)
{
    settings s = {0};
    const char *text;
    int status = options_parse(&terms_command, argc, argv, &s, &text);
    if (status != PARSE_GO) return status;
    if (!s.csv) return fail(EXIT_USAGE, NULL, NULL, "terms needs --csv FILE, or --csv - for stdin");
    facet_bsdf bsdf;
    facet_bsdf64 bsdf64;
    if ((status = prepare_bsdf(text, "SPEC", &bsdf)) || (status = prepare_bsdf64(text, "SPEC", &bsdf64))) return status;
    csv_reader reader;
    csv_row row;
    bool is_end = false;
    status = csv_open(&reader, s.csv, columns, 2, 1);
    const bool has_phi = !status && reader.position[1] != (size_t)-1;
    if (!status) printf("cos_theta%s,D,Lambda,G1\n", has_phi ? ",phi" : "");
    while (!status && stdout_is_good()) {
        status = csv_read(&reader, &row, &is_end);
        if (status || is_end) break;
        if (!(fabs(row.values[0]) <= 1)) {
            status = csv_fail(&reader, "cos_theta is %s; it has to be from -1 to 1", row.texts[0]);
            break;
        }
        fputs(row.texts[0], stdout);
        if (has_phi) printf(",%s", row.texts[1]);
        print_terms(&bsdf, &bsdf64, s.is_double, row.values[0], row.values[1]);
    }
    csv_close(&reader);
    return finish_stdout(status);
}

static const option options[] = {
    {"csv", 0, OPTION_TEXT, offsetof(settings, csv), "FILE", "read the angles from a CSV file, or from stdin for `-`",
     0, 0, NULL},
    {"double", 0, OPTION_FLAG, offsetof(settings, is_double), NULL,
     "compute in double precision and print 17 digits (default: float, 9 digits)", 0, 0, NULL},
};

const command terms_command = {
    .name = "terms",
    .summary = "print D, Lambda and G1 of a material's distribution",
    .operands = "SPEC",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Reads CSV with a column cos_theta and, if there is one, phi [rad]; prints these and D (density of\n"
        "microfacet normals [1/sr]), Lambda and G1 = 1/(1 + Lambda), at the unit vector with these angles:\n"
        "(sin theta cos phi, sin theta sin phi, cos theta), built in double and then rounded unless --double.\n"
        "Models without a distribution (lambert, glass) print zeros.\n",
    .examples = "  printf 'cos_theta\\n1\\n0.5\\n' | facet terms 'ggx alpha=.3' --csv -\n"
                "  facet terms 'beckmann alpha=.1' --csv angles.csv --double\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
