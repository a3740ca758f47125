/* alias.h: drawing an index with given probabilities in constant time.
 * [walker77] Walker, An efficient method for generating discrete random variables, 1977; tables by Vose 1991.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/expect.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct alias_cell {
    float probability; /* of this index, the sum over all being 1 */
    float threshold;   /* keep the cell's own index below it */
    uint32_t alias;
} alias_cell;

typedef struct alias_table {
    alias_cell *cells;
    uint32_t n;
} alias_table;

/* Probabilities proportional to weights[n] >= 0, finite; all equal if their sum is 0.  n > 0. */
facet_status alias_table_create(const double *weights, uint32_t n, alias_table *table);
void alias_table_destroy(alias_table *table);

/* Asks memory for what the next draw by u needs. */
EXPECTING void alias_table_expect(const alias_table *table, uint32_t u)
{
    __builtin_prefetch(&table->cells[((uint64_t)u*table->n) >> 32]);
}

/* The index that the 32-bit fraction u draws; *rest is what is left of u, again a 32-bit fraction, with
 * log2(n/probability) fewer significant bits. */
static inline uint32_t alias_table_draw(const alias_table *table, uint32_t u, uint32_t *rest)
{
    const uint64_t scaled = (uint64_t)u*table->n;
    const uint32_t cell = (uint32_t)(scaled >> 32);
    const double coin = (double)(uint32_t)scaled*0x1p-32;
    const double kept = (double)table->cells[cell].threshold;
    const int is_kept = coin < kept;
    const double left = is_kept ? coin/kept : (coin - kept)/(1 - kept);
    *rest = (uint32_t)(left*0x1p32 < 0x1p32 - 1 ? left*0x1p32 : 0x1p32 - 1);
    return is_kept ? cell : table->cells[cell].alias;
}

#ifdef __cplusplus
}
#endif
