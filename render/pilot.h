/* pilot.h: whether it pays to share light between neighbouring pixels (stage_gradients.c), which takes about a third
 * more time for a sample.
 *
 * A few squares of the picture are rendered with and without.  Their samples are none of the picture's, and the answer
 * is a pure function of scene, camera, size, depth and strategy, so that all parts of a render have the same.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/render_run.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Into *pays.  FACET_NO_MEMORY. */
facet_status pilot_run(const job *j, thread_pool *pool, bool *pays);

#ifdef __cplusplus
}
#endif
