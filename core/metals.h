/* metals.h: indices of refraction of metals, effective ones for the channels of linear sRGB.
 *
 * Written by tools/make_metals.py, which has the method and the sources: change that, not this.
 * SPDX-License-Identifier: MIT */
#pragma once

typedef struct metal {
    double eta[3], k[3]; /* index of refraction eta + i k for red, green, blue */
} metal;

/* The names in the order of the table, as the choices of a parameter. */
#define METAL_NAMES "Ag|Al|Au|Co|Cr|Cu|Fe|Ni|Ti"
#define METALS      9

static const metal metals[METALS] = {
    {{0.0565982, 0.0549858, 0.0432242}, {4.47323, 3.55237, 2.59047}}, /* Ag, silver */
    {{1.18505, 0.767579, 0.465336}, {6.77115, 5.78645, 4.67817}}, /* Al, aluminium */
    {{0.100303, 0.495385, 1.47131}, {20, 2.25722, 1.77559}}, /* Au, gold */
    {{2.2541, 2.03662, 1.7133}, {4.22126, 3.79745, 3.23804}}, /* Co, cobalt */
    {{3.24477, 3.11573, 2.28572}, {3.28565, 3.3366, 3.11692}}, /* Cr, chromium */
    {{0.228368, 1.04069, 1.29608}, {3.38012, 2.62729, 2.36198}}, /* Cu, copper */
    {{2.92202, 2.91974, 2.54628}, {3.07501, 2.93837, 2.74995}}, /* Fe, iron */
    {{2.03159, 1.90397, 1.72874}, {4.19176, 3.574, 2.89596}}, /* Ni, nickel */
    {{2.7445, 2.50912, 2.23997}, {3.83852, 3.39969, 3.01461}}, /* Ti, titanium */
};
