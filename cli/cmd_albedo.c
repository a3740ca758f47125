/* cmd_albedo.c: `facet albedo`, the share of light that a material reflects, by quadrature.
 *
 * The albedo of wo is the integral of f(wi,wo) |cos theta_i| over wi above the horizon.  It is taken over
 * the half vector m instead, with d wi = 4 (wo.m) dm, because lobes are narrow around m = n and smooth there.
 * For wo = (s,0,c) and m at angles (theta, phi), wi stays above the horizon exactly for theta below
 * (pi/2 + atan2(s cos phi, c))/2: within that interval the integrand is smooth, and the tanh-sinh rule, whose
 * points crowd towards both ends, resolves lobes of any width.  Around phi the integrand is periodic and the
 * trapezoidal rule converges exponentially.  Both rules are refined until two resolutions agree.
 *
 * Delta lobes (mirrors, smooth glass) have no integrand: their directions are found by sampling.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "cli/commands.h"
#include "cli/report.h"

static const double PI = 3.14159265358979323846;

/* Refinement stops here: 2^MAX_PHI directions of phi, steps of 2^-MAX_STEP in theta. */
enum { MIN_PHI = 5, MAX_PHI = 11, MIN_STEP = 3, MAX_STEP = 5 };

typedef struct settings {
    number_list cosines;
    option_number phi;
} settings;

typedef struct view_direction {
    double cosine, sine; /* of the angle between wo and n */
    double frame[2];     /* cosine and sine of the azimuth of wo */
} view_direction;

/* sum += weight times f |cos theta_i| 4 (wo.m) sin theta, at the half vector with angles theta, phi (phi from
 * the azimuth of wo). */
static void add_point(const facet_bsdf64 *bsdf, const view_direction *v, double theta, double cos_phi, double sin_phi,
                      double weight, double sum[3])
{
    const double sn = sin(theta), cs = cos(theta);
    const double m[3] = {sn*cos_phi, sn*sin_phi, cs};
    const double wo_m = v->sine*m[0] + v->cosine*m[2];
    const double local[3] = {2*wo_m*m[0] - v->sine, 2*wo_m*m[1], 2*wo_m*m[2] - v->cosine};
    if (!(local[2] > 0)) return;
    const double wi[3] = {v->frame[0]*local[0] - v->frame[1]*local[1],
                          v->frame[1]*local[0] + v->frame[0]*local[1], local[2]};
    const double wo[3] = {v->frame[0]*v->sine, v->frame[1]*v->sine, v->cosine};
    double f[3];
    facet_bsdf64_eval(bsdf, wi, wo, f);
    for (int k = 0; k < 3; k++) sum[k] += weight*f[k]*4*wo_m*sn;
}

/* The integral with 2^log_phi directions of phi and steps of 2^-log_step of the tanh-sinh rule. */
static void integrate(const facet_bsdf64 *bsdf, const view_direction *v, int log_phi, int log_step, double albedo[3])
{
    const int n_phi = 1 << log_phi, per_unit = 1 << log_step;
    const double h = 1.0/per_unit, reach = 3.2; /* beyond it the weights are below 1e-15 */
    const int n = (int)(reach*per_unit);
    for (int k = 0; k < 3; k++) albedo[k] = 0;
    for (int j = 0; j < n_phi; j++) {
        const double phi = 2*PI*(j + 0.5)/n_phi, cos_phi = cos(phi), sin_phi = sin(phi);
        const double end = (PI/2 + atan2(v->sine*cos_phi, v->cosine))/2;
        double sum[3] = {0};
        for (int i = -n; i <= n; i++) {
            const double t = i*h, q = exp(-PI*sinh(t)); /* theta = end/(1 + q): exact near 0 where q is huge */
            const double weight = PI*cosh(t)*q/((1 + q)*(1 + q));
            add_point(bsdf, v, end/(1 + q), cos_phi, sin_phi, weight*end*h, sum);
        }
        for (int k = 0; k < 3; k++) albedo[k] += sum[k]*2*PI/n_phi;
    }
}

static double largest_difference(const double a[3], const double b[3])
{
    return fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2])));
}

/* Both rules refined until a finer one changes nothing above 1e-9, or the limits are reached; returns the
 * sum of the two last changes. */
