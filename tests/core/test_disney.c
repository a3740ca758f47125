/* test_disney.c: Disney's principled model against a second transcription of the notes, in angles and double
 * precision, and what its lobes promise.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define FACET_REAL_IS_DOUBLE 1
#include "core/kernel/gtr1.h"

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "verify/quadrature.h"

enum {
    RED,
    GREEN,
    BLUE,
    SUBSURFACE,
    METALLIC,
    SPECULAR,
    SPECULAR_TINT,
    ROUGHNESS,
    ANISOTROPIC,
    SHEEN,
    SHEEN_TINT,
    CLEARCOAT,
    CLEARCOAT_GLOSS,
    N_VALUES
};

typedef struct principled {
    double value[N_VALUES];
    int is_exact, is_separable; /* coat_masking, g2 */
} principled;

static any_bsdf bsdf_of(const principled *m, int is_double)
{
    static const char *const names[] = {"subsurface",  "metallic", "specular",   "specular_tint", "roughness",
                                        "anisotropic", "sheen",    "sheen_tint", "clearcoat",     "clearcoat_gloss"};
    facet_material material;
    assert_int_equal(facet_material_defaults("disney", &material, NULL), FACET_OK);
    assert_int_equal(facet_material_set(&material, "base_color", m->value, 3, NULL), FACET_OK);
    for (int k = SUBSURFACE; k < N_VALUES; k++)
        assert_int_equal(facet_material_set(&material, names[k - SUBSURFACE], &m->value[k], 1, NULL), FACET_OK);
    assert_int_equal(facet_material_set(&material, "coat_masking", &(double){m->is_exact}, 1, NULL), FACET_OK);
    assert_int_equal(facet_material_set(&material, "g2", &(double){m->is_separable}, 1, NULL), FACET_OK);
    any_bsdf bsdf = {.is_double = is_double};
    snprintf(bsdf.spec, sizeof bsdf.spec, "disney");
    assert_int_equal(facet_bsdf_prepare(&material, &bsdf.single, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&material, &bsdf.twice, NULL), FACET_OK);
    return bsdf;
}

/* ---- The notes, in angles ----------------------------------------------------------------------- */

/* (10), with alpha_x = roughness^2/aspect and alpha_y = roughness^2 aspect. */
static double D_GTR2_aniso(double theta, double phi, double ax, double ay)
{
    const double bracket = cos(phi)*cos(phi)/(ax*ax) + sin(phi)*sin(phi)/(ay*ay);
    return 1/(PI*ax*ay*pow(sin(theta)*sin(theta)*bracket + cos(theta)*cos(theta), 2));
}

/* (4) */
static double D_GTR1(double theta, double alpha)
{
    return (alpha*alpha - 1)/(PI*log(alpha*alpha))/
           (sin(theta)*sin(theta) + alpha*alpha*cos(theta)*cos(theta));
}

/* Smith's Lambda of GGX; Heitz 2014, with the roughness toward phi. */
static double Lambda_GGX(double theta, double phi, double ax, double ay)
{
    const double toward = pow(ax*cos(phi), 2) + pow(ay*sin(phi), 2);
    return (sqrt(1 + toward*pow(tan(theta), 2)) - 1)/2;
}

/* ... of GTR1: the mean of GGX's over alpha log-uniform in [alpha, 1], by quadrature. */
static double Lambda_GTR1(double theta, double alpha)
{
    static quadrature rule;
    if (rule.n == 0) rule = gauss_legendre(80, 0, 1);
    double sum = 0;
    for (int i = 0; i < rule.n; i++) {
        const double s = pow(alpha, rule.x[i]);
        sum += rule.w[i]*Lambda_GGX(theta, 0, s, s);
    }
    return sum;
}

static double G2_of(double Lambda_i, double Lambda_o, int is_separable)
{
    return is_separable ? 1/(1 + Lambda_i)/(1 + Lambda_o) : 1/(1 + Lambda_i + Lambda_o);
}

static double blend(double a, double b, double t)
{
    return a + (b - a)*t;
}

/* Polar angle and azimuth of a vector. */
static void angles_of(const double v[3], double *theta, double *phi)
{
    *theta = atan2(hypot(v[0], v[1]), v[2]);
    *phi = atan2(v[1], v[0]);
}

enum { DIFFUSE_TERM, SHEEN_TERM, SPECULAR_TERM, COAT_TERM, N_TERMS };

