/* sampler_check.c: see sampler_check.h.
 * SPDX-License-Identifier: MIT */
#include "tests/sampler_check.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "verify/sampler_density.h"

enum { CHUNK = 4096 };

void draw_from_bsdf(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to)
{
    static _Thread_local float view[3][CHUNK], u[3][CHUNK];
    draws random = {seed};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            view[k][i] = wo[k];
            u[k][i] = (float)draw(&random);
        }
    facet_bsdf_sample_batch(context, (size_t)n, (facet_dirs){view[0], view[1], view[2]}, (facet_dirs){u[0], u[1], u[2]},
                            to);
}

/* The samples of a batch sampler, one by one: those of a chunk are drawn together when the first is asked for. */
typedef struct one_by_one {
    sampler draw_some;
    const void *context;
    const facet_bsdf64 *density;
    const float *wo;
    uint64_t seed, *chunk;
    float (*data)[CHUNK];
} one_by_one;

static bool draw_one(const void *context, const double wo[3], uint64_t number, double wi[3])
{
    const one_by_one *o = context;
    (void)wo;
    if (*o->chunk != number/CHUNK) {
        *o->chunk = number/CHUNK;
        o->draw_some(
            o->context, o->wo, o->seed + *o->chunk*CHUNK, CHUNK,
            (facet_samples){o->data[0], o->data[1], o->data[2], o->data[3], o->data[4], o->data[5], o->data[6]});
    }
    for (int k = 0; k < 3; k++) wi[k] = (double)o->data[k][number%CHUNK];
    return o->data[3][number%CHUNK] > 0;
}

static double density_of(const void *context, const double wi[3], const double wo[3])
{
    const one_by_one *o = context;
    return facet_bsdf64_pdf(o->density, wi, wo);
}

chi_square sampler_check(sampler draw_some, const void *context, const facet_bsdf64 *density, const float wo[3], int n,
                         uint64_t seed)
{
    static _Thread_local float data[7][CHUNK];
    uint64_t chunk = UINT64_MAX;
    const one_by_one one = {draw_some, context, density, wo, seed*1000003, &chunk, data};
    const sampler_subject subject = {&one, draw_one, density_of};
    const double view[3] = {(double)wo[0], (double)wo[1], (double)wo[2]};
    sampler_cells cells;
    return sampler_test(&subject, view, facet_bsdf64_lobes(density) & FACET_TRANSMISSION, n, &cells).test;
}

void check_samplers(const sampler_case *cases, int n_cases)
{
    const double level = sidak_level(0.01, SAMPLER_CHECKS);
    for (int i = 0; i < n_cases; i++) {
        const any_bsdf bsdf = any_bsdf_of(cases[i].spec, 0);
        double wo[3];
        any_direction(cases[i].cos_o, cases[i].phi_o, wo);
        const float view[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
        const chi_square result = sampler_check(draw_from_bsdf, &bsdf.single, &bsdf.twice, view, SAMPLER_CHECK_COUNT,
                                                (uint64_t)(i + 1));
        print_message("  %-44s cos_o %-5g chi^2 %8.1f of %d, p %.3g\n", cases[i].spec, cases[i].cos_o, result.statistic,
                      result.degrees, result.p);
        if (!(result.p >= level) || result.forbidden > 0)
            fail_msg("%s, wo (%a, %a, %a): p = %g is below %g, or %g samples are where none should be", cases[i].spec,
                     (double)view[0], (double)view[1], (double)view[2], result.p, level, result.forbidden);
    }
}
