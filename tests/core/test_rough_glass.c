/* test_rough_glass.c: the rough dielectric interface against Walter's formulas in another form, on both sides.
 *
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.  i is the incident
 * direction (to the light), o the scattered one (to the viewer), n the macrosurface's normal; everything here is
 * written with trigonometry, as printed, in double precision.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/weight_check.h"
#include "verify/quadrature.h"

#define PI 3.14159265358979323846

typedef enum shape { GGX, BECKMANN, PHONG, GTR_3_2 } shape;

/* What the text of a material says, for the formulas here. */
typedef struct interface_case {
    const char *spec;
    shape shape;
    double alpha_x, alpha_y, ior;
    int is_thin, is_separable;
} interface_case;

static const interface_case cases[] = {
    {"glass alpha=.3", GGX, .3, .3, 1.5, 0, 0},
    {"glass alpha=.7 ior=.6 sampling=ndf", GGX, .7, .7, .6, 0, 0},
    {"glass alpha_x=.2 alpha_y=.6 ior=2 g2=separable", GGX, .2, .6, 2, 0, 1},
    {"glass alpha=.4 ior=1.05", GGX, .4, .4, 1.05, 0, 0},
    {"glass alpha=1 ior=10", GGX, 1, 1, 10, 0, 0},
    {"glass alpha=1 ior=.1", GGX, 1, 1, .1, 0, 0},
    {"glass alpha=.3 ndf=beckmann", BECKMANN, .3, .3, 1.5, 0, 0},
    {"glass alpha_x=.5 alpha_y=.2 ndf=beckmann ior=.8 sampling=ndf", BECKMANN, .5, .2, .8, 0, 0},
    {"glass exponent=30 ndf=phong ior=1.33", PHONG, .25, .25, 1.33, 0, 0},
    {"glass alpha=.4 ndf=gtr gamma=1.5", GTR_3_2, .4, .4, 1.5, 0, 0},
    {"glass alpha=.5 wall=thin", GGX, .5, .5, 1.5, 1, 0},
    {"glass alpha=.4 wall=thin ior=.7 ndf=beckmann g2=separable", BECKMANN, .4, .4, .7, 1, 1},
};
enum { N_CASES = sizeof cases/sizeof cases[0], N_DRAWS = 1500 };

/* ---- The second method ----------------------------------------------------------------------------------------- */

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* D(m), eqs. 25 (Beckmann), 30 (Phong), 33 (GGX); with two roughnesses, tan^2 is split over the azimuth. */
static double normals(const interface_case *c, const double m[3])
{
    if (!(m[2] > 0)) return 0;
    const double theta = atan2(hypot(m[0], m[1]), m[2]), phi = atan2(m[1], m[0]);
    const double a2 = c->alpha_x*c->alpha_x;
    const double area = PI*c->alpha_x*c->alpha_y*pow(cos(theta), 4);
    const double x = tan(theta)*cos(phi)/c->alpha_x, y = tan(theta)*sin(phi)/c->alpha_y;
    switch (c->shape) {
    case GGX: return 1/(area*(1 + x*x + y*y)*(1 + x*x + y*y));
    case BECKMANN: return exp(-x*x - y*y)/area;
    case PHONG: return 2/a2/(2*PI)*pow(cos(theta), 2/a2 - 2);
    case GTR_3_2: /* Disney 2012, (1), gamma 3/2 */
        return 0.5*(a2 - 1)/(PI*(1 - pow(a2, -0.5)))*pow(1 + (a2 - 1)*cos(theta)*cos(theta), -1.5);
    }
    return 0;
}

/* Smith's Lambda; Phong's and GTR's are the library's, which have tests of their own. */
static double Lambda(const interface_case *c, const any_bsdf *bsdf, const double v[3])
{
    const double theta = acos(fabs(v[2])), phi = atan2(v[1], v[0]);
    const double a = 1/(tan(theta)*hypot(c->alpha_x*cos(phi), c->alpha_y*sin(phi)));
    if (c->shape == GGX) return (sqrt(1 + 1/(a*a)) - 1)/2;
    if (c->shape == BECKMANN) return fmax((erf(a) - 1)/2 + exp(-a*a)/(2*a*sqrt(PI)), 0);
    return facet_bsdf64_terms(&bsdf->twice, (double[3]){v[0], v[1], fabs(v[2])}).Lambda;
}