/* The four lobes of f, one colour channel. */
static void lobes_of_notes(const principled *m, const double wi[3], const double wo[3], int channel,
                           double lobes[N_TERMS])
{
    const double *v = m->value;
    double theta_i, phi_i, theta_o, phi_o, theta_h, phi_h;
    double h[3], d[3];
    for (int k = 0; k < 3; k++) {
        h[k] = wi[k] + wo[k];
        d[k] = wi[k] - wo[k];
    }
    angles_of(wi, &theta_i, &phi_i);
    angles_of(wo, &theta_o, &phi_o);
    angles_of(h, &theta_h, &phi_h);
    const double theta_d = atan2(hypot(hypot(d[0], d[1]), d[2]), hypot(hypot(h[0], h[1]), h[2]));
    const double base = v[RED + channel], luminance = .3*v[RED] + .6*v[GREEN] + .1*v[BLUE];
    const double tint = luminance > 0 ? base/luminance : 1;
    const double FL = pow(1 - cos(theta_i), 5), FV = pow(1 - cos(theta_o), 5);
    const double FH = pow(2*pow(sin(theta_d/2), 2), 5);
    const double cos2_d = pow(cos(theta_d), 2);

    const double FD90 = .5 + 2*v[ROUGHNESS]*cos2_d, Fss90 = v[ROUGHNESS]*cos2_d;
    const double Fd = blend(1, FD90, FL)*blend(1, FD90, FV);
    const double Fss = blend(1, Fss90, FL)*blend(1, Fss90, FV);
    const double ss = 1.25*(Fss*(1/(cos(theta_i) + cos(theta_o)) - .5) + .5);
    lobes[DIFFUSE_TERM] = (1 - v[METALLIC])*base/PI*blend(Fd, ss, v[SUBSURFACE]);

    lobes[SHEEN_TERM] = (1 - v[METALLIC])*v[SHEEN]*blend(1, tint, v[SHEEN_TINT])*FH;

    const double aspect = sqrt(1 - .9*v[ANISOTROPIC]);
    const double ax = pow(v[ROUGHNESS], 2)/aspect, ay = pow(v[ROUGHNESS], 2)*aspect;
    const double Cspec0 = blend(.08*v[SPECULAR]*blend(1, tint, v[SPECULAR_TINT]), base, v[METALLIC]);
    const double Gs = G2_of(Lambda_GGX(theta_i, phi_i, ax, ay), Lambda_GGX(theta_o, phi_o, ax, ay), m->is_separable);
    lobes[SPECULAR_TERM] = D_GTR2_aniso(theta_h, phi_h, ax, ay)*Gs*blend(Cspec0, 1, FH)/
                           (4*cos(theta_i)*cos(theta_o));

    const double ac = blend(.1, .001, v[CLEARCOAT_GLOSS]);
    const double Gr = m->is_exact ? G2_of(Lambda_GTR1(theta_i, ac), Lambda_GTR1(theta_o, ac), m->is_separable)
                                  : G2_of(Lambda_GGX(theta_i, 0, .25, .25), Lambda_GGX(theta_o, 0, .25, .25), 1);
    lobes[COAT_TERM] = .25*v[CLEARCOAT]*D_GTR1(theta_h, ac)*Gr*blend(.04, 1, FH)/
                       (4*cos(theta_i)*cos(theta_o));
}

/* Any corner or point inside, with alpha_y above its least value: roughness^2 sqrt(.1) > 1e-4. */
static principled draw_material(draws *d)
{
    principled m;
    for (int k = 0; k < N_VALUES; k++) {
        const uint64_t corner = draw_bits(d)%6;
        m.value[k] = corner == 0 ? 0 : (corner == 1 ? 1 : draw(d));
    }
    m.value[ROUGHNESS] = draw_log(d, .02, 1);
    m.is_exact = draw_bits(d)%2;
    m.is_separable = draw_bits(d)%2;
    return m;
}

static void fail_lobes(const principled *m, const double wi[3], const double wo[3], const double lobes[N_TERMS],
                       double got, double want)
{
    for (int k = 0; k < N_VALUES; k++) print_message("  parameter %d: %a\n", k, m->value[k]);
    fail_msg("exact %d, separable %d, wi (%a, %a, %a), wo (%a, %a, %a): eval %a, not %a; diffuse %g, sheen %g, "
             "specular %g, coat %g",
             m->is_exact, m->is_separable, wi[0], wi[1], wi[2], wo[0], wo[1], wo[2], got, want, lobes[DIFFUSE_TERM],
             lobes[SHEEN_TERM], lobes[SPECULAR_TERM], lobes[COAT_TERM]);
}

