/* verify.c: the checks of verify.h.
 *
 * [heitz14]  Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, JCGT 2014: the projected
 *            area (eq. 15) and the weak white furnace (eq. 84).
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.
 * SPDX-License-Identifier: MIT */
#include "verify/verify.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "verify/integrals.h"
#include "verify/sampler_density.h"
#include "verify/views.h"

#define PI 3.14159265358979323846

const char *const verify_names[VERIFY_CHECKS] = {"positive",   "normalisation", "projected-area", "weak-furnace",
                                                 "furnace",    "reciprocity",   "isotropy",       "pdf-normalisation",
                                                 "chi-square", "weight",        "efficiency"};

const char *const verify_reasons[VERIFY_CHECKS] = {
    "nothing is allowed: no NaN, no infinity, no negative number, no light where there is none",
    "two rules of quadrature agree to 1e-6 of a part; 1e-4 leaves room for a hundred parts",
    "as for normalisation",
    "quadrature over the sphere, where lobes at grazing views are bent, is good to some 1e-4",
    "quadrature as for normalisation; of a lossless model 1e-3, which fits of lost energy may take",
    "both ways round the same numbers are rounded differently: some 1e-12, times the steepness of a lobe",
    "a turn rounds each direction: 1e-16, times the steepness of a lobe",
    "quadrature to 1e-3, and four standard deviations of the share of draws that give no sample",
    "Sidak's level of 0.01 for all tests of the run together",
    "the direction that a sample returns is rounded: 1e-16, times the steepness of a lobe",
    "nothing is required"};

enum { PAIRS = 4000, WEIGHTS = 20000, NUMBERS = 7 };

/* Of parts of integrals. */
#define PART 1e-6

/* ---- What every check does --------------------------------------------------------------------- */

static verify_result start(verify_check check, double tolerance)
{
    return (verify_result){.check = check, .verdict = VERIFY_PASSED, .tolerance = tolerance};
}

static verify_result leave_out(verify_check check, const char *why)
{
    verify_result r = {.check = check, .verdict = VERIFY_LEFT_OUT};
    snprintf(r.found, sizeof r.found, "%s", why);
    return r;
}

/* Keeps the largest deviation; NaN counts as infinite. */
static bool is_worst(verify_result *r, double deviation, const double wo[3], const double *wi)
{
    if (isnan(deviation)) deviation = INFINITY;
    if (deviation <= r->worst) return false;
    r->worst = deviation;
    for (int k = 0; k < 3; k++) {
        r->wo[k] = wo[k];
        r->wi[k] = wi ? wi[k] : 0;
    }
    if (deviation > r->tolerance) r->verdict = VERIFY_FAILED;
    return true;
}

static bool is_good(double x)
{
    return isfinite(x) && x >= 0;
}

static double most(const double f[3])
{
    return fmax(f[0], fmax(f[1], f[2]));
}

/* A direction uniform over a hemisphere, or near the direction in which a mirror would send wo. */
static void random_partner(verify_random *r, const double wo[3], bool is_near, double wi[3])
{
    if (!is_near) {
        verify_direction(verify_draw(r), 2*PI*verify_draw(r), wi);
        return;
    }
    const double t = exp(-12*verify_draw(r)), phi = 2*PI*verify_draw(r), slope[2] = {t*cos(phi), t*sin(phi)};
    const double inverse = 1/sqrt(1 + t*t), m[3] = {slope[0]*inverse, slope[1]*inverse, inverse};
    const double c = wo[0]*m[0] + wo[1]*m[1] + wo[2]*m[2];
    for (int k = 0; k < 3; k++) wi[k] = 2*c*m[k] - wo[k];
}

static void random_numbers(verify_random *r, double u[3])
{
    for (int k = 0; k < 3; k++) u[k] = verify_draw(r);
}

/* Sample number k of those that a seed gives. */
static bool draw_numbered(const verify_subject *s, uint64_t seed, uint64_t number, const double wo[3], double wi[3],
                          double weight[3])
{
    verify_random r = {seed*UINT64_C(0xd1342543de82ef95) + number*UINT64_C(0x2545f4914f6cdd1d)};
    double u[3];
    random_numbers(&r, u);
    return s->sample(s->self, wo, u, wi, weight);
}

/* ---- Functions of a direction, to be integrated ------------------------------------------------ */

typedef struct at_view {
    const verify_subject *s;
    const double *wo; /* above: that of the subject, turned over if it is below */
    double side;      /* of the subject's wo: 1 or -1 */
    double G1;
} at_view;

