/* crew_films.c: the films and figures of all ranks, added up.
 *
 * A film's pixels are divided among the ranks.  Each rank sends every other its samples of that one's pixels, the owner
 * adds them and sends the sums to the leader: each sends and gets about one film, however many ranks there are, and
 * blocks without samples are not sent.  This goes in rounds, so that the memory for it stays small.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "render/crew_part.h"

void crew_share(const crew *c, void *bytes, size_t n)
{
    if (c->rank > 0) c->exchange(c->user, CREW_NOBODY, NULL, 0, 0, bytes, n);
    for (uint32_t to = 1; c->rank == 0 && to < c->n_ranks; to++)
        c->exchange(c->user, to, bytes, n, CREW_NOBODY, NULL, 0);
}

/* ---- Pixels -------------------------------------------------------------------------------------------------- */

/* The pixels of a film that a rank owns in this round. */
typedef struct block {
    film_pixel *pixels;
    film_features *features; /* or NULL */
    size_t n;
} block;

static block block_of(const crew_part *part, film *f, size_t begin, uint32_t owner)
{
    const size_t n_pixels = f->width*f->height, first = begin + owner*part->n_buffer;
    const size_t left = first < n_pixels ? n_pixels - first : 0;
    const size_t at = left ? first : 0;
    return (block){f->pixels + at, f->features ? f->features + at : NULL,
                   left < part->n_buffer ? left : part->n_buffer};
}

static bool has_samples(block b)
{
    for (size_t i = 0; i < b.n; i++)
        if (b.pixels[i].n) return true;
    return false;
}

/* Sends a block of ours, which is empty then, and adds the block that comes from another rank to ours of its kind. */
static void pass_block(crew_part *part, uint32_t to, block sent, uint32_t from, block sum)
{
    const crew *c = part->crew;
    const size_t n = to != CREW_NOBODY && has_samples(sent) ? sent.n : 0;
    const size_t n_bytes = c->exchange(c->user, to, sent.pixels, n*sizeof *sent.pixels, from, part->buffer,
                                       sum.n*sizeof *sum.pixels);
    if (sent.features || sum.features)
        c->exchange(c->user, to, sent.features, n*sizeof *sent.features, from, part->feature_buffer,
                    sum.n*sizeof *sum.features);
    if (n) memset(sent.pixels, 0, n*sizeof *sent.pixels);
    if (n && sent.features) memset(sent.features, 0, n*sizeof *sent.features);
    const film other = {
        .width = n_bytes/sizeof *part->buffer, .height = 1, .pixels = part->buffer, .features = part->feature_buffer};
    film ours = {.width = other.width, .height = 1, .pixels = sum.pixels, .features = sum.features};
    film_merge(&ours, &other);
}

/* The leader's own samples stay where they are: in its film. */
static void add_films(crew_part *part)
{
    const crew *c = part->crew;
    film *f = &part->run->job->plan.state->film;
    const uint32_t n = c->n_ranks, own = c->rank;
    for (size_t begin = 0; begin < f->width*f->height; begin += n*part->n_buffer) {
        const block ours = block_of(part, f, begin, own), none = {part->buffer, part->feature_buffer, 0};
        for (uint32_t step = 1; step < n; step++) {
            const uint32_t to = (own + step)%n, from = (own + n - step)%n;
            pass_block(part, own ? to : CREW_NOBODY, own ? block_of(part, f, begin, to) : none,
                       from ? from : CREW_NOBODY, from ? ours : none);
        }
        if (own) pass_block(part, 0, ours, CREW_NOBODY, none);
        for (uint32_t from = 1; own == 0 && from < n; from++)
            pass_block(part, CREW_NOBODY, none, from, block_of(part, f, begin, from));
    }
}

/* ---- Figures ------------------------------------------------------------------------------------------------- */

/* A state without its film, and without time: the leader's clock counts. */
static render_state figures_of(const render_state *state)
{
    render_state figures = *state;
    figures.film = (film){.n_clamped = state->film.n_clamped};
    figures.seconds = 0;
    figures.spp = 0;
    figures.isa = NULL;
    return figures;
}

void part_add_states(crew_part *part)
{
    const crew *c = part->crew;
    run *u = part->run;
    render_state *state = u->job->plan.state, figures;
    add_films(part);
    if (c->rank > 0) { /* what was sent does not count again */
        figures = figures_of(state);
        c->exchange(c->user, 0, &figures, sizeof figures, CREW_NOBODY, NULL, 0);
        u->cpu_seconds -= state->cpu_seconds;
        film emptied = state->film;
        emptied.n_clamped = 0;
        *state = (render_state){.film = emptied, .isa = state->isa};
    }
    for (uint32_t from = 1; c->rank == 0 && from < c->n_ranks; from++) {
        c->exchange(c->user, CREW_NOBODY, NULL, 0, from, &figures, sizeof figures);
        u->cpu_seconds += figures.cpu_seconds;
        film whole = state->film; /* its pixels have been added */
        state->film = (film){.n_clamped = whole.n_clamped};
        render_state_merge(state, &figures);
        whole.n_clamped = state->film.n_clamped;
        state->film = whole;
    }
}