/* Int_0^1 u^Lo u^Li du, or u^Lo (1 - u)^Li for directions on two sides: u is the share of the surface that lies below a
 * facet, and u^Lambda the probability that nothing is in the way of a direction above. */
static double masking_by_heights(double Lambda_o, double Lambda_i, int is_bent, int is_separable)
{
    static quadrature rule;
    if (!rule.n) rule = unit_interval(1.0/24);
    if (is_separable) return 1/((1 + Lambda_o)*(1 + Lambda_i));
    double sum = 0;
    for (int k = 0; k < rule.n; k++)
        sum += rule.w[k]*pow(rule.x[k], Lambda_o)*pow(is_bent ? 1 - rule.x[k] : rule.x[k], Lambda_i);
    return sum;
}

/* The same with libm's gamma function. */
static double masking(double Lambda_o, double Lambda_i, int is_bent, int is_separable)
{
    if (is_separable) return 1/((1 + Lambda_o)*(1 + Lambda_i));
    if (!is_bent) return 1/(1 + Lambda_o + Lambda_i);
    return exp(lgamma(1 + Lambda_o) + lgamma(1 + Lambda_i) - lgamma(2 + Lambda_o + Lambda_i));
}

/* Eq. 22 for the cosine c on the side from which eta = n_t/n_i is counted. */
static double fresnel(double c, double eta)
{
    const double g2 = eta*eta - 1 + c*c;
    if (g2 <= 0) return 1;
    const double g = sqrt(g2), a = (g - c)/(g + c), b = (c*(g + c) - 1)/(c*(g - c) + 1);
    return 0.5*a*a*(1 + b*b);
}

/* f |i.n|, eqs. 20 and 21; i and o on either side.  grazing: the least cosine with the facet; for
 * reflections the root in Fresnel's term. */
static double scattered(const interface_case *c, const any_bsdf *bsdf, const double i[3], const double o[3],
                        double *grazing)
{
    const double n_i = i[2] > 0 ? 1 : c->ior, n_o = o[2] > 0 ? 1 : c->ior; /* outside, inside */
    const int is_reflected = i[2]*o[2] > 0;
    const double L_o = Lambda(c, bsdf, o), L_i = Lambda(c, bsdf, i);
    double h[3];
    if (is_reflected || c->is_thin) {
        const double mirrored[3] = {i[0], i[1], o[2] > 0 ? fabs(i[2]) : -fabs(i[2])};
        for (int k = 0; k < 3; k++) h[k] = mirrored[k] + o[k]; /* eq. 13 */
        const double length = sqrt(dot(h, h)), side = h[2] > 0 ? 1 : -1;
        for (int k = 0; k < 3; k++) h[k] *= side/length;
        const double eta = c->is_thin || o[2] > 0 ? c->ior : 1/c->ior, o_m = fabs(dot(o, h)), one = fresnel(o_m, eta);
        *grazing = fmin(sqrt(fabs(eta*eta - 1 + o_m*o_m)), 1);
        const double F = c->is_thin ? 2*one/(1 + one) : one;
        return (is_reflected ? F : 1 - F)*masking_by_heights(L_o, L_i, 0, c->is_separable)*normals(c, h)/
               (4*fabs(o[2]));
    }
    for (int k = 0; k < 3; k++) h[k] = -(n_i*i[k] + n_o*o[k]); /* eq. 16 */
    const double length = sqrt(dot(h, h)), side = h[2] > 0 ? 1 : -1;
    for (int k = 0; k < 3; k++) h[k] *= side/length;
    const double i_h = dot(i, h), o_h = dot(o, h);
    *grazing = fmin(fabs(i_h), fabs(o_h));
    if (!(i_h*i[2] > 0 && o_h*o[2] > 0)) return 0; /* chi+ in G1, eq. 34 */
    const double F = fresnel(fabs(i_h), n_o/n_i), G = masking_by_heights(L_o, L_i, 1, c->is_separable);
    const double root = n_i*i_h + n_o*o_h;
    return fabs(i_h*o_h)/fabs(o[2])*n_o*n_o*(1 - F)*G*normals(c, h)/(root*root);
}

