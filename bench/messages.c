/* messages.c: what the messages of a shared render cost, for tools/simulate_ranks.py: how many requests for work the
 * leader can answer, how fast pixels travel and how fast they are added up.
 *
 *     mpirun -n 3 build/release/bench/messages
 *
 * Built where MPI is.
 * SPDX-License-Identifier: MIT */
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "render/film.h"

enum { N_REQUESTS = 100000, N_ROUNDS = 20, N_PIXELS = 1 << 18, WORDS = 4 };

/* Every other rank asks and waits for its answer, again and again; the leader serves whoever asks.  As crew.c and
 * mpi_ranks.c do it.  [s] for each request */
static double time_requests(int rank, int n_ranks)
{
    uint64_t words[WORDS] = {0};
    const double begin = MPI_Wtime();
    for (int i = 0; rank > 0 && i < N_REQUESTS; i++) {
        MPI_Send(words, WORDS, MPI_UINT64_T, 0, 1, MPI_COMM_WORLD);
        MPI_Recv(words, WORDS, MPI_UINT64_T, 0, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
    for (int left = (n_ranks - 1)*N_REQUESTS; rank == 0 && left > 0;) {
        int is_there;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, 1, MPI_COMM_WORLD, &is_there, &status);
        if (!is_there) continue;
        MPI_Recv(words, WORDS, MPI_UINT64_T, status.MPI_SOURCE, 1, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        MPI_Send(words, WORDS, MPI_UINT64_T, status.MPI_SOURCE, 1, MPI_COMM_WORLD);
        left--;
    }
    return (MPI_Wtime() - begin)/((double)(n_ranks - 1)*N_REQUESTS);
}

/* Blocks of pixels from rank 1 to rank 0.  [s] for each pixel */
static double time_pixels(int rank, film *f)
{
    const int n_bytes = (int)(N_PIXELS*sizeof *f->pixels);
    const double begin = MPI_Wtime();
    for (int i = 0; i < N_ROUNDS; i++) {
        if (rank == 1) MPI_Send(f->pixels, n_bytes, MPI_BYTE, 0, 2, MPI_COMM_WORLD);
        if (rank == 0) MPI_Recv(f->pixels, n_bytes, MPI_BYTE, 1, 2, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    }
    return (MPI_Wtime() - begin)/((double)N_ROUNDS*N_PIXELS);
}

static double time_sums(film *sum, const film *f)
{
    const double begin = MPI_Wtime();
    for (int i = 0; i < N_ROUNDS; i++) film_merge(sum, f);
    return (MPI_Wtime() - begin)/((double)N_ROUNDS*N_PIXELS);
}

int main(int argc, char **argv)
{
    int rank, n_ranks;
    film f, sum;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    if (n_ranks < 2 || film_create(512, N_PIXELS/512, &f) || film_create(512, N_PIXELS/512, &sum)) {
        printf("needs at least two ranks: mpirun -n 3 %s\n", argv[0]);
        MPI_Finalize();
        return 0;
    }
    const double request = time_requests(rank, n_ranks);
    MPI_Barrier(MPI_COMM_WORLD);
    const double pixel = time_pixels(rank, &f);
    if (rank == 0) {
        const double added = time_sums(&sum, &f);
        printf("request %.3g us, answered by one leader to %d others\n", 1e6*request, n_ranks - 1);
        printf("pixel sent %.3g ns (%.3g GB/s), added %.3g ns\n", 1e9*pixel, 1e-9*(double)sizeof *f.pixels/pixel,
               1e9*added);
    }
    film_destroy(&f);
    film_destroy(&sum);
    MPI_Finalize();
    return 0;
}
