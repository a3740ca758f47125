/* loops_base.c: the loops for every processor of the architecture.
 * SPDX-License-Identifier: MIT */
#define RENDER_LOOPS render_loops_base
#define RENDER_LOOPS_NAME "base"
#include "render/loops_text.h"
