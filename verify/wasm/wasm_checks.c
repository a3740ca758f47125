/* wasm_checks.c: the checks that the explorer shows, for WebAssembly: results as rows of numbers.
 *
 * Directions are unit vectors, wo above the surface.  Each function returns 0, or a facet_status.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "verify/checks.h"
#include "verify/sampler_density.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

typedef struct subject {
    facet_material material;
    facet_bsdf64 bsdf;
    verify_subject subject;
} subject;

static facet_status prepare(const char *text, subject *s)
{
    s->material.struct_size = sizeof s->material;
    facet_status status = facet_material_parse(text, &s->material, NULL);
    if (!status) status = facet_bsdf64_prepare(&s->material, &s->bsdf, NULL);
    if (!status) s->subject = verify_material(&s->material, &s->bsdf);
    return status;
}

enum { ALBEDO = 0, TRANSMITTED = 3, WEAK = 6, ALLOWED_WEAK, DEVIATION, ALLOWED, FURNACE_NUMBERS };

/* numbers[]: the albedo by reflection and by transmission, of each channel; the weak furnace, NaN where it is not
 * defined, and how far from 1 it may be; how far the furnace is from what the model claims, NaN if it claims nothing,
 * and what is allowed. */
int checks_furnace(const char *text, const double wo[3], double numbers[FURNACE_NUMBERS]);
int EXPORT(checks_furnace)(const char *text, const double wo[3], double numbers[FURNACE_NUMBERS])
{
    subject s;
    facet_status status = prepare(text, &s);
    if (!status) status = facet_bsdf64_albedo(&s.bsdf, wo, numbers + ALBEDO, numbers + TRANSMITTED, NULL);
    if (status) return status;
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, numbers[ALBEDO + k] + numbers[TRANSMITTED + k]);
    numbers[WEAK] = verify_weak_furnace(&s.subject, wo);
    numbers[ALLOWED_WEAK] = verify_tolerance(&s.subject, VERIFY_WEAK_FURNACE);
    numbers[DEVIATION] = verify_furnace_deviation(&s.subject, most);
    numbers[ALLOWED] = verify_tolerance(&s.subject, VERIFY_FURNACE);
    return FACET_OK;
}

typedef struct numbered {
    const verify_subject *s;
    uint64_t seed;
} numbered;

static bool draw(const void *context, const double wo[3], uint64_t number, double wi[3])
{
    const numbered *n = context;
    double weight[3];
    return draw_numbered(n->s, n->seed, number, wo, wi, weight);
}

static double density(const void *context, const double wi[3], const double wo[3])
{
    const numbered *n = context;
    return n->s->pdf(n->s->self, wi, wo);
}

typedef struct checks_result {
    double p, statistic, degrees, mass, lost, level;
    double mean_x, mean_y, n_bands;
    double cosines[2*SAMPLER_BANDS + 1], azimuths[2*SAMPLER_BANDS][SAMPLER_SECTORS + 1];
    double expected[SAMPLER_MOST_CELLS + 1], observed[SAMPLER_MOST_CELLS + 1];
} checks_result;

/* Pearson's test of n samples for this wo; FACET_UNSUPPORTED for mirrors and smooth glass, which have no density. */
int checks_chi_square(const char *text, const double wo[3], int n, int seed, checks_result *result);
int EXPORT(checks_chi_square)(const char *text, const double wo[3], int n, int seed, checks_result *result)
{
    sampler_cells cells;
    subject s;
    const facet_status status = prepare(text, &s);
    if (status) return status;
    if (!s.subject.sample) return FACET_UNSUPPORTED;
    const numbered context = {&s.subject, (uint64_t)seed};
    const sampler_subject test = {&context, draw, density};
    const bool has_two_sides = s.subject.claims & FACET_CLAIMS_TRANSMITS;
    const sampler_result found = sampler_test(&test, wo, has_two_sides, n, &cells);
    const verify_settings one = {.n_samples = n, .n_tests = 1};
    *result = (checks_result){.p = found.test.p,
                              .statistic = found.test.statistic,
                              .degrees = found.test.degrees,
                              .mass = found.mass,
                              .lost = found.lost,
                              .level = verify_level(&one),
                              .mean_x = cells.mean_x,
                              .mean_y = cells.mean_y,
                              .n_bands = cells.n_bands};
    memcpy(result->cosines, cells.cosines, sizeof cells.cosines);
    memcpy(result->azimuths, cells.azimuths, sizeof cells.azimuths);
    memcpy(result->expected, cells.expected, sizeof cells.expected);
    memcpy(result->observed, cells.observed, sizeof cells.observed);
    return FACET_OK;
}
