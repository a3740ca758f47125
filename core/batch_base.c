/* batch_base.c: the loops for the instruction set that the compiler assumes (SSE2 on x86-64).
 * SPDX-License-Identifier: MIT */
#define BATCH_LOOPS facet_batch_base
#define BATCH_GTR_FIT facet_gtr_fit_base
#define BATCH_NAME "base"
#include "batch_text.h"
