/* batch_avx2.c: the loops for processors with AVX2.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#define BATCH_LOOPS facet_batch_avx2
#define BATCH_GTR_FIT facet_gtr_fit_avx2
#define BATCH_NAME "avx2"
#include "batch_text.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int batch_avx2_is_for_x86_64_only; /* a translation unit is not empty */
#endif
