/* ranks_module.h: what the module facet_mpi.so gives to the program.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "cli/ranks.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As in ranks.h; start leaves an error to be told by rank 0. */
typedef struct ranks_module {
    int (*start)(crew *c, const launch *by, char *error, size_t size);
    uint32_t (*count_threads)(void);
    void (*part)(void);
    void (*end)(int status);
} ranks_module;

extern const ranks_module facet_ranks_module;

#ifdef __cplusplus
}
#endif
