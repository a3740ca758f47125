/* gtr_fit_base.c: the fits of gtr for every processor.
 * SPDX-License-Identifier: MIT */
#define GTR_FIT_LOOPS facet_gtr_fit_base
#include "gtr_fit_text.h"
