/* test_cs500.c: the model of the course against its text, transcribed in angles and double precision with the mistakes
 * corrected: the sign of o.m and the horizon, total reflection, Phong's sampling exponent.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "verify/quadrature.h"

#define PI 3.14159265358979323846

typedef enum ndf { GGX, BECKMANN, PHONG } ndf;
static const char *const names[] = {"ggx", "beckmann", "phong"};

typedef struct printed {
    ndf which;
    double alpha; /* alpha_g, alpha_b or alpha_p */
    double kd[3], ks[3], ior;
    int is_dielectric;
} printed;

static double D_of(const printed *m, double theta)
{
    const double c = cos(theta), t2 = tan(theta)*tan(theta), a2 = m->alpha*m->alpha;
    switch (m->which) {
    case GGX: return a2/(PI*pow(c, 4)*pow(a2 + t2, 2));
    case BECKMANN: return exp(-t2/a2)/(PI*a2*pow(c, 4));
    case PHONG: return (m->alpha + 2)/(2*PI)*pow(c, m->alpha);
    }
    return 0;
}

static double G1_of(const printed *m, double theta)
{
    const double t = tan(theta);
    if (m->which == GGX) return 2/(1 + sqrt(1 + m->alpha*m->alpha*t*t));
    const double a = m->which == PHONG ? sqrt(m->alpha/2 + 1)/t : 1/(m->alpha*t);
    return a < 1.6 ? (3.535*a + 2.181*a*a)/(1 + 2.276*a + 2.577*a*a) : 1;
}

static double F_of(const printed *m, double c, int channel)
{
    if (!m->is_dielectric) return m->ks[channel] + (1 - m->ks[channel])*pow(1 - c, 5);
    const double g2 = m->ior*m->ior - 1 + c*c;
    if (g2 <= 0) return 1;
    const double g = sqrt(g2);
    return 0.5*pow((g - c)/(g + c), 2)*(1 + pow((c*(g + c) - 1)/(c*(g - c) + 1), 2));
}

static double norm(const double v[3])
{
    return sqrt(v[0]*v[0] + v[1]*v[1] + v[2]*v[2]);
}

/* EvalScattering and PdfBrdf. */
static void text_of(const printed *m, const double wi[3], const double wo[3], double f[3], double *pdf)
{
    double h[3], ks[3];
    for (int k = 0; k < 3; k++) h[k] = wi[k] + wo[k];
    const double theta_m = atan2(hypot(h[0], h[1]), h[2]), d = norm(h)/2;
    const double theta_i = atan2(hypot(wi[0], wi[1]), wi[2]), theta_o = atan2(hypot(wo[0], wo[1]), wo[2]);
    const double D = D_of(m, theta_m), G = G1_of(m, theta_i)*G1_of(m, theta_o);
    for (int k = 0; k < 3; k++) {
        f[k] = cos(theta_i)*(m->kd[k]/PI + D*G*F_of(m, d, k)/(4*cos(theta_i)*cos(theta_o)));
        ks[k] = F_of(m, 1, k);
    }
    const double p_d = norm(m->kd)/(norm(m->kd) + norm(ks));
    *pdf = p_d*cos(theta_i)/PI + (1 - p_d)*D*cos(theta_m)/(4*d);
}

static void spec_of(const printed *m, char *text, size_t size)
{
    const size_t n = (size_t)snprintf(text, size, "cs500 ndf=%s %s=%.9g kd=%.9g,%.9g,%.9g ", names[m->which],
                                      m->which == PHONG ? "exponent" : "alpha", m->alpha, m->kd[0], m->kd[1], m->kd[2]);
    if (m->is_dielectric) snprintf(text + n, size - n, "ior=%.9g", m->ior);
    else snprintf(text + n, size - n, "ks=%.9g,%.9g,%.9g", m->ks[0], m->ks[1], m->ks[2]);
}

/* x as nine digits write it, so that the text form carries it exactly. */
static double nine_digits(double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.9g", x);
    return strtod(text, NULL);
}

