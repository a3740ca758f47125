/* verify.c: the checks of verify.h that compare values, and what all checks share.
 * SPDX-License-Identifier: MIT */
#include "verify/verify.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "verify/checks.h"
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

#define PI 3.14159265358979323846

enum { PAIRS = 4000, NUMBERS = 7 };

double verify_tolerance(const verify_subject *s, verify_check check)
{
    switch (check) {
    case VERIFY_POSITIVE: return 0;
    case VERIFY_NORMALISATION:
    case VERIFY_PROJECTED_AREA: return 1e-4;
    case VERIFY_WEAK_FURNACE: return 1e-3;
    case VERIFY_FURNACE: return s->claims & FACET_CLAIMS_LOSSLESS ? 1e-3 : 1e-4;
    case VERIFY_RECIPROCITY:
    case VERIFY_ISOTROPY: return 1e-6;
    case VERIFY_WEIGHT: return 1e-5;
    case VERIFY_PDF:
    case VERIFY_CHI_SQUARE: return 1; /* in units of what is allowed */
    default: return INFINITY;
    }
}

/* ---- What every check does --------------------------------------------------------------------- */

verify_result check_start(const verify_subject *s, verify_check check)
{
    return (verify_result){.check = check, .verdict = VERIFY_PASSED, .tolerance = verify_tolerance(s, check)};
}

verify_result check_leave_out(verify_check check, const char *why)
{
    verify_result r = {.check = check, .verdict = VERIFY_LEFT_OUT};
    snprintf(r.found, sizeof r.found, "%s", why);
    return r;
}

bool check_is_worst(verify_result *r, double deviation, const double wo[3], const double *wi)
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

const char *check_number(double x, int n_decimals, char text[CHECK_NUMBER])
{
    snprintf(text, CHECK_NUMBER, fabs(x) < 1e9 ? "%.*f" : "%.*g", n_decimals, x);
    return text;
}

double largest_channel(const double f[3])
{
    return fmax(f[0], fmax(f[1], f[2]));
}

bool draw_numbered(const verify_subject *s, uint64_t seed, uint64_t number, const double wo[3], double wi[3],
                   double weight[3])
{
    verify_random r = {seed*UINT64_C(0xd1342543de82ef95) + number*UINT64_C(0x2545f4914f6cdd1d)};
    double u[3];
    for (int k = 0; k < 3; k++) u[k] = verify_draw(&r);
    return s->sample(s->self, wo, u, wi, weight);
}

at_view view_of(const verify_subject *s, const double wo[3])
{
    return (at_view){s, {wo[0], wo[1], fabs(wo[2])}, wo[2] < 0 ? -1 : 1, 0};
}

void turn_over(const at_view *at, const double v[3], double turned[3])
{
    turned[0] = v[0];
    turned[1] = v[1];
    turned[2] = at->side*v[2];
}

/* ---- The checks -------------------------------------------------------------------------------- */

static bool is_good(double x)
{
    return isfinite(x) && x >= 0;
}

static void check_value(verify_result *r, const char *name, double x, bool is_nothing, const double wo[3],
                        const double *wi)
{
    const bool is_bad = !is_good(x) || (is_nothing && x > 0);
    if (is_bad && check_is_worst(r, isfinite(x) ? fabs(x) : INFINITY, wo, wi))
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
    verify_result r = check_start(s, VERIFY_POSITIVE);
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
            if (!(fabs(length - 1) <= 1e-6) &&
                check_is_worst(&r, isfinite(length) ? fabs(length - 1) : INFINITY, wo, wi))
                snprintf(r.found, sizeof r.found, "a sampled direction has the length %g", length);
        }
        if (s->D) check_value(&r, "D", s->D(s->self, wo), false, wo, NULL);
        if (s->G1 && wo[2] > 0) {
            const double G1 = s->G1(s->self, wo);
            check_value(&r, "G1", G1, false, wo, NULL);
            if (G1 > 1 + 1e-12 && check_is_worst(&r, G1 - 1, wo, NULL))
                snprintf(r.found, sizeof r.found, "G1 is %.9g, above 1", G1);
        }
    }
    return r;
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

/* Both directions the other way round, or turned by an angle: f compared. */
static verify_result symmetry(const verify_subject *s, verify_check check, uint64_t seed)
{
    const bool is_turn = check == VERIFY_ISOTROPY;
    if (!(s->claims & (is_turn ? FACET_CLAIMS_ISOTROPIC : FACET_CLAIMS_RECIPROCAL)))
        return check_leave_out(check,
                               is_turn ? "the model does not claim to be isotropic" : "the model does not claim it");
    verify_result r = check_start(s, check);
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
            if (larger > 1e-30 && check_is_worst(&r, fabs(a - b)/larger, wo, wi))
                snprintf(r.found, sizeof r.found, "f is %.9g, and %.9g %s", a, b, is_turn ? "when turned" : "reversed");
        }
    }
    return r;
}

verify_result verify_run(const verify_subject *s, verify_check check, const verify_settings *settings)
{
    switch (check) {
    case VERIFY_POSITIVE: return positive(s);
    case VERIFY_NORMALISATION: return check_normalisation(s);
    case VERIFY_PROJECTED_AREA: return check_projected_area(s);
    case VERIFY_WEAK_FURNACE: return check_weak_furnace(s);
    case VERIFY_FURNACE: return check_furnace(s);
    case VERIFY_RECIPROCITY:
    case VERIFY_ISOTROPY: return symmetry(s, check, settings->seed);
    case VERIFY_PDF: return check_pdf(s, settings);
    case VERIFY_CHI_SQUARE: return check_chi_square(s, settings);
    case VERIFY_WEIGHT: return check_weight(s, settings);
    default: return check_efficiency(s, settings);
    }
}