/* Half of the directions at the mirror's or back at the viewer, within a tenth, where each lobe has its say.  The
 * half vector is off by eps/|wi + wo|, which D takes times 4 tan(theta_h)/(tan^2 + alpha^2) <= 2/alpha, alpha the least
 * of the two lobes'; other terms lose 64 eps in all, and the parameters 4 eps. */
static void lobes_are_those_of_the_notes(void **state)
{
    (void)state;
    draws random = {5};
    for (int n = 0; n < 20000; n++) {
        const principled m = draw_material(&random);
        double wi[3], wo[3];
        draw_direction(&random, wo);
        draw_direction(&random, wi);
        const double side = n%4 == 0 ? -1 : 1;
        if (n%2 == 0) {
            for (int k = 0; k < 3; k++) wi[k] = 0.1*draw(&random)*wi[k] + (k < 2 ? side : 1)*wo[k];
            const double length = hypot(hypot(wi[0], wi[1]), wi[2]);
            for (int k = 0; k < 3; k++) wi[k] /= length;
        }
        const double ay = pow(m.value[ROUGHNESS], 2)*sqrt(1 - .9*m.value[ANISOTROPIC]);
        const double ac = blend(.1, .001, m.value[CLEARCOAT_GLOSS]);
        const double least = m.value[CLEARCOAT] > 0 ? fmin(ay, ac) : ay;
        const double sum = hypot(hypot(wi[0] + wo[0], wi[1] + wo[1]), wi[2] + wo[2]);
        for (int is_double = 1; is_double >= 0; is_double--) {
            const any_bsdf bsdf = bsdf_of(&m, is_double);
            double f[3], lobes[N_TERMS];
            if (!is_double) { /* volatile: gcc 12 at -O2 drops the rounding */
                for (int k = 0; k < 3; k++) {
                    const volatile float in = (float)wi[k], out = (float)wo[k];
                    wi[k] = (double)in;
                    wo[k] = (double)out;
                }
            }
            any_eval(&bsdf, wi, wo, f);
            for (int c = 0; c < 3; c++) {
                lobes_of_notes(&m, wi, wo, c, lobes);
                const double want = wi[2]*(lobes[0] + lobes[1] + lobes[2] + lobes[3]);
                const double bound = any_epsilon(&bsdf)*(68 + 4/(least*sum));
                if (!(fabs(f[c] - want) <= bound*want)) fail_lobes(&m, wi, wo, lobes, f[c], want);
            }
        }
    }
}

/* ---- The clearcoat's masking -------------------------------------------------------------------- */

/* Int D (v.m)+ d omega_m / cos_v of GTR1, (4), over the azimuth in closed form and over r = tan(theta_m) below and
 * above the slope mu of the view, beyond which part of the normals face away. */
static double projected_area(double alpha, double theta)
{
    const double mu = 1/tan(theta);
    const quadrature below = unit_interval(1.0/32), above = half_line(1.0/32);
    double sum = 0;
    for (int i = 0; i < below.n; i++) {
        const double r = mu*below.x[i];
        sum += mu*below.w[i]*D_GTR1(atan(r), alpha)*2*PI*r/pow(1 + r*r, 2);
    }
    for (int i = 0; i < above.n; i++) {
        const double r = mu*(1 + above.x[i]);
        const double edge = 1/(1 + above.x[i]); /* mu/r, minus the cosine of the azimuth where v.m = 0 */
        const double sine = sqrt(above.x[i]*(2 + above.x[i]))*edge, reach = PI - atan2(sine, edge);
        sum += mu*above.w[i]*D_GTR1(atan(r), alpha)*2*(reach + sine/edge)*r/pow(1 + r*r, 2);
    }
    return sum;
}

/* The masking the product uses: black base, no specular reflectance, light straight back, so that FH is 0 and all there
 * is is clearcoat/4 D G1^2 F0/(4 cos). */
static double coat_G1(double alpha, double theta, int is_exact, int is_double)
{
    principled m = {.is_exact = is_exact, .is_separable = 1};
    m.value[ROUGHNESS] = 0.5;
    m.value[CLEARCOAT] = 1;
    m.value[CLEARCOAT_GLOSS] = (.1 - alpha)/.099;
    const any_bsdf bsdf = bsdf_of(&m, is_double);
    const double v[3] = {sin(theta), 0, cos(theta)};
    double f[3];
    any_eval(&bsdf, v, v, f);
    return sqrt(f[0]*4*cos(theta)/(.25*.04*D_GTR1(theta, alpha)));
}

