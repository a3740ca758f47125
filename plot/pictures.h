/* pictures.h: what `facet verify` looked at, as PNG files.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/canvas.h"
#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct picture {
    const char *path;  /* .png */
    const char *title; /* plain text */
    const image_text *texts;
    size_t n_texts;
} picture;

/* A model, or a variant of it. */
typedef struct picture_subject {
    const char *label; /* plain text */
    const verify_subject *subject;
} picture_subject;

/* The chi-square tests of the settings, one a row: the histogram of the samples, the density, and their difference, in
 * the cells of the test.  The subject has a sampler. */
facet_status picture_chi_square(const picture *p, const verify_subject *s, const verify_settings *settings,
                                facet_error *why);

/* The albedo of n variants, 2 at most, over the angle of the view, and how far the furnace and the weak furnace of the
 * first one are from 1, with what is allowed. */
facet_status picture_furnace(const picture *p, const picture_subject *variants, size_t n, facet_error *why);

#ifdef __cplusplus
}
#endif
