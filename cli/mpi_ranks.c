/* mpi_ranks.c: a crew (render/crew.h) whose messages travel by MPI.  The only file that calls MPI; a module of its own,
 * which ranks.c loads when it is needed, since an MPI's libraries take over signals as soon as they are there.  Any
 * error inside MPI ends all ranks, which is MPI's default.
 * SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* sched_getaffinity */
#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/ranks_module.h"
#include "cli/report.h"

enum { SHORT_MESSAGE = 1, BYTES = 2 }; /* tags */

static int to_mpi(uint32_t rank)
{
    return rank == CREW_NOBODY ? MPI_PROC_NULL : (int)rank;
}

/* Short messages are below any MPI's limit for sending at once. */
static void send(void *user, uint32_t to, const uint64_t words[CREW_WORDS])
{
    (void)user;
    MPI_Send(words, CREW_WORDS, MPI_UINT64_T, to_mpi(to), SHORT_MESSAGE, MPI_COMM_WORLD);
}

static bool receive(void *user, uint32_t *from, uint64_t words[CREW_WORDS])
{
    int is_there = 0;
    MPI_Status status;
    (void)user;
    MPI_Iprobe(MPI_ANY_SOURCE, SHORT_MESSAGE, MPI_COMM_WORLD, &is_there, &status);
    if (!is_there) return false;
    *from = (uint32_t)status.MPI_SOURCE;
    MPI_Recv(words, CREW_WORDS, MPI_UINT64_T, status.MPI_SOURCE, SHORT_MESSAGE, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return true;
}

static size_t exchange(void *user, uint32_t to, const void *bytes, size_t n, uint32_t from, void *buffer, size_t most)
{
    MPI_Status status;
    int count = 0;
    (void)user;
    MPI_Sendrecv(bytes, (int)n, MPI_BYTE, to_mpi(to), BYTES, buffer, (int)most, MPI_BYTE, to_mpi(from), BYTES,
                 MPI_COMM_WORLD, &status);
    if (from != CREW_NOBODY) MPI_Get_count(&status, MPI_BYTE, &count);
    return (size_t)count;
}

/* The first line of what the library calls itself. */
static void name_library(char name[MPI_MAX_LIBRARY_VERSION_STRING])
{
    int length = 0;
    MPI_Get_library_version(name, &length);
    name[strcspn(name, ",\n")] = 0;
    for (char *c = name; *c; c++)
        if (*c == '\t') *c = ' ';
}

static int start(crew *c, const launch *by, char *error, size_t size)
{
    int provided, rank, n_ranks;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    *c = (crew){
        .rank = (uint32_t)rank, .n_ranks = (uint32_t)n_ranks, .send = send, .receive = receive, .exchange = exchange};
    if (gethostname(c->name, sizeof c->name)) snprintf(c->name, sizeof c->name, "?");
    c->name[sizeof c->name - 1] = 0;
    if (provided < MPI_THREAD_FUNNELED) {
        snprintf(error, size, "this MPI does not allow threads; use one that has MPI_THREAD_FUNNELED");
        return EXIT_WORLD;
    }
    if (by->n_ranks > 1 && n_ranks == 1) { /* every process believes to be alone */
        char library[MPI_MAX_LIBRARY_VERSION_STRING];
        name_library(library);
        snprintf(error, size,
                 "started as one of %u processes by another MPI than facet's, which is %s; start it with that one's "
                 "mpirun, or give --mpi off",
                 by->n_ranks, library);
        return EXIT_USAGE;
    }
    return 0;
}

/* Whether two sets of processors have one in common. */
static bool do_meet(const cpu_set_t *a, const cpu_set_t *b)
{
    cpu_set_t both;
    CPU_AND(&both, a, b);
    return CPU_COUNT(&both) > 0;
}

static uint32_t count_threads(void)
{
    MPI_Comm machine;
    int n_here, n_sharing = 0;
    cpu_set_t own;
    CPU_ZERO(&own);
    if (sched_getaffinity(0, sizeof own, &own)) CPU_SET(0, &own);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &n_here);
    cpu_set_t *all = calloc((size_t)n_here, sizeof *all);
    if (!all) MPI_Abort(MPI_COMM_WORLD, EXIT_WORLD);
    MPI_Allgather(&own, sizeof own, MPI_BYTE, all, sizeof own, MPI_BYTE, machine);
    for (int i = 0; i < n_here; i++) n_sharing += do_meet(&own, &all[i]);
    free(all);
    MPI_Comm_free(&machine);
    const int n = CPU_COUNT(&own)/(n_sharing ? n_sharing : 1);
    return n > 1 ? (uint32_t)n : 1;
}

/* MPICH before 4.2 may wait for ever in MPI_Finalize: over a network, a process that has got into its last barrier no
 * longer answers one that still closes its connections (pmodels/mpich, pull request 6596).  There, the leader ends all
 * at once when it has written everything. */
#if defined(MPICH_NUMVERSION) && MPICH_NUMVERSION < 40200000
enum { CAN_FINALIZE = false };
#else
enum { CAN_FINALIZE = true };
#endif

static bool is_under_way(void)
{
    int has_begun, has_ended;
    MPI_Initialized(&has_begun);
    MPI_Finalized(&has_ended);
    return has_begun && !has_ended;
}

static int count_ranks(int *rank)
{
    int n_ranks;
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    return n_ranks;
}

static void part(void)
{
    int rank;
    if (!is_under_way()) return;
    if (CAN_FINALIZE || count_ranks(&rank) == 1) MPI_Finalize();
    else
        while (rank > 0) pause(); /* until the leader ends the job */
}

/* MPI_Abort loses what is still on its way to the terminal: the pipes must be empty, and mpirun's helper, which passes
 * on what it has read, gets some time for that. */
static void drain(void)
{
    for (int stream = STDOUT_FILENO; stream <= STDERR_FILENO; stream++) {
        int n_left = 0;
        for (int i = 0; i < 1000 && ioctl(stream, FIONREAD, &n_left) == 0 && n_left > 0; i++) usleep(1000);
    }
    usleep(200000);
}

static void end(int status)
{
    part();
    if (!is_under_way()) return;
    fflush(NULL);
    drain();
    if (!freopen("/dev/null", "w", stderr)) return; /* MPI_Abort would tell of itself */
    MPI_Abort(MPI_COMM_WORLD, status);
}

const ranks_module facet_ranks_module = {start, count_threads, part, end};
