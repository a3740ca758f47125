/* crew.c: the leader of a shared render and those who follow it.
 *
 * A follower asks for units when it has few.  To add up the films the leader tells all to finish what they have
 * (FINISH), waits until they have (IDLE), and then has them come together (MEET): nobody waits inside an exchange
 * while others work.
 * SPDX-License-Identifier: MIT */
#include "render/crew.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/error.h"
#include "render/crew_part.h"

/* The first word of a message.  From followers the second is how many samples they have rendered. */
enum {
    ASK,    /* for units, for so many threads */
    IDLE,   /* all units done */
    LEAVE,  /* this process has been asked to end */
    BYE,    /* the last message */
    WORK,   /* units: the first, how many */
    FINISH, /* no more units for now */
    MEET,   /* add up the films */
    END     /* of the render */
};

/* So many units at most at once for each thread, and this part of what is left. */
enum { MOST_AT_ONCE = 8, SHARE_AT_ONCE = 4 };

/* Films are added up for the sake of the noise that people see: between so many seconds, and seldom enough to cost no
 * more than this part of the time. */
static const double LOOK_FIRST = 1, LOOK_LAST = 15, LOOK_COST = 0.02;

/* ---- Coming together ----------------------------------------------------------------------------------------- */

enum { MOST_BLOCK = 1 << 18 }; /* pixels */

facet_status crew_prepare(const crew *c, run *u, thread_pool *pool, crew_part **result)
{
    const job *j = u->job;
    const size_t n_pixels = j->plan.state->film.width*j->plan.state->film.height,
                 share = (n_pixels - 1)/c->n_ranks + 1;
    crew_part *part = calloc(1, sizeof *part);
    if (!part) return FACET_NO_MEMORY;
    part->crew = c;
    part->run = u;
    part->pool = pool;
    part->n_threads = thread_pool_size(pool);
    part->n_buffer = share < MOST_BLOCK ? share : MOST_BLOCK;
    part->buffer = malloc(part->n_buffer*sizeof *part->buffer);
    if (j->plan.state->film.features) part->feature_buffer = malloc(part->n_buffer*sizeof *part->feature_buffer);
    part->positions = malloc(j->plan.n_tiles*sizeof *part->positions);
    part->is_tile_busy = calloc(j->plan.n_tiles, sizeof *part->is_tile_busy);
    part->peers = calloc(c->n_ranks, sizeof *part->peers);
    pthread_condattr_t monotonic;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&part->lock, NULL);
    pthread_cond_init(&part->work, NULL);
    pthread_cond_init(&part->low, &monotonic);
    pthread_condattr_destroy(&monotonic);
    *result = part;
    if (j->plan.state->film.features && !part->feature_buffer) return FACET_NO_MEMORY;
    return part->buffer && part->positions && part->is_tile_busy && part->peers ? FACET_OK : FACET_NO_MEMORY;
}

void crew_unprepare(crew_part *part)
{
    if (!part) return;
    pthread_cond_destroy(&part->low);
    pthread_cond_destroy(&part->work);
    pthread_mutex_destroy(&part->lock);
    free(part->peers);
    free(part->is_tile_busy);
    free(part->positions);
    free(part->feature_buffer);
    free(part->buffer);
    free(part->ends);
    free(part);
}

/* What each rank tells the leader before the start. */
typedef struct introduction {
    facet_status status;
    uint32_t n_threads;
    uint64_t identity;
    char isa[16], name[CREW_NAME_SIZE];
    facet_error why;
} introduction;

/* The leader's judgement of a rank. */
static facet_status judge(uint32_t rank, const introduction *its, const introduction *own, facet_error *why)
{
    if (its->status)
        return facet_error_set(why, its->status, its->why.place, "on rank %u (%s): %s", rank, its->name,
                               its->why.text[0] ? its->why.text : facet_status_string(its->status));
    if (its->identity != own->identity)
        return facet_error_set(why, FACET_BAD_VALUE, "",
                               "rank %u (%s) renders another scene or has other options; give all ranks the same "
                               "command and files, or --mpi off to separate programs",
                               rank, its->name);
    if (strcmp(its->isa, own->isa) != 0)
        return facet_error_set(why, FACET_BAD_VALUE, "isa",
                               "rank %u (%s) would use %s and this one %s; name one that all processors have, such as "
                               "--isa sse4.2",
                               rank, its->name, its->isa, own->isa);
    return FACET_OK;
}

