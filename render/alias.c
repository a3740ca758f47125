/* alias.c: building alias tables.
 * SPDX-License-Identifier: MIT */
#include "render/alias.h"

#include <stdlib.h>

facet_status alias_table_create(const double *weights, uint32_t n, alias_table *table)
{
    alias_cell *cells = malloc(n*sizeof *cells);
    double *scaled = malloc(n*sizeof *scaled);
    uint32_t *work = malloc(n*sizeof *work); /* the poor from the front, the rich from the back */
    facet_status status = FACET_NO_MEMORY;
    if (!cells || !scaled || !work) goto done;
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += weights[i];
    uint32_t n_poor = 0, n_rich = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double p = sum > 0 ? weights[i]/sum : 1.0/n;
        scaled[i] = p*n;
        cells[i] = (alias_cell){.probability = (float)p, .threshold = 1, .alias = i};
        if (scaled[i] < 1) work[n_poor++] = i;
        else work[n - ++n_rich] = i;
    }
    while (n_poor && n_rich) {
        const uint32_t poor = work[--n_poor], rich = work[n - n_rich];
        cells[poor].threshold = (float)scaled[poor];
        cells[poor].alias = rich;
        scaled[rich] -= 1 - scaled[poor];
        if (scaled[rich] < 1) {
            n_rich--;
            work[n_poor++] = rich;
        }
    }
    *table = (alias_table){.cells = cells, .n = n};
    cells = NULL;
    status = FACET_OK;
done:
    free(work);
    free(scaled);
    free(cells);
    return status;
}

void alias_table_destroy(alias_table *table)
{
    free(table->cells);
    *table = (alias_table){0};
}
