/* cmd_albedo.c: `facet albedo`, the share of light that a material reflects and transmits.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "cli/commands.h"
#include "cli/report.h"

static const double PI = 3.14159265358979323846;

typedef struct settings {
    number_list cosines;
    option_number phi;
    bool is_inside, is_averaged;
} settings;

static void print_row(const char *cosine, const double reflected[3], const double transmitted[3], double error)
{
    printf("%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.1e\n", cosine, reflected[0], reflected[1], reflected[2], transmitted[0],
           transmitted[1], transmitted[2], error);
}

static int run(int argc, char **argv)
{
    static const number_list usual = {{1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05, 0.02, 0.01}, 13};
    settings s = {0};
    const char *text;
    int status = options_parse(&albedo_command, argc, argv, &s, &text);
    if (status != PARSE_GO) return status;
    facet_bsdf64 bsdf;
    if ((status = prepare_bsdf64(text, "SPEC", &bsdf))) return status;
    const number_list *cosines = s.cosines.n ? &s.cosines : &usual;
    const double phi = s.phi.value*PI/180, side = s.is_inside ? -1 : 1;
    double reflected[3], transmitted[3], error;
    printf("cos,albedo_r,albedo_g,albedo_b,transmitted_r,transmitted_g,transmitted_b,error\n");
    for (size_t i = 0; i < cosines->n && stdout_is_good(); i++) {
        const double c = cosines->items[i], sine = sqrt((1 - c)*(1 + c));
        const double wo[3] = {sine*cos(phi), sine*sin(phi), side*c};
        char cosine[32];
        snprintf(cosine, sizeof cosine, "%.9g", c);
        facet_bsdf64_albedo(&bsdf, wo, reflected, transmitted, &error);
        print_row(cosine, reflected, transmitted, error);
    }
    if (s.is_averaged && stdout_is_good()) {
        facet_bsdf64_average_albedo(&bsdf, s.is_inside, reflected, transmitted, &error);
        print_row("average", reflected, transmitted, error);
    }
    return finish_stdout(0);
}

static const option options[] = {
    {"cos", 0, OPTION_NUMBERS, offsetof(settings, cosines), "C,...",
     "cosines between the view and the normal (default 1,0.9,...,0.1,0.05,0.02,0.01)", 1e-4, 1, NULL},
    {"phi", 0, OPTION_NUMBER, offsetof(settings, phi), "DEGREES",
     "azimuth of the view from the tangent, for anisotropic materials (default 0)", -360, 360, NULL},
    {"inside", 0, OPTION_FLAG, offsetof(settings, is_inside), NULL, "views from below the surface, inside of glass", 0,
     0, NULL},
    {"average", 0, OPTION_FLAG, offsetof(settings, is_averaged), NULL,
     "one more row, `average` in the column cos: the mean over all views, weighted by the cosine", 0, 0, NULL},
};

const command albedo_command = {
    .name = "albedo",
    .summary = "print the directional albedo of a material",
    .operands = "SPEC",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Prints CSV with the columns cos, albedo_r,albedo_g,albedo_b, transmitted_r,transmitted_g,transmitted_b and\n"
        "error: the integral of the BSDF times |cos theta_i| over the directions of light on the side of the view,\n"
        "and over those on the other side, mirrors and smooth glass included.  What is transmitted is radiance, which\n"
        "carries the square of the ratio of the indices.  Quadrature in double precision, not sampling; error is how\n"
        "far two rules of it disagree, more than the better one is off.\n",
    .examples = "  facet albedo 'ggx alpha=.3' --average\n"
                "  facet albedo 'ggx alpha_x=.1 alpha_y=.4' --cos 0.8,0.2 --phi 90\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
