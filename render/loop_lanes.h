/* loop_lanes.h: how many elements the loops (loops.h) take at a time.
 * SPDX-License-Identifier: MIT */
#pragma once

enum { LOOP_LANES = 64 };
