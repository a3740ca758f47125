/* bsdf_f64.c: prepared materials in double precision.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 1
#define NAME(verb) facet_bsdf64_##verb
#define STORAGE facet_bsdf64
#define SAMPLE facet_sample64
#define TERMS facet_terms64
#include "bsdf_text.h"
