/* verify.h: whether a reflection model is what it says: identities that every right model satisfies.
 *
 * A subject is anything with an evaluation, with or without a sampler and the terms of a microfacet model.  Nothing is
 * compared with a copy of facet's own results: every check holds a function of the subject against another one, or
 * against a number that is known.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "facet/plugin.h"
#include "verify/sampler_density.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is verified.  The functions are those of facet_plugin, with `self` in place of the parameters. */
typedef struct verify_subject {
    const void *self;
    unsigned claims; /* FACET_CLAIMS_... */
    void (*eval)(const void *self, const double wi[3], const double wo[3], double f[3]);
    double (*pdf)(const void *self, const double wi[3], const double wo[3]); /* NULL without a sampler */
    int (*sample)(const void *self, const double wo[3], const double u[3], double wi[3], double weight[3]);
    double (*D)(const void *self, const double m[3]);  /* may be NULL */
    double (*G1)(const void *self, const double v[3]); /* may be NULL */
} verify_subject;

/* In the order in which they run. */
typedef enum verify_check {
    VERIFY_POSITIVE,       /* finite, not negative, 0 on the side where there is no light */
    VERIFY_NORMALISATION,  /* Int D cos dm = 1 */
    VERIFY_PROJECTED_AREA, /* Int D (v.m) dm = cos_v = G1(v) Int D (v.m)+ dm */
    VERIFY_WEAK_FURNACE,   /* Int G1(wo) D(wm)/(4 cos_o) d omega_i = 1, over the whole sphere */
    VERIFY_FURNACE,        /* the directional albedo is at most 1, or is 1, as claimed */
    VERIFY_RECIPROCITY,    /* f(wi, wo) = f(wo, wi) */
    VERIFY_ISOTROPY,       /* turning both directions about the normal changes nothing */
    VERIFY_PDF,            /* Int pdf d omega_i = 1 - the share of draws that give no sample */
    VERIFY_CHI_SQUARE,     /* samples are distributed as the pdf says */
    VERIFY_WEIGHT,         /* weight = f cos/pdf */
    VERIFY_EFFICIENCY,     /* mean, deviation and largest weight: nothing to fail */
    VERIFY_CHECKS
} verify_check;

/* "positive", "normalisation", "projected-area", "weak-furnace", "furnace", "reciprocity", "isotropy",
 * "pdf-normalisation", "chi-square", "weight", "efficiency". */
extern const char *const verify_names[VERIFY_CHECKS];

/* One sentence on where the tolerance of a check comes from. */
extern const char *const verify_reasons[VERIFY_CHECKS];

typedef enum verify_verdict { VERIFY_PASSED, VERIFY_FAILED, VERIFY_LEFT_OUT } verify_verdict;

typedef struct verify_result {
    verify_check check;
    verify_verdict verdict;
    double worst, tolerance; /* the largest deviation over all views, and what is allowed */
    double wo[3], wi[3];     /* where; wi is 0 where the check is of a whole view */
    char found[160];         /* in words */
} verify_result;

typedef struct verify_settings {
    uint64_t seed;
    int n_samples; /* of each chi-square test */
    int n_tests;   /* chi-square tests that share the level of 0.01, this subject's included */
} verify_settings;

/* How many chi-square tests a run makes. */
int verify_chi_square_tests(const verify_subject *s);

/* Runs one check.  Pure but for the subject's own functions; safe on several threads. */
verify_result verify_run(const verify_subject *s, verify_check check, const verify_settings *settings);

/* ---- What the checks look at, to be shown ------------------------------------------------------ */

/* The largest deviation that a check allows. */
double verify_tolerance(const verify_subject *s, verify_check check);

/* The share of light from all directions that is sent to wo, of the channel that is largest in each. */
double verify_albedo(const verify_subject *s, const double wo[3]);

/* How far an albedo is from what the model claims of it; NaN if it claims nothing. */
double verify_furnace_deviation(const verify_subject *s, double albedo);

/* Int G1(wo) D(wm)/(4 cos_o) d omega_i, wo above; NaN without D or G1. */
double verify_weak_furnace(const verify_subject *s, const double wo[3]);

/* The test of this number among verify_chi_square_tests: its view and its cells; and the p below which it fails. */
sampler_result verify_chi_square(const verify_subject *s, const verify_settings *settings, int number, double wo[3],
                                 sampler_cells *cells);
double verify_level(const verify_settings *settings);

/* ---- facet's own materials --------------------------------------------------------------------- */

/* A prepared material as a subject, with the claims that its documentation makes; `bsdf` is referred to. */
verify_subject verify_material(const facet_material *material, const facet_bsdf64 *bsdf);

#ifdef __cplusplus
}
#endif
