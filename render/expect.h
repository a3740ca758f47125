/* expect.h: functions that ask memory for what is wanted soon.
 *
 * gcc 12 takes a function that does nothing else for one without any effect, and drops calls of it, unless they are
 * expanded where they stand.
 * SPDX-License-Identifier: MIT */
#pragma once

#define EXPECTING static inline __attribute__((always_inline))
