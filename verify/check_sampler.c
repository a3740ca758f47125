/* check_sampler.c: the checks of a sampler.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "verify/checks.h"
#include "verify/integrals.h"
#include "verify/sampler_density.h"
#include "verify/views.h"

enum { WEIGHTS = 20000 };

/* Of parts of integrals. */
#define PART 1e-6

static double density_towards(const void *context, const double wi[3])
{
    const at_view *at = context;
    double i[3], o[3];
    turn_over(at, wi, i);
    turn_over(at, at->wo, o);
    return at->s->pdf(at->s->self, i, o);
}

static double density_below(const void *context, const double wi[3])
{
    return wi[2] < 0 ? density_towards(context, wi) : 0;
}

verify_result check_pdf(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return check_leave_out(VERIFY_PDF, "the model has no sampler");
    verify_result r = check_start(s, VERIFY_PDF);
    double views[VERIFY_MOST_VIEWS][3];
    const int n = verify_views(s, views), draws = settings->n_samples/4;
    for (int i = 0; i < n; i++) {
        double wi[3], weight[3];
        char text[CHECK_NUMBER];
        const at_view at = view_of(s, views[i]);
        const double through[3] = {-at.wo[0], -at.wo[1], -at.wo[2]};
        const double mass = over_mirrored(density_towards, &at, at.wo, PART) +
                            over_sphere(density_below, &at, through, PART);
        int lost = 0;
        for (int k = 0; k < draws; k++)
            lost += !draw_numbered(s, settings->seed + 7, (uint64_t)k, views[i], wi, weight);
        const double share = lost/(double)draws, spread = sqrt(fmax(share*(1 - share), 1.0/draws)/draws);
        if (check_is_worst(&r, fabs(mass + share - 1)/(1e-3 + 4*spread), views[i],
                           NULL)) /* in units of what is allowed */
            snprintf(r.found, sizeof r.found, "Int pdf = %s, and %.5f of the draws give no sample",
                     check_number(mass, 5, text), share);
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

double verify_level(const verify_settings *settings)
{
    return sidak_level(0.01, settings->n_tests);
}

sampler_result verify_chi_square(const verify_subject *s, const verify_settings *settings, int i, double wo[3],
                                 sampler_cells *cells)
{
    verify_direction(tested[i%TESTED], .7, wo);
    if (i >= TESTED) wo[2] = -wo[2];
    const numbered draws = {s, settings->seed + (uint64_t)i};
    const sampler_subject subject = {&draws, draw_for_test, density_for_test};
    sampler_result result = sampler_test(&subject, wo, s->claims & FACET_CLAIMS_TRANSMITS, settings->n_samples, cells);
    if (result.test.forbidden > 0) result.test.p = 0;
    return result;
}

verify_result check_chi_square(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return check_leave_out(VERIFY_CHI_SQUARE, "the model has no sampler");
    const int n = verify_chi_square_tests(s);
    verify_result r = check_start(s, VERIFY_CHI_SQUARE);
    for (int i = 0; i < n; i++) {
        double wo[3];
        sampler_cells cells;
        const sampler_result result = verify_chi_square(s, settings, i, wo, &cells);
        /* in units of what is allowed: the logarithm of p over that of the level */
        const double level = verify_level(settings), p = result.test.p;
        const double deviation = p > 0 ? log(p)/log(level) : INFINITY;
        if (!check_is_worst(&r, deviation, wo, NULL)) continue;
        if (!isfinite(result.test.statistic))
            snprintf(r.found, sizeof r.found, "chi^2 overflows, by the integral of the pdf");
        else
            snprintf(r.found, sizeof r.found, "chi^2 = %.1f of %d degrees, p = %.2g (level %.1g)",
                     result.test.statistic, result.test.degrees, p, level);
    }
    return r;
}

verify_result check_weight(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return check_leave_out(VERIFY_WEIGHT, "the model has no sampler");
    verify_result r = check_start(s, VERIFY_WEIGHT);
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
            if (larger > 1e-30 && check_is_worst(&r, fabs(weight[k]*pdf - f[k])/larger, wo, wi))
                snprintf(r.found, sizeof r.found, "weight pdf = %.9g, f cos = %.9g", weight[k]*pdf, f[k]);
        }
    }
    return r;
}

verify_result check_efficiency(const verify_subject *s, const verify_settings *settings)
{
    if (!s->sample) return check_leave_out(VERIFY_EFFICIENCY, "the model has no sampler");
    verify_result r = check_start(s, VERIFY_EFFICIENCY);
    double views[VERIFY_MOST_VIEWS][3], highest = 0;
    const int n = verify_views(s, views);
    for (int i = 0; i < n; i++) {
        double sum = 0, squares = 0;
        for (int k = 0; k < WEIGHTS; k++) {
            double wi[3], weight[3] = {0};
            const double w = draw_numbered(s, settings->seed + 13, (uint64_t)k, views[i], wi, weight)
                                 ? largest_channel(weight)
                                 : 0;
            sum += w;
            squares += w*w;
            highest = fmax(highest, w);
        }
        const double mean = sum/WEIGHTS, deviation = sqrt(fmax(squares/WEIGHTS - mean*mean, 0));
        check_is_worst(&r, mean > 0 ? deviation/mean : 0, views[i], NULL);
    }
    snprintf(r.found, sizeof r.found, "a weight deviates by %.3f of its mean at most; the largest is %.4g", r.worst,
             highest);
    return r;
}