facet_status crew_agree(const crew *c, crew_part *part, facet_status status, uint64_t identity, const char *isa,
                        facet_error *why)
{
    introduction own = {.status = status, .n_threads = part ? part->n_threads : 0, .identity = identity}, its;
    struct {
        facet_status status;
        uint32_t n_threads;
    } verdict = {status, own.n_threads};
    snprintf(own.isa, sizeof own.isa, "%s", isa ? isa : "");
    snprintf(own.name, sizeof own.name, "%s", c->name);
    if (status && why) own.why = *why;
    if (c->rank > 0) c->exchange(c->user, 0, &own, sizeof own, CREW_NOBODY, NULL, 0);
    for (uint32_t from = 1; c->rank == 0 && from < c->n_ranks; from++) {
        c->exchange(c->user, CREW_NOBODY, NULL, 0, from, &its, sizeof its);
        if (!verdict.status) verdict.status = judge(from, &its, &own, why);
        verdict.n_threads += its.n_threads;
        if (part) part->peers[from].n_threads = its.n_threads;
    }
    if (!verdict.status && c->rank == 0) verdict.status = part_plan(part, verdict.n_threads);
    crew_share(c, &verdict, sizeof verdict);
    if (!verdict.status && c->rank > 0) verdict.status = part_plan(part, verdict.n_threads);
    return verdict.status;
}

/* ---- Leading ------------------------------------------------------------------------------------------------- */

static void tell_all(const crew_part *part, uint64_t what)
{
    const crew *c = part->crew;
    const uint64_t words[CREW_WORDS] = {what};
    for (uint32_t to = 1; to < c->n_ranks; to++) c->send(c->user, to, words);
}

/* Takes the messages that have come. */
static void hear(crew_part *part)
{
    const crew *c = part->crew;
    uint32_t from;
    uint64_t words[CREW_WORDS];
    while (c->receive(c->user, &from, words)) {
        crew_peer *peer = &part->peers[from];
        __atomic_fetch_add(&part->run->job->n_samples, words[1] - peer->n_samples, __ATOMIC_RELAXED);
        peer->n_samples = words[1];
        if (words[0] == ASK) peer->is_waiting = true;
        else if (words[0] == IDLE) part->n_ready++;
        else if (words[0] == BYE) part->n_left++;
        else part->run->is_wanted = false;
    }
}

/* The next units for so many threads: fewer as the end comes nearer. */
static unit_span take(crew_part *part, uint32_t n_threads)
{
    const uint64_t left = part->limit - part->next, fair = left/((uint64_t)SHARE_AT_ONCE*part->n_all_threads);
    uint64_t n = n_threads*(fair < 1 ? 1 : fair < MOST_AT_ONCE ? fair : MOST_AT_ONCE);
    if (n > left) n = left;
    const unit_span taken = {part->next, (uint32_t)n};
    part->next += n;
    return taken;
}

static void hand_out(crew_part *part)
{
    const crew *c = part->crew;
    for (uint32_t to = 1; to < c->n_ranks && part->next < part->limit; to++) {
        if (!part->peers[to].is_waiting) continue;
        part->peers[to].is_waiting = false;
        const unit_span s = take(part, part->peers[to].n_threads);
        c->send(c->user, to, (const uint64_t[CREW_WORDS]){WORK, s.first, s.n});
    }
    while (part->next < part->limit && part_is_low(part)) {
        const unit_span s = take(part, part->n_threads);
        part_push(part, s.first, s.n);
    }
}

/* The end of the pass that the next unit belongs to; itself between passes. */
static uint64_t round_up_to_pass(const crew_part *part)
{
    const job *j = part->run->job;
    uint32_t n = 0;
    while (n < j->plan.n_share && part_units_to(part, n) < part->next) n = tile_plan_pass_end(&j->plan, n);
    const uint64_t first = part_units_to(part, tile_plan_pass_end(&j->plan, 0)), end = part_units_to(part, n);
    return end > first ? end : first;
}

/* Lowers the limit where an end has been asked for or the time is up. */
static void limit_units(crew_part *part)
{
    const run *u = part->run;
    const render_settings *r = u->settings;
    uint64_t limit = part->limit;
    if (!u->is_wanted) { /* the first pass is finished, so that there is a whole picture */
        const uint64_t first = part_units_to(part, tile_plan_pass_end(&u->job->plan, 0));
        limit = part->next > first ? part->next : first;
    } else if (r->time_limit > 0 && u->seconds + run_now() - u->start >= r->time_limit) {
        limit = round_up_to_pass(part);
    }
    if (limit < part->limit) part->limit = limit;
}

static bool is_look_due(const crew_part *part)
{
    const run *u = part->run;
    if (run_is_save_due(u)) return true;
    if (!u->settings->progress) return false;
    const double elapsed = part->looked - u->start, wait = fmin(fmax(elapsed, LOOK_FIRST), LOOK_LAST);
    return run_now() - part->looked >= fmax(wait, part->looking/LOOK_COST);
}

static void tell_sometimes(run *u)
{
    if (run_now() - u->told >= PROGRESS_INTERVAL) run_tell(u);
}

