/* prepared.h: what a facet_bsdf holds: which code serves the material, and its parameters, prepared.
 *
 * Depends on the precision of the file that includes it (kernel/real.h).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_table.h"

#define KERNEL_ENUM_ROW(name) KERNEL_##name,
enum { FACET_KERNELS(KERNEL_ENUM_ROW) KERNEL_COUNT };

#define MODEL_ENUM_ROW(name, kernel, summary, source) MODEL_##name,
enum { FACET_MODELS(MODEL_ENUM_ROW) MODEL_COUNT };

/* The caller's storage is declared as numbers of another type, hence the leave to alias. */
typedef struct __attribute__((may_alias)) prepared {
    int kernel, variant;
    union {
#define MEMBER_ROW(name) name##_params name;
        FACET_KERNELS(MEMBER_ROW)
    } of;
} prepared;
