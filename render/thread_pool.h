/* thread_pool.h: threads that stay, and jobs cut into numbered pieces.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct thread_pool thread_pool;

/* Does one piece of a job on the thread numbered `thread`. */
typedef void thread_pool_job(void *user, uint32_t piece, uint32_t thread);

/* n_threads >= 1 threads are started; each calls prepare once (may be NULL). */
facet_status thread_pool_create(uint32_t n_threads, void (*prepare)(void), thread_pool **result);
void thread_pool_destroy(thread_pool *pool);

uint32_t thread_pool_size(const thread_pool *pool);

/* Starts pieces 0 .. n_pieces - 1, taken in order by whichever thread is free.  One job at a time. */
void thread_pool_start(thread_pool *pool, thread_pool_job *job, void *user, uint32_t n_pieces);

/* Waits for the job, at most so long; true when it is done. */
bool thread_pool_wait(thread_pool *pool, double seconds);

/* Lets the pieces under way finish and drops the others. */
void thread_pool_cancel(thread_pool *pool);

/* One thread per processor that this process may use. */
uint32_t thread_pool_default_size(void);

#ifdef __cplusplus
}
#endif
