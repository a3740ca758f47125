/* analyser.h: what clang's analyzer, which sees one file at a time, cannot know.  Included before each file by
 * tools/analyse.sh, and by nothing that is built.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "core/error.h"
#include "io/json.h"

/* A function that ends in one of these has failed. */
#define facet_error_set(why, status, ...) (facet_error_set(why, status, __VA_ARGS__), (status))
#define json_fail(...) (json_fail(__VA_ARGS__), false)
