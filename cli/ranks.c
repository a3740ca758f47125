/* ranks.c: what does not need MPI of renders by several processes.
 * SPDX-License-Identifier: MIT */
#include "cli/ranks.h"

#include <ctype.h>
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/ranks_module.h"
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

/* ---- The module ---------------------------------------------------------------------------------------------- */

/* Set once, at the start. */
static const ranks_module *module;

/* facet_mpi.so lies beside the program, or where the program was installed: ../lib/.../facet. */
static void *open_module(void)
{
    static const char *const places[] = {"facet_mpi.so", "../" FACET_MODULES "/facet_mpi.so"};
    char path[PATH_MAX + 64];
    const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX);
    char *name = n > 0 ? memrchr(path, '/', (size_t)n) : NULL;
    void *handle = NULL;
    for (size_t i = 0; name && !handle && i < sizeof places/sizeof *places; i++) {
        snprintf(name + 1, 64, "%s", places[i]);
        if (access(path, R_OK) == 0) handle = dlopen(path, RTLD_NOW | RTLD_GLOBAL); /* Open MPI has modules, too */
    }
    return handle;
}

int ranks_start(crew *c, const launch *by)
{
    char error[512] = "";
    void *handle = open_module();
    module = handle ? dlsym(handle, "facet_ranks_module") : NULL;
    if (!module)
        return fail(EXIT_USAGE, NULL, NULL,
                    "facet was built without MPI; build it with Debian's libmpich-dev, divide the work by --shard K/N, "
                    "or render separately with --mpi off");
    const int status = module->start(c, by, error, sizeof error);
    return status ? fail(status, NULL, NULL, "%s", error) : 0;
}

uint32_t ranks_threads(void)
{
    return module->count_threads();
}

void ranks_part(void)
{
    if (module) module->part();
}

void ranks_end(int status)
{
    if (module) module->end(status);
}