/* ---- Values ---------------------------------------------------------------------------------------------------- */

/* A direction on either side whose cosine is at least 1/100 in size; away from it, masking is tested elsewhere. */
static void draw_either(draws *d, double v[3])
{
    do draw_direction(d, v);
    while (v[2] < 0.01);
    if (draw(d) < 0.5) v[2] = -v[2];
}

/* eval of both precisions against the second method.  In units of eps: the half vector wo + eta wi loses the digits
 * that eta shares with 1, and D answers with the slope over alpha^2.  A refraction vanishes with the square of the
 * cosine at which a facet is grazed, which has the rounding of the directions; the second method's 1 - F, from one side
 * only, takes it from a root whose radicand is the square of that cosine, in double. */
static void eval_follows_walter(void **state)
{
    (void)state;
    double worst[2] = {0};
    for (int n = 0; n < N_CASES; n++) {
        const interface_case *c = &cases[n];
        int n_through = 0;
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(c->spec, is_double);
            const double least = fmin(c->alpha_x, c->alpha_y), bend = fmin(1, fabs(c->ior - 1)/fmax(c->ior, 1));
            const double base = 64/(least*bend*least);
            draws random = {(uint64_t)n};
            for (int k = 0; k < N_DRAWS; k++) {
                double wi[3], wo[3], f[3];
                draw_either(&random, wi);
                draw_either(&random, wo);
                if (k%2) { /* where light goes */
                    const double u[3] = {draw(&random), draw(&random), draw(&random)};
                    const facet_sample64 s = any_sample(&bsdf, wo, u);
                    if (s.pdf > 0 && fabs(s.wi[2]) > 0.01) memcpy(wi, s.wi, sizeof wi);
                }
                any_eval(&bsdf, wi, wo, f);
                double grazing;
                const double want = scattered(c, &bsdf, wi, wo, &grazing);
                const double bound = any_epsilon(&bsdf)*(base + 64/grazing) + 16*0x1p-52/(grazing*grazing);
                n_through += want > 0 && wi[2]*wo[2] < 0;
                const double error = fabs(f[0] - want)/fmax(want, 1e-3);
                worst[is_double] = fmax(worst[is_double], error/bound);
                if (!(error <= bound))
                    fail_msg("%s, %s, wi (%a, %a, %a), wo (%a, %a, %a): %.17g, not %.17g", c->spec,
                             is_double ? "double" : "float", wi[0], wi[1], wi[2], wo[0], wo[1], wo[2], f[0], want);
            }
        }
        assert_true(n_through > N_DRAWS/10);
    }
    print_message("  largest deviation: %.2g and %.2g of the bound (float, double)\n", worst[0], worst[1]);
}

/* n_i^2 f(wi,wo) = n_o^2 f(wo,wi): energy that goes either way loses the same.  A thin wall has the same index on both
 * sides. */
static void radiance_over_the_index_squared_is_reciprocal(void **state)
{
    (void)state;
    for (int n = 0; n < N_CASES; n++) {
        const any_bsdf bsdf = any_bsdf_of(cases[n].spec, 1);
        draws random = {(uint64_t)(100 + n)};
        for (int k = 0; k < N_DRAWS; k++) {
            double wi[3], wo[3], forth[3], back[3];
            draw_either(&random, wi);
            draw_either(&random, wo);
            any_eval(&bsdf, wi, wo, forth);
            any_eval(&bsdf, wo, wi, back);
            const double inside = cases[n].is_thin ? 1 : cases[n].ior;
            const double n_i = wi[2] > 0 ? 1 : inside, n_o = wo[2] > 0 ? 1 : inside;
            const double a = n_i*n_i*forth[0]*fabs(wo[2]), b = n_o*n_o*back[0]*fabs(wi[2]);
            if (!(fabs(a - b) <= 1e-10*fmax(fmax(a, b), 1e-6)))
                fail_msg("%s, wi (%a, %a, %a), wo (%a, %a, %a): %a and %a", bsdf.spec, wi[0], wi[1], wi[2], wo[0],
                         wo[1], wo[2], a, b);
        }
    }
}