/* The visible area of the normals is the area that they are seen from: so with GTR1's own masking, in both precisions,
 * and off by 2 to 53 % with that of the notes, a GGX of alpha .25. */
static void exact_masking_closes_the_weak_white_furnace(void **state)
{
    (void)state;
    static const double alphas[] = {.1, .03, .01, .001}, degrees[] = {10, 45, 75, 85, 89};
    static const double off[][3] = {
        {.1, 45, 1.033}, {.1, 75, 1.201}, {.1, 89, 1.525}, {.01, 75, 1.026}, {.001, 75, .9655}};
    for (int is_double = 0; is_double < 2; is_double++) {
        const double tolerance = is_double ? 1e-11 : 4e-6;
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 5; k++) {
                const double theta = degrees[k]*PI/180, area = projected_area(alphas[i], theta);
                const double exact = coat_G1(alphas[i], theta, 1, is_double)*area;
                const double adhoc = coat_G1(alphas[i], theta, 0, is_double)*(1 + Lambda_GGX(theta, 0, .25, .25));
                if (!(fabs(exact - 1) <= tolerance && fabs(adhoc - 1) <= tolerance))
                    fail_msg("alpha %g, %g degrees: exact masking sees %.14f of the area, the notes' is %.14f of it",
                             alphas[i], degrees[k], exact, adhoc);
            }
        for (int i = 0; i < 5; i++) {
            const double theta = off[i][1]*PI/180;
            const double sum = coat_G1(off[i][0], theta, 0, is_double)*projected_area(off[i][0], theta);
            if (!(fabs(sum - off[i][2]) <= 5.1e-4))
                fail_msg("alpha %g, %g degrees: the notes' masking sees %.6f of the area, not %g", off[i][0], off[i][1],
                         sum, off[i][2]);
        }
    }
}

/* At normal incidence visible normals are all normals.  The share u of them within the tangent t is, by (9) and (5),
 * t^2/(t^2 + alpha^2), and ln((1 + t^2/alpha^2)/(1 + t^2))/ln(1/alpha^2) of GTR1.  The narrowest of both lobes, on a
 * lattice of 64 x 64 points; t = |(wi.x, wi.y)|/(1 + wi.z). */
static void narrow_lobes_have_the_width_of_the_notes(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        int is_coat;
        double alpha;
    } known[] = {
        {"disney metallic=1 roughness=0", 0, 1e-4},
        {"disney metallic=1 roughness=.02", 0, 4e-4},
        {"disney metallic=1 base_color=0 clearcoat=1 clearcoat_gloss=1", 1, .001},
        {"disney metallic=1 base_color=0 clearcoat=1 clearcoat_gloss=0", 1, .1},
    };
    const double wo[3] = {0, 0, 1};
    for (int i = 0; i < 4; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(known[i].spec, is_double);
            const double a2 = known[i].alpha*known[i].alpha;
            for (double quarter = 0.25; quarter < 1; quarter += 0.25) {
                int within = 0;
                for (int k = 0; k < 64*64; k++) {
                    /* A black lobe keeps a sixteenth of u.z, the lower end; all else is the clearcoat's. */
                    const double w = known[i].is_coat ? 1 - (k/64 + 0.5)/64*15/16 : 0.5;
                    const facet_sample64 s = any_sample(&bsdf, wo, (double[3]){0.5, (k%64 + 0.5)/64, w});
                    const double t = s.pdf > 0 ? hypot(s.wi[0], s.wi[1])/(1 + s.wi[2]) : 1e9;
                    const double t2 = t*t;
                    within += (known[i].is_coat ? log((1 + t2/a2)/(1 + t2))/log(1/a2) : t2/(t2 + a2)) <
                              quarter;
                }
                if (!(fabs(within/4096.0 - quarter) <= 1.0/64))
                    fail_msg("%s: %d of 4096 normals within the first %g", known[i].spec, within, quarter);
            }
        }
}

/* v + ln v = y to the rounding of y and of v; the function is what chooses the alpha of a clearcoat's normal. */
static void the_omega_function_is_inverted(void **state)
{
    (void)state;
    draws random = {3};
    for (int n = 0; n < 20000; n++) {
        const double y = n%2 ? draw_between(&random, -80, 20) : draw_log(&random, 0.5, 0x1p60);
        const double v = wright_omega(y);
        const double bound = 2*0x1p-52*
                             (1 + fabs(y)); /* 1.5 eps of v times dy/dv v = 1 + v, and the sum's rounding */
        if (!(v > 0 && fabs(v + log(v) - y) <= bound)) fail_msg("y %a: v %a, v + ln v - y = %g", y, v, v + log(v) - y);
    }
}