/* Back to the subject's side. */
static void turn_over(const at_view *at, const double v[3], double turned[3])
{
    turned[0] = v[0];
    turned[1] = v[1];
    turned[2] = at->side*v[2];
}

static double value_towards(const void *context, const double wi[3])
{
    const at_view *at = context;
    double f[3] = {0}, i[3], o[3];
    turn_over(at, wi, i);
    turn_over(at, at->wo, o);
    at->s->eval(at->s->self, i, o, f);
    return most(f);
}

static double density_towards(const void *context, const double wi[3])
{
    const at_view *at = context;
    double i[3], o[3];
    turn_over(at, wi, i);
    turn_over(at, at->wo, o);
    return at->s->pdf(at->s->self, i, o);
}

static double value_below(const void *context, const double wi[3])
{
    return wi[2] < 0 ? value_towards(context, wi) : 0;
}

static double density_below(const void *context, const double wi[3])
{
    return wi[2] < 0 ? density_towards(context, wi) : 0;
}

static double projected_normal(const void *context, const double m[3])
{
    const verify_subject *s = context;
    return s->D(s->self, m)*m[2];
}

static double normal_towards(const void *context, const double m[3])
{
    const at_view *at = context;
    return at->s->D(at->s->self, m)*(at->wo[0]*m[0] + at->wo[1]*m[1] + at->wo[2]*m[2]);
}

static double visible_normal(const void *context, const double m[3])
{
    const at_view *at = context;
    const double c = at->wo[0]*m[0] + at->wo[1]*m[1] + at->wo[2]*m[2];
    return c > 0 ? at->G1*at->s->D(at->s->self, m)*c : 0;
}

static double weak_furnace_value(const void *context, const double wi[3])
{
    const at_view *at = context;
    double h[3];
    for (int k = 0; k < 3; k++) h[k] = wi[k] + at->wo[k];
    const double length = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2]);
    if (!(length > 1e-12) || !(h[2] > 0)) return 0;
    for (int k = 0; k < 3; k++) h[k] /= length;
    return at->G1*at->s->D(at->s->self, h)/(4*at->wo[2]);
}

static at_view view_of(const verify_subject *s, const double wo[3], double above[3])
{
    above[0] = wo[0];
    above[1] = wo[1];
    above[2] = fabs(wo[2]);
    return (at_view){s, above, wo[2] < 0 ? -1 : 1, 0};
}

/* ---- The checks -------------------------------------------------------------------------------- */

static void check_value(verify_result *r, const char *name, double x, bool is_nothing, const double wo[3],
                        const double *wi)
{
    const bool is_bad = !is_good(x) || (is_nothing && x > 0);
    if (is_bad && is_worst(r, isfinite(x) ? fabs(x) : INFINITY, wo, wi))
        snprintf(r->found, sizeof r->found, "%s is %g%s", name, x,
                 is_nothing && x > 0 ? " where there is no light" : "");
}

/* The directions that a view is paired with: edges of the domain, the view itself, its mirror image, and all views. */
enum { EDGES = 9, MOST_PARTNERS = EDGES + 2 + VERIFY_MOST_VIEWS };
static int partners_of(const double wo[3], double views[][3], int n_views, double wi[MOST_PARTNERS][3])
{
    static const double edges[EDGES][2] = {{1, 0},    {0.999999, 2}, {0.5, 1},  {1e-2, 4}, {1e-4, 2},
                                           {1e-8, 5}, {-1e-4, 1},    {-0.3, 3}, {-1, 0}};
    for (int i = 0; i < EDGES; i++) verify_direction(edges[i][0], edges[i][1], wi[i]);
    for (int k = 0; k < 3; k++) {
        wi[EDGES][k] = wo[k];
        wi[EDGES + 1][k] = k < 2 ? -wo[k] : wo[k];
    }
    for (int i = 0; i < n_views; i++)
        for (int k = 0; k < 3; k++) wi[EDGES + 2 + i][k] = views[i][k];
    return EDGES + 2 + n_views;
}

