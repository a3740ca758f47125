/* no_ranks.c: a build without MPI renders in one process.
 * SPDX-License-Identifier: MIT */
#include "cli/ranks.h"
#include "cli/report.h"

int ranks_start(crew *c, const launch *by)
{
    *c = (crew){.n_ranks = 1};
    return by->rank ? EXIT_USAGE
                    : fail(EXIT_USAGE, NULL, NULL,
                           "facet was built without MPI; build it with Debian's libmpich-dev, divide the work by "
                           "--shard K/N, or render separately with --mpi off");
}

uint32_t ranks_threads(void)
{
    return 0;
}

void ranks_part(void)
{
}

void ranks_end(int status)
{
    (void)status;
}