/* ---- Energy -------------------------------------------------------------------------------------- */

/* Int f cos_i d omega_i of one channel over the hemisphere, for broad lobes: 96 and 200 nodes agree to 5e-5. */
static double albedo_by_rule(const any_bsdf *bsdf, double cos_o, int n, int channel)
{
    const quadrature polar = gauss_legendre(n, 0, 1), azimuth = periodic_rule(2*n, 0, 2*PI);
    double wo[3], sum = 0;
    any_direction(cos_o, 0.3, wo);
    for (int i = 0; i < polar.n; i++)
        for (int j = 0; j < azimuth.n; j++) {
            double wi[3], f[3];
            any_direction(polar.x[i], azimuth.x[j], wi);
            any_eval(bsdf, wi, wo, f);
            sum += polar.w[i]*azimuth.w[j]*f[channel];
        }
    return sum;
}

typedef struct moments {
    double mean[3], square[3], largest;
} moments;

/* Means of the weights and of their squares over a lattice of n^3 points: the albedo and the sampler's noise. */
static moments sampled(const any_bsdf *bsdf, double cos_o, double phi, int n)
{
    moments m = {.largest = 0};
    double wo[3];
    any_direction(cos_o, phi, wo);
    for (int i = 0; i < n*n*n; i++) {
        const double u[3] = {(i%n + 0.5)/n, (i/n%n + 0.5)/n, (i/(n*n) + 0.5)/n};
        const facet_sample64 s = any_sample(bsdf, wo, u);
        for (int k = 0; k < 3; k++) {
            m.mean[k] += s.weight[k]/(n*n*n);
            m.square[k] += s.weight[k]*s.weight[k]/(n*n*n);
            m.largest = fmax(m.largest, s.weight[k]);
        }
    }
    return m;
}

/* The lobes are added, so that a rough white dielectric reflects more than it receives, and a saturated one, whose tint
 * is brighter than white in its channel, three times that.  The figures of docs/models/disney.md, by both the rule and
 * the sampler, whose lattice is good to 2 %. */
static void more_is_reflected_than_received(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double cos_o, albedo;
    } known[] = {
        {"disney base_color=1", 1, 1.0426},
        {"disney base_color=1", .1, 1.1797},
        {"disney base_color=1 roughness=1 specular=1", .1, 1.4372},
        {"disney base_color=1 roughness=1 subsurface=1", .1, 1.5299},
        {"disney base_color=1 roughness=1 specular=1 sheen=1", .1, 1.5032},
        {"disney base_color=0,0,1 roughness=1 specular=1 specular_tint=1 sheen=1 sheen_tint=1", .1, 2.4891},
    };
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const any_bsdf bsdf = any_bsdf_of(known[i].spec, 1);
        const double by_rule = albedo_by_rule(&bsdf, known[i].cos_o, 96, 2);
        const double by_samples = sampled(&bsdf, known[i].cos_o, 0.3, 24).mean[2];
        if (!(fabs(by_rule - known[i].albedo) <= 1e-4 && fabs(by_samples/by_rule - 1) <= 0.02))
            fail_msg("%s, cos_o %g: albedo %.6f by the rule, %.6f by samples, not %g", known[i].spec, known[i].cos_o,
                     by_rule, by_samples, known[i].albedo);
    }
}

/* A bare white metal is a single lobe of separable masking: at most 1 per sample and in all, and 1 less
 * alpha^2/(1 + alpha^2) of the density is above the horizon at normal incidence. */
static void a_bare_metal_is_one_specular_lobe(void **state)
{
    (void)state;
    static const double roughness[] = {0.1, 0.5, 0.8, 1};
    for (int i = 0; i < 4; i++) {
        char spec[96];
        snprintf(spec, sizeof spec, "disney metallic=1 base_color=1 roughness=%g", roughness[i]);
        const any_bsdf bsdf = any_bsdf_of(spec, 1);
        assert_true(sampled(&bsdf, 0.3, 0, 16).largest <= 1 + 8*0x1p-52);
        const quadrature rule = unit_interval(1.0/32);
        const double wo[3] = {0, 0, 1}, a2 = pow(roughness[i], 4);
        double mass = 0;
        for (int k = 0; k < rule.n; k++) { /* r = tan(theta_m): d omega_i = 8 pi r/(1 + r^2)^2 dr */
            const double r = rule.x[k], r2 = r*r;
            const double wi[3] = {2*r/(1 + r2), 0, (1 - r)*(1 + r)/(1 + r2)};
            mass += rule.w[k]*any_pdf(&bsdf, wi, wo)*8*PI*r/pow(1 + r2, 2);
        }
        if (!(fabs(mass - 1/(1 + a2)) <= 1e-9)) fail_msg("%s: mass %.12f, not %.12f", spec, mass, 1/(1 + a2));
    }
}

