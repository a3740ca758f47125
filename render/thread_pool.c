/* thread_pool.c: a persistent pool of POSIX threads.
 * SPDX-License-Identifier: MIT */
#include "render/thread_pool.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

struct thread_pool {
    pthread_mutex_t lock;
    pthread_cond_t work, done; /* something to do; a job has ended */
    thread_pool_job *job;
    void *user;
    uint32_t next, n_pieces, n_active; /* pieces not yet taken; threads inside a piece */
    uint32_t n_threads, n_numbered;
    bool is_stopping;
    void (*prepare)(void);
    pthread_t *threads;
};

static void *run_thread(void *argument)
{
    thread_pool *pool = argument;
    if (pool->prepare) pool->prepare();
    pthread_mutex_lock(&pool->lock);
    const uint32_t number = pool->n_numbered++;
    for (;;) {
        while (!pool->is_stopping && pool->next >= pool->n_pieces) pthread_cond_wait(&pool->work, &pool->lock);
        if (pool->is_stopping) break;
        const uint32_t piece = pool->next++;
        pool->n_active++;
        pthread_mutex_unlock(&pool->lock);
        pool->job(pool->user, piece, number);
        pthread_mutex_lock(&pool->lock);
        pool->n_active--;
        if (pool->n_active == 0 && pool->next >= pool->n_pieces) pthread_cond_broadcast(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

facet_status thread_pool_create(uint32_t n_threads, void (*prepare)(void), thread_pool **result)
{
    thread_pool *pool = calloc(1, sizeof *pool);
    if (!pool) return FACET_NO_MEMORY;
    pool->prepare = prepare;
    pool->threads = calloc(n_threads, sizeof *pool->threads);
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&pool->done, &monotonic);
    pthread_condattr_destroy(&monotonic);
    while (pool->threads && pool->n_threads < n_threads &&
           pthread_create(&pool->threads[pool->n_threads], NULL, run_thread, pool) == 0)
        pool->n_threads++;
    if (pool->n_threads == 0) {
        thread_pool_destroy(pool);
        return FACET_NO_MEMORY;
    }
    *result = pool;
    return FACET_OK;
}

void thread_pool_destroy(thread_pool *pool)
{
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->is_stopping = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->n_threads; i++) pthread_join(pool->threads[i], NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->work);
    pthread_mutex_destroy(&pool->lock);
    free(pool->threads);
    free(pool);
}

uint32_t thread_pool_size(const thread_pool *pool)
{
    return pool->n_threads;
}

void thread_pool_start(thread_pool *pool, thread_pool_job *job, void *user, uint32_t n_pieces)
{
    pthread_mutex_lock(&pool->lock);
    pool->job = job;
    pool->user = user;
    pool->next = 0;
    pool->n_pieces = n_pieces;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
}

bool thread_pool_wait(thread_pool *pool, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    const long whole = (long)seconds;
    until.tv_sec += whole;
    until.tv_nsec += (long)((seconds - (double)whole)*1e9);
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
    pthread_mutex_lock(&pool->lock);
    int waited = 0;
    while ((pool->n_active || pool->next < pool->n_pieces) && waited != ETIMEDOUT)
        waited = pthread_cond_timedwait(&pool->done, &pool->lock, &until);
    const bool is_done = !pool->n_active && pool->next >= pool->n_pieces;
    pthread_mutex_unlock(&pool->lock);
    return is_done;
}

void thread_pool_cancel(thread_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    pool->next = pool->n_pieces;
    if (pool->n_active == 0) pthread_cond_broadcast(&pool->done);
    pthread_mutex_unlock(&pool->lock);
}

uint32_t thread_pool_default_size(void)
{
    const long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (uint32_t)n : 1;
}
