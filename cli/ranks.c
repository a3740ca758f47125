/* ranks.c: what does not need MPI of renders by several processes.
 * SPDX-License-Identifier: MIT */
#include "cli/ranks.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/report.h"

/* A number in the environment. */
static bool find_number(const char *name, uint32_t *number)
{
    const char *text = getenv(name);
    if (!text || !isdigit((unsigned char)text[0])) return false;
    *number = (uint32_t)strtoul(text, NULL, 10);
    return true;
}

bool find_launch(launch *found)
{
    static const char *const names[][2] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, /* Open MPI */
                                           {"PMI_RANK", "PMI_SIZE"},       /* MPICH and its kin; Slurm */
                                           {"PMIX_RANK", "SLURM_NTASKS"}}; /* Slurm */
    *found = (launch){0};
    for (size_t i = 0; i < sizeof names/sizeof *names; i++) {
        if (!find_number(names[i][0], &found->rank)) continue;
        find_number(names[i][1], &found->n_ranks);
        return found->n_ranks != 1;
    }
    return false;
}

/* How far a rank has come. */
typedef struct standing {
    int status;
    char name[CREW_NAME_SIZE], error[1024];
} standing;

int ranks_agree(const crew *c, int status, const char *error)
{
    standing own = {.status = status}, its;
    snprintf(own.name, sizeof own.name, "%s", c->name);
    snprintf(own.error, sizeof own.error, "%s", error);
    if (c->rank > 0) c->exchange(c->user, 0, &own, sizeof own, CREW_NOBODY, NULL, 0);
    for (uint32_t from = 1; c->rank == 0 && from < c->n_ranks; from++) {
        c->exchange(c->user, CREW_NOBODY, NULL, 0, from, &its, sizeof its);
        if (!status && its.status)
            status = fail(its.status, NULL, NULL, "on rank %u (%s): %s", from, its.name, its.error);
    }
    crew_share(c, &status, sizeof status);
    return status;
}
