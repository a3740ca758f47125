/* merl.h: measured isotropic BRDFs of the MERL database (.binary).
 *
 * [matusik03] Matusik, Pfister, Brand and McMillan, A data-driven reflectance model, SIGGRAPH 2003.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 90 x 90 x 180 values of f [1/sr] for each channel, over the half angle, the difference angle and its azimuth. */
typedef struct merl {
    double *values;
} merl;

/* Reads and checks a file: its three sizes, its length, and that all numbers are finite.  Negative ones, which the
 * database has where nothing was measured, become 0.  merl_free what it gives. */
facet_status merl_read(const char *path, merl *m, facet_error *why);
/* The same of a file that lies in memory. */
facet_status merl_decode(const unsigned char *bytes, size_t size, merl *m, facet_error *why);
void merl_free(merl *m);

/* f |cos theta_i|, linear between the measured angles; 0 below the horizon.  Thread safe. */
void merl_eval(const merl *m, const double wi[3], const double wo[3], double f[3]);

#ifdef __cplusplus
}
#endif