static verify_result positive(const verify_subject *s)
{
    static const double numbers[NUMBERS] = {0, 0x1p-53, 1e-3, 0.5, 0.999, 1 - 0x1p-24, 1 - 0x1p-53};
    verify_result r = start(VERIFY_POSITIVE, 0);
    double views[VERIFY_MOST_VIEWS][3], partners[MOST_PARTNERS][3];
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        const double *wo = views[i];
        const int n_partners = partners_of(wo, views, n, partners);
        for (int j = 0; j < n_partners; j++) {
            const double *wi = partners[j];
            double f[3] = {0};
            const bool is_nothing = !(s->claims & FACET_CLAIMS_TRANSMITS) && wi[2] <= 0;
            s->eval(s->self, wi, wo, f);
            for (int k = 0; k < 3; k++) check_value(&r, "f cos", f[k], is_nothing, wo, wi);
            if (s->pdf) check_value(&r, "pdf", s->pdf(s->self, wi, wo), is_nothing, wo, wi);
        }
        for (int j = 0; j < NUMBERS*NUMBERS*NUMBERS && s->sample; j++) {
            const double u[3] = {numbers[j%NUMBERS], numbers[j/NUMBERS%NUMBERS], numbers[j/NUMBERS/NUMBERS]};
            double wi[3] = {0}, weight[3] = {0};
            if (!s->sample(s->self, wo, u, wi, weight)) continue;
            for (int k = 0; k < 3; k++) check_value(&r, "weight", weight[k], false, wo, wi);
            const double length = sqrt(wi[0]*wi[0] + wi[1]*wi[1] + wi[2]*wi[2]);
            if (!(fabs(length - 1) <= 1e-6) && is_worst(&r, isfinite(length) ? fabs(length - 1) : INFINITY, wo, wi))
                snprintf(r.found, sizeof r.found, "a sampled direction has the length %g", length);
        }
        if (s->D) check_value(&r, "D", s->D(s->self, wo), false, wo, NULL);
        if (s->G1 && wo[2] > 0) {
            const double G1 = s->G1(s->self, wo);
            check_value(&r, "G1", G1, false, wo, NULL);
            if (G1 > 1 + 1e-12 && is_worst(&r, G1 - 1, wo, NULL))
                snprintf(r.found, sizeof r.found, "G1 is %.9g, above 1", G1);
        }
    }
    return r;
}

static verify_result normalisation(const verify_subject *s)
{
    if (!s->D) return leave_out(VERIFY_NORMALISATION, "the model gives no D");
    verify_result r = start(VERIFY_NORMALISATION, 1e-4);
    const double n[3] = {0, 0, 1}, area = over_normals(projected_normal, s, PART);
    is_worst(&r, fabs(area - 1), n, NULL);
    snprintf(r.found, sizeof r.found, "Int D cos dm = %.7f", area);
    return r;
}

/* The facets of a level surface project to its area: Int D (v.m) dm = cos_v, and to that with those alone that face
 * v and are not masked. */
static verify_result projected_area(const verify_subject *s)
{
    if (!s->D) return leave_out(VERIFY_PROJECTED_AREA, "the model gives no D");
    verify_result r = start(VERIFY_PROJECTED_AREA, 1e-4);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        if (views[i][2] < 0) continue;
        const at_view at = {s, views[i], 1, s->G1 ? s->G1(s->self, views[i]) : 0};
        const double all = over_normals(normal_towards, &at, PART);
        if (is_worst(&r, fabs(all - views[i][2]), views[i], NULL))
            snprintf(r.found, sizeof r.found, "Int D (v.m) dm = %.6f, cos_v = %.6f", all, views[i][2]);
        if (!s->G1) continue;
        const double seen = over_normals(visible_normal, &at, PART*views[i][2])/views[i][2];
        if (is_worst(&r, fabs(seen - 1), views[i], NULL))
            snprintf(r.found, sizeof r.found, "G1 Int D (v.m)+ dm/cos_v = %.6f", seen);
    }
    return r;
}

static verify_result weak_furnace(const verify_subject *s)
{
    if (!s->D || !s->G1) return leave_out(VERIFY_WEAK_FURNACE, "the model gives no D, or no G1");
    verify_result r = start(VERIFY_WEAK_FURNACE, 1e-3);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        if (views[i][2] < 0) continue;
        const at_view at = {s, views[i], 1, s->G1(s->self, views[i])};
        const double mirror[3] = {-views[i][0], -views[i][1], views[i][2]};
        const double sum = over_sphere(weak_furnace_value, &at, mirror, PART);
        if (is_worst(&r, fabs(sum - 1), views[i], NULL))
            snprintf(r.found, sizeof r.found, "Int G1 D/(4 cos_o) = %.6f", sum);
    }
    return r;
}