/* A refraction is a sum of the length eta, its product and its normalisation: 6 eps over eta. */
static void weight_is_eval_over_pdf(void **state)
{
    (void)state;
    for (int n = 0; n < N_CASES; n++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(cases[n].spec, is_double);
            draws random = {(uint64_t)(200 + n)};
            int seen = 0;
            for (int k = 0; k < N_DRAWS; k++) {
                double wo[3];
                draw_either(&random, wo);
                const double u[3] = {draw(&random), draw(&random), draw(&random)};
                const facet_sample64 s = weight_check(&bsdf, wo, u, 6*fmax(cases[n].ior, 1/cases[n].ior));
                if (s.pdf == 0) continue;
                seen |= s.lobe;
                const int is_through = wo[2]*s.wi[2] < 0;
                const double eta = is_through && !cases[n].is_thin ? (wo[2] > 0 ? cases[n].ior : 1/cases[n].ior) : 1;
                const double length = sqrt(dot(s.wi, s.wi));
                if (!(fabs(s.eta/eta - 1) <= any_epsilon(&bsdf) && fabs(length - 1) <= 16*any_epsilon(&bsdf) &&
                      !!(s.lobe & FACET_TRANSMISSION) == is_through))
                    fail_msg("%s, wo (%a, %a, %a): wi (%a, %a, %a), eta %a, lobe %d", bsdf.spec, wo[0], wo[1], wo[2],
                             s.wi[0], s.wi[1], s.wi[2], s.eta, s.lobe);
            }
            assert_int_equal(seen, FACET_REFLECTION | FACET_TRANSMISSION | FACET_GLOSSY);
        }
}

/* ---- Energy ---------------------------------------------------------------------------------------------------- */

typedef struct view {
    const interface_case *c;
    const any_bsdf *bsdf;
    double wo[3];
} view;

static double pdf_at(double cos_i, double phi, const void *context)
{
    const view *v = context;
    double wi[3];
    any_direction(cos_i, phi, wi);
    return facet_bsdf64_pdf(&v->bsdf->twice, wi, v->wo);
}

/* What leaves as power: radiance times the square of the index on the light's side over the viewer's. */
static double power_at(double cos_i, double phi, const void *context)
{
    const view *v = context;
    double wi[3], f[3];
    any_direction(cos_i, phi, wi);
    facet_bsdf64_eval(&v->bsdf->twice, wi, v->wo, f);
    const double eta = v->wo[2] > 0 ? v->c->ior : 1/v->c->ior;
    return f[0]*(cos_i*v->wo[2] < 0 && !v->c->is_thin ? eta*eta : 1);
}

/* By facets instead of by directions: the normal (theta, phi), seen from wo, reflects F and refracts 1 - F.  Returns
 * its share of what is seen, D (wo.m)/sigma; `kept` tells the part that leaves on the right side, and `power` that part
 * times G2/G1(wo). */
