/* gtr_fit_avx2.c: the fits of gtr for processors with AVX2.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#define GTR_FIT_LOOPS facet_gtr_fit_avx2
#include "gtr_fit_text.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int gtr_fit_avx2_is_for_x86_64_only; /* a translation unit is not empty */
#endif
