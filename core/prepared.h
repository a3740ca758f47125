/* prepared.h: what a facet_bsdf holds: the model's index and its parameters, prepared.
 *
 * Depends on the precision of the file that includes it (kernel/real.h).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_table.h"

#define ENUM_ROW(name, summary, source) MODEL_##name,
enum { FACET_MODELS(ENUM_ROW) MODEL_COUNT };

/* The caller's storage is declared as numbers of another type, hence the leave to alias. */
typedef struct __attribute__((may_alias)) prepared {
    int model;
    union {
#define MEMBER_ROW(name, summary, source) name##_params name;
        FACET_MODELS(MEMBER_ROW)
    } of;
} prepared;