static printed draw_material(draws *d, int n)
{
    printed m = {.which = (ndf)(n%3), .is_dielectric = n/3%2};
    m.alpha = nine_digits(m.which == PHONG ? draw_log(d, 1, 200) : draw_log(d, .1, 1));
    m.ior = nine_digits(draw_between(d, 1.1, 3));
    for (int k = 0; k < 3; k++) {
        m.kd[k] = n%5 == 0 ? 0 : nine_digits(draw(d));
        m.ks[k] = nine_digits(draw_between(d, .01, 1));
    }
    return m;
}

/* D takes an error of the half vector, eps/|wi + wo| of it, times at most 4 tan/alpha^2 or n tan; where D is not below
 * 1e-6 of its peak that is at most 400 at alpha .1 and n 200.  Rounded directions count as such an error.  The jump of
 * the fit at a = 1.6, 5.7e-5, may be on either side. */
static void eval_and_pdf_are_those_of_the_text(void **state)
{
    (void)state;
    draws random = {17};
    for (int n = 0; n < 6000; n++) {
        const printed m = draw_material(&random, n);
        char spec[160];
        spec_of(&m, spec, sizeof spec);
        double wi[3], wo[3], want[3], want_pdf, got[3];
        draw_direction(&random, wi);
        draw_direction(&random, wo);
        text_of(&m, wi, wo, want, &want_pdf);
        const double half = norm((double[]){wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]});
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(spec, is_double);
            any_eval(&bsdf, wi, wo, got);
            const double pdf = any_pdf(&bsdf, wi, wo);
            const double bound = 64*any_epsilon(&bsdf) + 800*any_epsilon(&bsdf)/half;
            const double jump = m.which == GGX ? 0 : 5.8e-5;
            int is_good = fabs(pdf - want_pdf) <= bound*(want_pdf + 1e-6);
            for (int k = 0; k < 3; k++)
                is_good = is_good && fabs(got[k] - want[k]) <= (bound + jump)*(want[k] + 1e-6);
            if (!is_good)
                fail_msg(
                    "%s, wi (%a, %a, %a), wo (%a, %a, %a): f %.9g %.9g %.9g, not %.9g %.9g %.9g; pdf %.9g, not %.9g",
                    spec, wi[0], wi[1], wi[2], wo[0], wo[1], wo[2], got[0], got[1], got[2], want[0], want[1], want[2],
                    pdf, want_pdf);
        }
    }
}

/* Samples of the specular lobe are mirrored about normals whose cosine is the text's function of xi; for Phong
 * xi^(1/(alpha + 2)), where it prints 1/(alpha + 1).  At normal incidence theta_i = 2 theta_m. */
static void normals_are_drawn_as_the_text_corrected_says(void **state)
{
    (void)state;
    static const char *const specs[] = {"cs500 ndf=ggx alpha=.4", "cs500 ndf=beckmann alpha=.4",
                                        "cs500 ndf=phong exponent=10"};
    const double wo[3] = {0, 0, 1};
    for (int i = 0; i < 3; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(specs[i], is_double);
            for (int k = 0; k < 32; k++) {
                const double xi = (k + 0.4)/32;
                const double cosines[] = {cos(atan(.4*sqrt(xi)/sqrt(1 - xi))), cos(atan(sqrt(-.16*log(1 - xi)))),
                                          pow(xi, 1.0/12)};
                const double want = 2*cosines[i]*cosines[i] - 1;
                const facet_sample64 s = any_sample(&bsdf, wo, (double[3]){xi, 0.3, 0.9});
                if (!(want > 0 ? fabs(s.wi[2] - want) <= 8*any_epsilon(&bsdf) : s.pdf == 0))
                    fail_msg("%s, xi %g: cos_i %.12f, not %.12f", specs[i], xi, s.wi[2], want);
            }
        }
}