static verify_result furnace(const verify_subject *s)
{
    const bool is_lossless = s->claims & FACET_CLAIMS_LOSSLESS;
    if (!is_lossless && !(s->claims & FACET_CLAIMS_PASSIVE))
        return leave_out(VERIFY_FURNACE, "the model does not claim to conserve energy");
    verify_result r = start(VERIFY_FURNACE, is_lossless ? 1e-3 : 1e-4);
    double views[VERIFY_MOST_VIEWS][3], highest = 0;
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        double wo[3];
        const at_view at = view_of(s, views[i], wo);
        double albedo = over_mirrored(value_towards, &at, wo, PART);
        if (s->claims & FACET_CLAIMS_TRANSMITS) {
            const double through[3] = {-wo[0], -wo[1], -wo[2]};
            albedo += over_sphere(value_below, &at, through, PART);
        }
        highest = fmax(highest, albedo);
        if (is_worst(&r, is_lossless ? fabs(albedo - 1) : albedo <= 1 ? 0 : albedo - 1, views[i], NULL))
            snprintf(r.found, sizeof r.found, "the albedo is %.6f", albedo);
    }
    if (r.worst <= 0) snprintf(r.found, sizeof r.found, "the albedo is at most %.6f", highest);
    return r;
}

/* Both directions the other way round, or turned by an angle: f compared. */
static verify_result symmetry(const verify_subject *s, verify_check check, uint64_t seed)
{
    const bool is_turn = check == VERIFY_ISOTROPY;
    if (!(s->claims & (is_turn ? FACET_CLAIMS_ISOTROPIC : FACET_CLAIMS_RECIPROCAL)))
        return leave_out(check, is_turn ? "the model does not claim to be isotropic" : "the model does not claim it");
    verify_result r = start(check, 1e-6);
    verify_random random = {seed};
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    for (int i = 0; i < PAIRS; i++) {
        const double *wo = views[i%n];
        double wi[3], one[3] = {0}, other[3] = {0};
        if (wo[2] < 0) continue;
        random_partner(&random, wo, i%3 != 0, wi);
        if (!(wi[2] > 1e-3)) continue;
        const double angle = 2*PI*verify_draw(&random), c = cos(angle), z = sin(angle);
        const double turned_i[3] = {c*wi[0] - z*wi[1], z*wi[0] + c*wi[1], wi[2]};
        const double turned_o[3] = {c*wo[0] - z*wo[1], z*wo[0] + c*wo[1], wo[2]};
        s->eval(s->self, wi, wo, one);
        if (is_turn) s->eval(s->self, turned_i, turned_o, other);
        else s->eval(s->self, wo, wi, other);
        for (int k = 0; k < 3; k++) {
            const double a = one[k]/wi[2], b = other[k]/(is_turn ? wi[2] : wo[2]), larger = fmax(fabs(a), fabs(b));
            if (larger > 1e-30 && is_worst(&r, fabs(a - b)/larger, wo, wi))
                snprintf(r.found, sizeof r.found, "f is %.9g, and %.9g %s", a, b, is_turn ? "when turned" : "reversed");
        }
    }
    return r;
}

static verify_result pdf_normalisation(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return leave_out(VERIFY_PDF, "the model has no sampler");
    verify_result r = start(VERIFY_PDF, 1);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views), draws = settings->n_samples/4;
    for (int i = 0; i < n; i++) {
        double wo[3], wi[3], weight[3];
        const at_view at = view_of(s, views[i], wo);
        const double through[3] = {-wo[0], -wo[1], -wo[2]};
        const double mass = over_mirrored(density_towards, &at, wo, PART) +
                            over_sphere(density_below, &at, through, PART);
        int lost = 0;
        for (int k = 0; k < draws; k++)
            lost += !draw_numbered(s, settings->seed + 7, (uint64_t)k, views[i], wi, weight);
        const double share = lost/(double)draws, spread = sqrt(fmax(share*(1 - share), 1.0/draws)/draws);
        if (is_worst(&r, fabs(mass + share - 1)/(1e-3 + 4*spread), views[i],
                     NULL)) /* in units of what is allowed */
            snprintf(r.found, sizeof r.found, "Int pdf = %.5f, and %.5f of the draws give no sample", mass, share);
    }
    return r;
}

typedef struct numbered {
    const verify_subject *s;
    uint64_t seed;
} numbered;

static bool draw_for_test(const void *context, const double wo[3], uint64_t number, double wi[3])
{
    const numbered *n = context;
    double weight[3];
    return draw_numbered(n->s, n->seed, number, wo, wi, weight);
}

static double density_for_test(const void *context, const double wi[3], const double wo[3])
{
    const numbered *n = context;
    return n->s->pdf(n->s->self, wi, wo);
}