static double facet_at(const view *v, double theta, double phi, double *kept, double *power)
{
    const interface_case *c = v->c;
    const double side = v->wo[2] > 0 ? 1 : -1, eta = c->is_thin || side > 0 ? c->ior : 1/c->ior;
    const double o[3] = {side*v->wo[0], side*v->wo[1], side*v->wo[2]};
    const double m[3] = {sin(theta)*cos(phi), sin(theta)*sin(phi), cos(theta)};
    const double o_m = dot(o, m), L_o = Lambda(c, v->bsdf, o);
    *kept = *power = 0;
    if (!(o_m > 0)) return 0;
    const double seen = normals(c, m)*o_m/(o[2]*(1 + L_o))*sin(theta);
    const double F1 = fresnel(o_m, eta), F = c->is_thin ? 2*F1/(1 + F1) : F1;
    double r[3], t[3];
    const double cos_t = sqrt(fmax(1 - (1 - o_m*o_m)/(eta*eta), 0));
    for (int k = 0; k < 3; k++) {
        r[k] = 2*o_m*m[k] - o[k];
        t[k] = (o_m/eta - cos_t)*m[k] - o[k]/eta; /* eq. 40 */
    }
    const double leaving = c->is_thin ? -r[2] : t[2];
    if (r[2] > 0) {
        *kept += seen*F;
        *power += seen*F*(1 + L_o)*masking(L_o, Lambda(c, v->bsdf, r), 0, c->is_separable);
    }
    if (leaving < 0 && F < 1) {
        const double L_i = Lambda(c, v->bsdf, c->is_thin ? r : t);
        *kept += seen*(1 - F);
        *power += seen*(1 - F)*(1 + L_o)*masking(L_o, L_i, !c->is_thin, c->is_separable);
    }
    return seen;
}

static double seen_at(double theta, double phi, const void *context)
{
    double kept, power;
    return facet_at(context, theta, phi, &kept, &power);
}

static double kept_at(double theta, double phi, const void *context)
{
    double kept, power;
    facet_at(context, theta, phi, &kept, &power);
    return kept;
}

static double emitted_at(double theta, double phi, const void *context)
{
    double kept, power;
    facet_at(context, theta, phi, &kept, &power);
    return power;
}

static double over_sphere(plane_function f, const view *v)
{
    const double low[2] = {-1, -PI}, middle[2] = {0, PI}, high[2] = {1, PI};
    return cubature(f, v, low, middle, 2e-5, 3) + cubature(f, v, (double[2]){0, -PI}, high, 2e-5, 3);
}

static double over_facets(plane_function f, const view *v)
{
    return cubature(f, v, (double[2]){0, -PI}, (double[2]){PI/2, PI}, 2e-5, 3);
}

/* Per direction of view: the facets seen make up what is seen (the weak white furnace); the sampler finds those that
 * scatter to the right side, and loses the rest; and what the interface reflects and transmits is what its facets do,
 * less what is masked: never more than all.  The integrands have kinks and steps, at which the cubature stops short of
 * its tolerance: 2e-4 holds them. */
static void no_energy_is_made_and_none_lost_but_by_masking(void **state)
{
    (void)state;
    static const int chosen[] = {0, 2, 10};
    static const double cosines[] = {.9, .3, -.9};
    for (int n = 0; n < 3; n++) {
        const interface_case *c = &cases[chosen[n]];
        const any_bsdf bsdf = any_bsdf_of(c->spec, 1);
        for (int k = 0; k < 3; k++) {
            view v = {.c = c, .bsdf = &bsdf};
            any_direction(cosines[k], 1, v.wo);
            const double seen = over_facets(seen_at, &v), kept = over_facets(kept_at, &v),
                         power = over_facets(emitted_at, &v);
            const double drawn = over_sphere(pdf_at, &v), albedo = over_sphere(power_at, &v);
            print_message("  %-48s cos_o %4g: drawn %.5f, albedo %.5f\n", c->spec, cosines[k], drawn, albedo);
            const double worst = fmax(fabs(seen - 1), fmax(fabs(drawn - kept), fabs(albedo - power)));
            if (!(worst <= 2e-4 && albedo <= 1 && albedo > 0.3))
                fail_msg("%s, cos_o %g: seen %.6f, drawn %.6f of %.6f, albedo %.6f of %.6f", c->spec, cosines[k], seen,
                         drawn, kept, albedo, power);
        }
    }
}

