/* loops_avx512.c: the loops for processors with AVX-512.
 * SPDX-License-Identifier: MIT */
#if defined(__x86_64__)
#define RENDER_LOOPS render_loops_avx512
#define RENDER_LOOPS_NAME "avx512"
#include "render/loops_text.h"
#else
typedef int loops_avx512_is_for_x86_64_only; /* a translation unit is not empty */
#endif