/* Hands out units until all that may be are, or it is time to look at the whole film. */
static void lead_work(crew_part *part)
{
    for (;;) {
        hear(part);
        limit_units(part);
        hand_out(part);
        if (part->next >= part->limit || is_look_due(part)) return;
        tell_sometimes(part->run);
        part_pause(part);
    }
}

/* Tells all which tiles get no more samples, as the leader, who has all sums, has judged. */
static void share_done(const crew_part *part)
{
    const tile_plan *plan = &part->run->job->plan;
    if (plan->noise_target > 0) crew_share(part->crew, plan->is_done, plan->n_tiles*sizeof *plan->is_done);
}

/* Adds up what all have rendered. */
static void look(crew_part *part)
{
    run *u = part->run;
    const double begin = run_now();
    part->n_ready = 0;
    tell_all(part, FINISH);
    while (part->n_ready < part->crew->n_ranks - 1 || !part_is_idle(part)) {
        hear(part);
        tell_sometimes(u);
        part_pause(part);
    }
    tell_all(part, MEET);
    for (uint32_t i = 0; i < part->crew->n_ranks; i++) part->peers[i].is_waiting = false;
    run_collect(u);
    part_add_states(part);
    run_look(u);
    share_done(part);
    part->looked = run_now();
    part->looking = part->looked - begin;
}

/* Up to which unit work may be handed out: the next pass if the noise after it decides, else all. */
static uint64_t next_limit(const crew_part *part)
{
    const job *j = part->run->job;
    const uint32_t spp = j->plan.state->spp;
    return part->run->settings->noise_target > 0 ? part_units_to(part, tile_plan_pass_end(&j->plan, spp))
                                                 : part->n_units;
}

static void lead(crew_part *part)
{
    run *u = part->run;
    job *j = u->job;
    run_look(u);
    share_done(part);
    part->next = part_units_to(part, j->plan.state->spp);
    part->looked = u->start;
    while (!run_is_over(u)) {
        part->limit = next_limit(part);
        lead_work(part);
        look(part);
        if (u->settings->save && run_is_save_due(u)) {
            u->settings->save(u->settings->user, j->plan.state);
            u->saved = run_now();
        }
    }
    tell_all(part, END);
    while (part->n_left < part->crew->n_ranks - 1) {
        hear(part);
        part_pause(part);
    }
    run_tell(u);
}

/* ---- Following ----------------------------------------------------------------------------------------------- */

static void say(const crew_part *part, uint64_t what)
{
    const crew *c = part->crew;
    const uint64_t n = __atomic_load_n(&part->run->job->n_samples, __ATOMIC_RELAXED);
    c->send(c->user, 0, (const uint64_t[CREW_WORDS]){what, n, part->n_threads});
}

/* Whether a follower has asked, has to finish, has told that it is idle, has told that it wants to leave. */
typedef struct follower {
    bool has_asked, is_finishing, is_idle, is_leaving;
} follower;

/* Does as the leader says; false at the end. */
static bool obey(crew_part *part, follower *f, const uint64_t words[CREW_WORDS])
{
    switch (words[0]) {
    case WORK:
        part_push(part, words[1], (uint32_t)words[2]);
        f->has_asked = false;
        break;
    case FINISH: f->is_finishing = true; break;
    case MEET:
        run_collect(part->run);
        part_add_states(part);
        share_done(part);
        *f = (follower){.is_leaving = f->is_leaving};
        break;
    default: say(part, BYE); return false;
    }
    return true;
}

static void follow(crew_part *part)
{
    run *u = part->run;
    const crew *c = part->crew;
    follower f = {0};
    uint32_t from;
    uint64_t words[CREW_WORDS];
    share_done(part);
    for (;;) {
        while (c->receive(c->user, &from, words))
            if (!obey(part, &f, words)) return;
        if (f.is_finishing && !f.is_idle && part_is_idle(part)) {
            f.is_idle = true;
            say(part, IDLE);
        } else if (!f.is_finishing && !f.has_asked && part_is_low(part)) {
            f.has_asked = true;
            say(part, ASK);
        }
        tell_sometimes(u);
        if (!u->is_wanted && !f.is_leaving) {
            f.is_leaving = true;
            say(part, LEAVE);
        }
        part_pause(part);
    }
}

void crew_run(crew_part *part)
{
    job *j = part->run->job;
    for (uint32_t i = 0; i < j->plan.n_tiles; i++)
        part->positions[i] = tile_plan_position(&j->plan, tile_plan_at(&j->plan, i));
    crew_share(part->crew, part->positions, j->plan.n_tiles*sizeof *part->positions);
    thread_pool_start(part->pool, part_work, part, part->n_threads);
    if (part->crew->rank == 0) lead(part);
    else follow(part);
    part_end(part);
    while (!thread_pool_wait(part->pool, PROGRESS_INTERVAL)) continue;
}
