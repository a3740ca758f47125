/* gtr_fit_avx512.c: the fits of gtr for processors with AVX512.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#endif
#define GTR_FIT_LOOPS facet_gtr_fit_avx512
#include "gtr_fit_text.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int gtr_fit_avx512_is_for_x86_64_only; /* a translation unit is not empty */
#endif