/* With visible normals a sample weighs G2/G1(wo), over the square of the index where it goes through: at most 1. */
static void visible_normals_never_gain(void **state)
{
    (void)state;
    static const char *const specs[] = {"glass alpha=1e-4",
                                        "glass alpha=.3 ior=2",
                                        "glass alpha=1 ior=.1 g2=separable",
                                        "glass alpha_x=1 alpha_y=.01 ndf=beckmann ior=10",
                                        "glass exponent=3 ndf=phong",
                                        "glass alpha=1 wall=thin",
                                        "glass alpha=1 ior=1.0001"};
    for (size_t n = 0; n < sizeof specs/sizeof specs[0]; n++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(specs[n], is_double);
            draws random = {n};
            double sum = 0;
            for (int k = 0; k < N_DRAWS; k++) {
                double wo[3];
                draw_direction(&random, wo);
                if (k%2) wo[2] = -wo[2];
                const double u[3] = {draw(&random), draw(&random), draw(&random)};
                const facet_sample64 s = any_sample(&bsdf, wo, u);
                sum += s.weight[0];
                if (!(s.weight[0]*s.eta*s.eta <= 1 + 16*any_epsilon(&bsdf)))
                    fail_msg("%s, wo (%a, %a, %a), u (%a, %a, %a): weight %a", specs[n], wo[0], wo[1], wo[2], u[0],
                             u[1], u[2], s.weight[0]*s.eta*s.eta);
            }
            assert_true(sum > 0);
        }
}

/* ---- Limits ---------------------------------------------------------------------------------------------------- */

/* With alpha = 1e-4 and u[0] < .9, normals lie within 3e-4 of n, which turns wi by no more than ten times that at these
 * cosines; weights are off by what is masked, below 1e-6, and, where all normals are drawn, by the quotient
 * (wo.m)/(cos_o cos_m), at most 3e-4 tan. */
static void the_smoothest_rough_glass_is_nearly_smooth(void **state)
{
    (void)state;
    static const char *const extras[] = {"", "ior=.8", "ior=2.5 ndf=beckmann", "wall=thin", "ndf=phong g2=separable"};
    for (int n = 0; n < 5; n++)
        for (int is_double = 0; is_double < 2; is_double++) {
            char spec[100];
            snprintf(spec, sizeof spec, "glass alpha=1e-4 %s", extras[n]);
            const any_bsdf rough = any_bsdf_of(spec, is_double);
            snprintf(spec, sizeof spec, "glass alpha=9e-5 %s", extras[n]);
            const any_bsdf smooth = any_bsdf_of(spec, is_double);
            assert_int_equal(facet_bsdf_lobes(&smooth.single), FACET_REFLECTION | FACET_TRANSMISSION | FACET_DELTA);
            draws random = {(uint64_t)n};
            int n_compared = 0;
            for (int k = 0; k < N_DRAWS; k++) {
                double wo[3];
                draw_direction(&random, wo);
                if (wo[2] < 0.3) continue;
                if (k%2) wo[2] = -wo[2];
                const double u[3] = {0.05 + 0.85*draw(&random), 0.1 + 0.8*draw(&random), draw(&random)};
                const facet_sample64 a = any_sample(&rough, wo, u), b = any_sample(&smooth, wo, u);
                if ((a.lobe ^ b.lobe) & FACET_REFLECTION) continue; /* u[2] between the two F */
                double apart = 0;
                for (int j = 0; j < 3; j++) apart = fmax(apart, fabs(a.wi[j] - b.wi[j]));
                if (fabs(b.wi[2]) < 0.2) continue; /* Snell's law is steep there */
                n_compared++;
                if (!(apart <= 3e-3 && fabs(a.weight[0]/b.weight[0] - 1) <= 1e-3 && a.eta == b.eta))
                    fail_msg("%s, wo (%a, %a, %a), u (%a, %a, %a): wi off by %g, weights %a, %a", spec, wo[0], wo[1],
                             wo[2], u[0], u[1], u[2], apart, a.weight[0], b.weight[0]);
            }
            assert_true(n_compared > N_DRAWS/3);
        }
}