/* Corners and points inside: the sampler's noise stays within what sheen alone, the lobe that is drawn worst, has
 * (2.3 times its albedo); a lobe left without samples would show as rare large weights. */
static void no_lobe_is_starved(void **state)
{
    (void)state;
    draws random = {11};
    double worst = 0;
    for (int n = 0; n < 400; n++) {
        const principled m = draw_material(&random);
        const any_bsdf bsdf = bsdf_of(&m, 1);
        const moments w = sampled(&bsdf, draw_log(&random, 0.01, 1), draw(&random), 10);
        for (int k = 0; k < 3; k++) {
            if (w.mean[k] < 0.02) continue;
            const double noise = sqrt(fmax(w.square[k]/(w.mean[k]*w.mean[k]) - 1, 0));
            worst = fmax(worst, noise);
            if (!(noise <= 2.6)) {
                for (int p = 0; p < N_VALUES; p++) print_message("  parameter %d: %g\n", p, m.value[p]);
                fail_msg("channel %d: albedo %g, noise %g of it, largest weight %g", k, w.mean[k], noise, w.largest);
            }
        }
    }
    print_message("  largest noise of a sample: %.2f of the albedo\n", worst);
    const any_bsdf cloth = any_bsdf_of("disney base_color=0 specular=0 roughness=1 sheen=1", 1);
    const moments w = sampled(&cloth, .3, .3, 24);
    const double noise = sqrt(w.square[0]/(w.mean[0]*w.mean[0]) - 1);
    if (!(noise <= 2.6)) fail_msg("sheen: noise %g", noise);
}

static void lobes_follow_the_parameters(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        int lobes;
    } known[] = {
        {"disney", FACET_REFLECTION | FACET_GLOSSY | FACET_DIFFUSE},
        {"disney metallic=1 sheen=1", FACET_REFLECTION | FACET_GLOSSY},
        {"disney base_color=0", FACET_REFLECTION | FACET_GLOSSY},
        {"disney base_color=0 sheen=.1", FACET_REFLECTION | FACET_GLOSSY | FACET_DIFFUSE},
        {"disney base_color=0 clearcoat=1", FACET_REFLECTION | FACET_GLOSSY},
    };
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const any_bsdf bsdf = any_bsdf_of(known[i].spec, 0);
        assert_int_equal(facet_bsdf_lobes(&bsdf.single), known[i].lobes);
        assert_int_equal(facet_bsdf64_lobes(&bsdf.twice), known[i].lobes);
    }
}

/* The sampler does not know how masking and shadowing are joined; nor does it draw from a coat that is not there. */
static void densities_are_the_same_for_both_G2(void **state)
{
    (void)state;
    draws random = {5};
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf one = any_bsdf_of("disney metallic=.5 roughness=.3 g2=correlated", is_double);
        const any_bsdf other = any_bsdf_of("disney metallic=.5 roughness=.3 g2=separable", is_double);
        for (int k = 0; k < 200; k++) {
            double wi[3], wo[3];
            draw_direction(&random, wi);
            draw_direction(&random, wo);
            assert_true(any_pdf(&one, wi, wo) == any_pdf(&other, wi, wo));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_are_those_of_the_notes),
        cmocka_unit_test(exact_masking_closes_the_weak_white_furnace),
        cmocka_unit_test(the_omega_function_is_inverted),
        cmocka_unit_test(narrow_lobes_have_the_width_of_the_notes),
        cmocka_unit_test(more_is_reflected_than_received),
        cmocka_unit_test(a_bare_metal_is_one_specular_lobe),
        cmocka_unit_test(no_lobe_is_starved),
        cmocka_unit_test(lobes_follow_the_parameters),
        cmocka_unit_test(densities_are_the_same_for_both_G2),
    };
    return cmocka_run_group_tests_name("disney", tests, NULL, NULL);
}