/* The settings are those of the models of one distribution, to the bit. */
static void options_are_those_of_the_single_distributions(void **state)
{
    (void)state;
    static const char *const same[][2] = {
        {"cs500 alpha=.3 kd=.5 ks=.2", "ggx alpha=.3 kd=.5 ks=.2 g2=separable masking=published sampling=ndf"},
        {"cs500 ndf=beckmann alpha=.3 ks=.2", "beckmann alpha=.3 ks=.2 g2=separable masking=published sampling=ndf"},
        {"cs500 ndf=phong exponent=20 ior=1.5",
         "phong exponent=20 ior=1.5 g2=separable masking=published sampling=ndf"},
        {"cs500 ndf=phong exponent=20 masking=exact g2=correlated", "phong exponent=20 sampling=ndf"},
        {"cs500 ndf=phong alpha=.25", "cs500 ndf=phong exponent=30"},
        {"cs500 ndf=beckmann exponent=30", "cs500 ndf=beckmann alpha=.25"},
        {"cs500 ndf=phong", "cs500 ndf=phong exponent=50"},
        {"cs500 sampling=vndf masking=exact g2=correlated", "ggx alpha=.3"},
        {"cs500 kd=.5 ks=0", "cs500 kd=.5 ks=0 alpha=.3"},
    };
    for (size_t i = 0; i < sizeof same/sizeof same[0]; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf a = any_bsdf_of(same[i][0], is_double), b = any_bsdf_of(same[i][1], is_double);
            draws random = {1};
            for (int n = 0; n < 200; n++) {
                double wo[3];
                draw_direction(&random, wo);
                const double u[3] = {draw(&random), draw(&random), draw(&random)};
                const facet_sample64 x = any_sample(&a, wo, u), y = any_sample(&b, wo, u);
                if (memcmp(x.wi, y.wi, sizeof x.wi) != 0 || memcmp(x.weight, y.weight, sizeof x.weight) != 0 ||
                    x.pdf != y.pdf)
                    fail_msg("%s and %s: pdf %a and %a", same[i][0], same[i][1], x.pdf, y.pdf);
            }
        }
    facet_material material;
    facet_error why;
    assert_int_equal(facet_material_parse("cs500 alpha=.3 exponent=20", &material, &why), FACET_BAD_VALUE);
}

/* A density of 1e-7 is a sample like any other; the text breaks off below 1e-6.  tan(theta_m) = .5 of a narrow lobe. */
static void small_densities_are_samples(void **state)
{
    (void)state;
    const double wo[3] = {0, 0, 1}, u[3] = {1 - 6*0x1p-24, 1 - 6*0x1p-24, 0.5};
    static const char *const specs[] = {"cs500 alpha=3e-4", "disney metallic=1 roughness=.0173205"};
    for (int i = 0; i < 2; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(specs[i], is_double);
            const facet_sample64 s = any_sample(&bsdf, wo, u);
            if (!(s.pdf > 1e-8 && s.pdf < 1e-6 && s.weight[0] > 0)) fail_msg("%s: pdf %a", specs[i], s.pdf);
        }
}

/* Errata of the text: Kd and Ks are free, and more may be reflected than received. */
static void energy_is_not_conserved(void **state)
{
    (void)state;
    const any_bsdf bsdf = any_bsdf_of("cs500 kd=1 ks=.04 alpha=.3", 1);
    const quadrature polar = gauss_legendre(96, 0, 1), azimuth = periodic_rule(192, 0, 2*PI);
    double wo[3], wi[3], f[3], sum = 0;
    any_direction(.2, 0.3, wo);
    for (int i = 0; i < polar.n; i++)
        for (int j = 0; j < azimuth.n; j++) {
            any_direction(polar.x[i], azimuth.x[j], wi);
            any_eval(&bsdf, wi, wo, f);
            sum += polar.w[i]*azimuth.w[j]*f[0];
        }
    if (!(fabs(sum - 1.1047) <= 1e-4)) fail_msg("albedo %.6f", sum);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eval_and_pdf_are_those_of_the_text),
        cmocka_unit_test(normals_are_drawn_as_the_text_corrected_says),
        cmocka_unit_test(small_densities_are_samples),
        cmocka_unit_test(energy_is_not_conserved),
        cmocka_unit_test(options_are_those_of_the_single_distributions),
    };
    return cmocka_run_group_tests_name("cs500", tests, NULL, NULL);
}
