/* kernel_access_f64.c: the kernels in double precision.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 1
#define ACCESS kernel_access_f64
#include "tests/kernel_access_text.h"