static double integrate_adaptively(const facet_bsdf64 *bsdf, const view_direction *v, double albedo[3])
{
    const double goal = 1e-9;
    int log_phi = MIN_PHI, log_step = MIN_STEP;
    double phi_error = 1, step_error = 1, finer[3];
    integrate(bsdf, v, log_phi, log_step, albedo);
    while ((phi_error > goal && log_phi < MAX_PHI) || (step_error > goal && log_step < MAX_STEP)) {
        if (step_error > goal && log_step < MAX_STEP) {
            integrate(bsdf, v, log_phi, ++log_step, finer);
            step_error = largest_difference(albedo, finer);
            for (int k = 0; k < 3; k++) albedo[k] = finer[k];
        }
        if (phi_error > goal && log_phi < MAX_PHI) {
            integrate(bsdf, v, ++log_phi, log_step, finer);
            phi_error = largest_difference(albedo, finer);
            for (int k = 0; k < 3; k++) albedo[k] = finer[k];
        }
    }
    return phi_error + step_error;
}

/* Adds what delta lobes scatter: each of their directions once, times its probability. */
static void add_delta_lobes(const facet_bsdf64 *bsdf, const view_direction *v, double albedo[3])
{
    enum { N_PICKS = 4096, MAX_DIRECTIONS = 4 };
    const double wo[3] = {v->frame[0]*v->sine, v->frame[1]*v->sine, v->cosine};
    double found[MAX_DIRECTIONS][3];
    int n_found = 0;
    for (int i = 0; i < N_PICKS && n_found < MAX_DIRECTIONS; i++) {
        const double u[3] = {0.5, 0.5, (i + 0.5)/N_PICKS};
        const facet_sample64 s = facet_bsdf64_sample(bsdf, wo, u);
        bool is_new = s.pdf > 0 && (s.lobe & FACET_DELTA);
        for (int k = 0; k < n_found; k++) is_new = is_new && largest_difference(found[k], s.wi) > 1e-9;
        if (!is_new) continue;
        for (int k = 0; k < 3; k++) {
            found[n_found][k] = s.wi[k];
            albedo[k] += s.pdf*s.weight[k];
        }
        n_found++;
    }
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
    const double phi = s.phi.value*PI/180;
    printf("cos,albedo_r,albedo_g,albedo_b,error\n");
    for (size_t i = 0; i < cosines->n && stdout_is_good(); i++) {
        const double c = cosines->items[i];
        const view_direction v = {c, sqrt((1 - c)*(1 + c)), {cos(phi), sin(phi)}};
        double albedo[3];
        const double error = integrate_adaptively(&bsdf, &v, albedo);
        add_delta_lobes(&bsdf, &v, albedo);
        printf("%.9g,%.9g,%.9g,%.9g,%.1e\n", c, albedo[0], albedo[1], albedo[2], error);
    }
    return finish_stdout(0);
}

static const option options[] = {
    {"cos", 0, OPTION_NUMBERS, offsetof(settings, cosines), "C,...",
     "cosines between the view and the normal (default 1,0.9,...,0.1,0.05,0.02,0.01)", 1e-4, 1, NULL},
    {"phi", 0, OPTION_NUMBER, offsetof(settings, phi), "DEGREES",
     "azimuth of the view from the tangent, for anisotropic materials (default 0)", -360, 360, NULL},
};

const command albedo_command = {
    .name = "albedo",
    .summary = "print the directional albedo of a material",
    .operands = "SPEC",
    .min_operands = 1,
    .max_operands = 1,
    .description =
        "Prints CSV with the columns cos, albedo_r,albedo_g,albedo_b and error: the integral of the BRDF times\n"
        "|cos theta_i| over all directions of light above the surface, plus what mirrors and smooth glass reflect\n"
        "and transmit.  Quadrature in double precision over half vectors, not sampling; error is what the last\n"
        "refinement of its two rules changed.\n",
    .examples = "  facet albedo 'ggx alpha=.3'\n  facet albedo 'ggx alpha_x=.1 alpha_y=.4' --cos 0.8,0.2 --phi 90\n",
    .options = options,
    .n_options = sizeof options/sizeof *options,
    .run = run,
};
