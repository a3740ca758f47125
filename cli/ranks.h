/* ranks.h: the processes of one `mpirun facet render ...`.
 *
 * Rank 0 leads: it alone reads checkpoints, writes files and speaks; the others keep silent, and an error of theirs
 * is told by it.  mpi_ranks.c is the only file that calls MPI, in a module that is loaded when it is needed.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "render/crew.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the environment says of who started this process: mpirun of MPICH or Open MPI, srun, ... */
typedef struct launch {
    uint32_t rank, n_ranks; /* n_ranks 0: not said */
} launch;

/* False without such a launcher, or if it started one process alone. */
bool find_launch(launch *found);

/* The exit status of all: that of rank 0, else of another, whose error rank 0 then prints.  Called by all. */
int ranks_agree(const crew *c, int status, const char *error);

/* ---- With MPI ---------------------------------------------------------------------------------------------------- */

/* Fills *c.  Returns 0, or the exit status of the error that it printed. */
int ranks_start(crew *c, const launch *by);

/* Threads for each rank, so that those of one machine share the processors that they may use.  Called by all. */
uint32_t ranks_threads(void);

/* When the ranks have no more to say to each other; all but the leader may end here. */
void ranks_part(void);

/* When the program is about to end with this status; it may do so here. */
void ranks_end(int status);

#ifdef __cplusplus
}
#endif
