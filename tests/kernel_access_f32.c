/* kernel_access_f32.c: the kernels in single precision.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 0
#define ACCESS kernel_access_f32
#include "tests/kernel_access_text.h"