static void without_an_index_light_goes_straight_through(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf none = any_bsdf_of("glass ior=1 alpha=.5 tint=.25", is_double);
        const any_bsdf little = any_bsdf_of("glass ior=1.0001 alpha=.5", is_double);
        draws random = {7};
        for (int k = 0; k < N_DRAWS; k++) {
            double wo[3];
            draw_either(&random, wo);
            const double u[3] = {draw(&random), draw(&random), draw(&random)};
            const facet_sample64 s = any_sample(&none, wo, u), t = any_sample(&little, wo, u);
            for (int j = 0; j < 3; j++) {
                const double straight = is_double ? -wo[j] : -(double)(float)wo[j];
                if (!(fabs(s.wi[j] - straight) <= 2*any_epsilon(&none)/fabs(wo[2]) &&
                      fabs(s.weight[j] - 0.25) <= any_epsilon(&none) && s.pdf == 1))
                    fail_msg("wo (%a, %a, %a): wi (%a, %a, %a), pdf %a", wo[0], wo[1], wo[2], s.wi[0], s.wi[1], s.wi[2],
                             s.pdf);
                /* No facet turns light by more than the complement of the critical angle, .01414. */
                if (t.pdf > 0 && t.lobe & FACET_TRANSMISSION && dot(t.wi, wo) > -0.9998)
                    fail_msg("wo (%a, %a, %a): wi (%a, %a, %a)", wo[0], wo[1], wo[2], t.wi[0], t.wi[1], t.wi[2]);
            }
        }
    }
}

/* Inside, beyond the critical angle of every facet that is nearly flat, nothing gets out. */
static void total_reflection_is_total(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf bsdf = any_bsdf_of("glass alpha=1e-3 ndf=beckmann", is_double);
        draws random = {9};
        for (int k = 0; k < N_DRAWS; k++) {
            double wo[3];
            any_direction(-0.1 - 0.6*draw(&random), 6*draw(&random), wo); /* critical: .745 */
            const double u[3] = {draw(&random), draw(&random), draw(&random)};
            const facet_sample64 s = any_sample(&bsdf, wo, u);
            assert_true(s.pdf > 0 && s.lobe == (FACET_REFLECTION | FACET_GLOSSY) && s.wi[2] < 0 && s.eta == 1);
            assert_true(s.weight[0] > 0.9 && s.weight[0] <= 1 + 16*any_epsilon(&bsdf));
        }
    }
}

static void a_thin_wall_mirrors_its_reflection(void **state)
{
    (void)state;
    const any_bsdf bsdf = any_bsdf_of("glass alpha=.4 wall=thin tint=.5,.25,1", 1);
    draws random = {11};
    for (int k = 0; k < N_DRAWS; k++) {
        double wi[3], wo[3], there[3], here[3];
        draw_either(&random, wi);
        draw_either(&random, wo);
        const double other[3] = {wi[0], wi[1], -wi[2]};
        any_eval(&bsdf, wi, wo, wi[2]*wo[2] > 0 ? here : there);
        any_eval(&bsdf, other, wo, wi[2]*wo[2] > 0 ? there : here);
        /* here = F' X, there = tint (1 - F') X: the tint is out of it, and F' is that of the angle between */
        const double same[3] = {wi[0], wi[1], wi[2]*wo[2] > 0 ? wi[2] : -wi[2]};
        const double F = fresnel(sqrt(0.5*(1 + dot(same, wo))), 1.5), both = 2*F/(1 + F);
        for (int j = 0; j < 3; j++) {
            const double want = here[j]*(1 - both)/both*(double[3]){.5, .25, 1}[j];
            if (!(fabs(there[j] - want) <= 1e-12*fmax(want, 1e-3)/both))
                fail_msg("through %a, not %a", there[j], want);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eval_follows_walter),
        cmocka_unit_test(radiance_over_the_index_squared_is_reciprocal),
        cmocka_unit_test(weight_is_eval_over_pdf),
        cmocka_unit_test(no_energy_is_made_and_none_lost_but_by_masking),
        cmocka_unit_test(visible_normals_never_gain),
        cmocka_unit_test(the_smoothest_rough_glass_is_nearly_smooth),
        cmocka_unit_test(without_an_index_light_goes_straight_through),
        cmocka_unit_test(total_reflection_is_total),
        cmocka_unit_test(a_thin_wall_mirrors_its_reflection),
    };
    return cmocka_run_group_tests_name("rough_glass", tests, NULL, NULL);
}
