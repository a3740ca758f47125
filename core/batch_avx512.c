/* batch_avx512.c: the loops for processors with AVX512.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512vl,avx512dq,avx512bw")
#endif
#define BATCH_LOOPS facet_batch_avx512
#define BATCH_GTR_FIT facet_gtr_fit_avx512
#define BATCH_NAME "avx512"
#include "batch_text.h"
#if defined(__clang__)
#pragma clang attribute pop
#endif
#else
typedef int batch_avx512_is_for_x86_64_only; /* a translation unit is not empty */
#endif