/* The cosines of the views of chi-square tests, in one azimuth. */
static const double tested[] = {1, .7, .15};
enum { TESTED = 3 };

int verify_chi_square_tests(const verify_subject *s)
{
    return !s->sample ? 0 : s->claims & FACET_CLAIMS_TRANSMITS ? 2*TESTED : TESTED;
}

static verify_result chi_square_tests(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return leave_out(VERIFY_CHI_SQUARE, "the model has no sampler");
    const int n = verify_chi_square_tests(s);
    verify_result r = start(VERIFY_CHI_SQUARE, 1);
    for (int i = 0; i < n; i++) {
        double wo[3];
        verify_direction(tested[i%TESTED], .7, wo);
        if (i >= TESTED) wo[2] = -wo[2];
        const numbered draws = {s, settings->seed + (uint64_t)i};
        const sampler_subject subject = {&draws, draw_for_test, density_for_test};
        const sampler_result result = sampler_test(&subject, wo, s->claims & FACET_CLAIMS_TRANSMITS,
                                                   settings->n_samples);
        /* in units of what is allowed: the logarithm of p over that of the level */
        const double level = sidak_level(0.01, settings->n_tests);
        const double p = result.test.forbidden > 0 ? 0 : result.test.p;
        const double deviation = p > 0 ? log(p)/log(level) : INFINITY;
        if (is_worst(&r, deviation, wo, NULL))
            snprintf(r.found, sizeof r.found, "chi^2 = %.1f of %d degrees, p = %.2g (level %.1g)",
                     result.test.statistic, result.test.degrees, p, level);
    }
    return r;
}

static verify_result weights(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return leave_out(VERIFY_WEIGHT, "the model has no sampler");
    verify_result r = start(VERIFY_WEIGHT, 1e-5);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views);
    for (int i = 0; i < WEIGHTS; i++) {
        const double *wo = views[i%n];
        double wi[3] = {0}, weight[3] = {0}, f[3] = {0};
        if (!draw_numbered(s, settings->seed + 11, (uint64_t)i, wo, wi, weight)) continue;
        const double pdf = s->pdf(s->self, wi, wo);
        s->eval(s->self, wi, wo, f);
        for (int k = 0; k < 3; k++) {
            const double larger = fmax(fabs(f[k]), fabs(weight[k]*pdf));
            if (larger > 1e-30 && is_worst(&r, fabs(weight[k]*pdf - f[k])/larger, wo, wi))
                snprintf(r.found, sizeof r.found, "weight pdf = %.9g, f cos = %.9g", weight[k]*pdf, f[k]);
        }
    }
    return r;
}

static verify_result efficiency(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return leave_out(VERIFY_EFFICIENCY, "the model has no sampler");
    verify_result r = start(VERIFY_EFFICIENCY, INFINITY);
    double views[VERIFY_MOST_VIEWS][3], highest = 0;
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        double sum = 0, squares = 0;
        for (int k = 0; k < WEIGHTS; k++) {
            double wi[3], weight[3] = {0};
            const double w = draw_numbered(s, settings->seed + 13, (uint64_t)k, views[i], wi, weight) ? most(weight)
                                                                                                      : 0;
            sum += w;
            squares += w*w;
            highest = fmax(highest, w);
        }
        const double mean = sum/WEIGHTS, deviation = sqrt(fmax(squares/WEIGHTS - mean*mean, 0));
        is_worst(&r, mean > 0 ? deviation/mean : 0, views[i], NULL);
    }
    snprintf(r.found, sizeof r.found, "a weight deviates by %.3f of its mean at most; the largest is %.4g", r.worst,
             highest);
    return r;
}

verify_result verify_run(const verify_subject *s, verify_check check, const verify_settings *settings)
{
    switch (check) {
    case VERIFY_POSITIVE: return positive(s);
    case VERIFY_NORMALISATION: return normalisation(s);
    case VERIFY_PROJECTED_AREA: return projected_area(s);
    case VERIFY_WEAK_FURNACE: return weak_furnace(s);
    case VERIFY_FURNACE: return furnace(s);
    case VERIFY_RECIPROCITY:
    case VERIFY_ISOTROPY: return symmetry(s, check, settings->seed);
    case VERIFY_PDF: return pdf_normalisation(s, settings);
    case VERIFY_CHI_SQUARE: return chi_square_tests(s, settings);
    case VERIFY_WEIGHT: return weights(s, settings);
    default: return efficiency(s, settings);
    }
}
