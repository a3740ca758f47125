/* render_watch.c: what the page of a render shows: progress as server-sent events, the picture as PNG.
 *
 * The rendering thread leaves radiance here, which takes a few milliseconds; the server's threads make the PNG of it.
 * SPDX-License-Identifier: MIT */
#include "cli/render_watch.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/interruption.h"
#include "cli/json_writer.h"
#include "cli/report.h"
#include "cli/watch_page.h"
#include "cli/web_server.h"
#include "io/image_file.h"
#include "render/view.h"

/* The last picture can be fetched for so long [10 ms]. */
enum { DEFAULT_PORT = 8642, MOST_STREAMS = 6, STEP_MS = 100, MOST_WAITS = 200 };

/* Between two pictures: so many seconds, and so many times what one costs the render. */
static const double PICTURE_STEP = 0.5, PICTURE_COST = 25;

struct render_watch {
    web_server *server;
    const render_options *options;
    pthread_mutex_t lock; /* of all that follows */
    render_progress progress;
    const char *phase;
    image picture; /* radiance */
    uint64_t version, png_version;
    char *png;
    size_t n_png;
    uint32_t n_streams;
    bool is_asked;      /* for the picture, since the last one came */
    double shown, cost; /* when the last picture came, how long it took [s] */
    watch_wish wish;
};

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* ---- Answers ------------------------------------------------------------------------------------------------- */

static bool is_over(const render_watch *w)
{
    return strcmp(w->phase, "rendering") != 0 && strcmp(w->phase, "ending") != 0;
}

/* What the page shows, on one line, the caller's to free; the caller holds the lock. */
static char *describe(const render_watch *w)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    const render_progress *p = &w->progress;
    const double by_samples = p->samples_total ? (double)p->samples_done/(double)p->samples_total : 0;
    const double whole = p->seconds + p->time_left;
    const double by_time = p->time_left >= 0 && whole > 0 ? p->seconds/whole : 0;
    json_writer j = json_put_line_start(stream);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "phase", w->phase);
    json_put_text(&j, "scene", w->options->scene_path ? w->options->scene_path : "demo");
    json_put_integer(&j, "width", w->picture.width);
    json_put_integer(&j, "height", w->picture.height);
    json_put_integer(&j, "picture", w->version);
    json_put_number(&j, "fraction", strcmp(w->phase, "finished") == 0 ? 1 : fmin(fmax(by_samples, by_time), 1));
    json_put_integer(&j, "samples", p->samples_done);
    json_put_integer(&j, "samples_total", p->samples_total);
    json_put_number(&j, "samples_per_second", round(p->samples_per_second));
    json_put_number(&j, "noise", p->noise >= 0 ? p->noise : NAN);
    json_put_number(&j, "seconds", p->seconds);
    json_put_number(&j, "seconds_left", p->time_left >= 0 ? p->time_left : NAN);
    json_put_close(&j, '}');
    fclose(stream);
    if (text) text[strcspn(text, "\n")] = 0;
    return text;
}

static void send_state(render_watch *w, web_request *request)
{
    pthread_mutex_lock(&w->lock);
    w->is_asked = true; /* tells of the picture, too */
    char *text = describe(w);
    pthread_mutex_unlock(&w->lock);
    web_send(request, text ? 200 : 503, "application/json", text, text ? strlen(text) : 0);
    free(text);
}

/* Events until the render is over, the browser leaves or the server stops; the last state is always sent. */
static void stream_states(render_watch *w, web_request *request)
{
    pthread_mutex_lock(&w->lock);
    const bool has_room = w->n_streams < MOST_STREAMS;
    w->n_streams += has_room;
    pthread_mutex_unlock(&w->lock);
    if (!has_room) {
        web_send_text(request, 503, "too many pages watch\n");
        return;
    }
    web_stream_begin(request);
    char *sent = NULL;
    int n_quiet = 0;
    for (bool is_open = true, is_there = true; is_open && is_there;) {
        pthread_mutex_lock(&w->lock);
        is_open = web_is_open(request) && !is_over(w);
        char *text = describe(w);
        pthread_mutex_unlock(&w->lock);
        if (!text) break;
        if (!sent || strcmp(sent, text) != 0 || ++n_quiet*STEP_MS >= 5000) { /* or is the browser still there? */
            is_there = web_stream_event(request, text);
            n_quiet = 0;
        }
        free(sent);
        sent = text;
        if (is_open) usleep(STEP_MS*1000);
    }
    free(sent);
    pthread_mutex_lock(&w->lock);
    w->n_streams--;
    pthread_mutex_unlock(&w->lock);
}

/* PNG of radiance; takes `linear` over. */
static bool encode(const render_options *o, image *linear, char **png, size_t *n_png)
{
    image shown = {0};
    view v = VIEW_FILMIC;
    view_find(o->view, &v);
    bool is_made = view_picture(v, (float)o->exposure.value, linear, PIXEL_U8, &shown, NULL) == FACET_OK;
    is_made = is_made && png_encode(&shown, png, n_png, NULL) == FACET_OK;
    image_destroy(&shown);
    image_destroy(linear);
    return is_made;
}

static bool copy_picture(const image *from, image *to)
{
    const size_t n_bytes = from->width*from->height*3*sizeof(float);
    *to = *from;
    to->pixels = from->pixels ? malloc(n_bytes) : NULL;
    if (to->pixels) memcpy(to->pixels, from->pixels, n_bytes);
    return to->pixels != NULL;
}

/* A copy of bytes under the lock. */
static char *copy_png(const render_watch *w, size_t *n)
{
    char *copy = w->png ? malloc(w->n_png) : NULL;
    if (copy) memcpy(copy, w->png, *n = w->n_png);
    return copy;
}

static void send_picture(render_watch *w, web_request *request)
{
    image linear;
    char *made = NULL;
    size_t n_made = 0;
    pthread_mutex_lock(&w->lock);
    w->is_asked = true;
    const uint64_t version = w->version;
    const bool is_stale = w->png_version != version && copy_picture(&w->picture, &linear);
    pthread_mutex_unlock(&w->lock);
    if (is_stale && !encode(w->options, &linear, &made, &n_made)) made = NULL;
    pthread_mutex_lock(&w->lock);
    if (made && version > w->png_version) {
        free(w->png);
        w->png = made;
        w->n_png = n_made;
        w->png_version = version;
        made = NULL;
    }
    free(made);
    made = copy_png(w, &n_made);
    pthread_mutex_unlock(&w->lock);
    if (made) web_send(request, 200, "image/png", made, n_made);
    else web_send_text(request, 404, "there is no picture yet\n");
    free(made);
}

static void take_wish(render_watch *w, web_request *request, watch_wish wish)
{
    pthread_mutex_lock(&w->lock);
    if (w->wish == WISH_GO_ON) w->wish = wish;
    if (strcmp(w->phase, "rendering") == 0) w->phase = "ending";
    pthread_mutex_unlock(&w->lock);
    web_send_text(request, 200, "as you wish\n");
}

static void answer(void *user, web_request *request)
{
    render_watch *w = user;
    const char *path = web_path(request);
    const bool is_wish = strcmp(path, "/finish") == 0 || strcmp(path, "/cancel") == 0;
    if (!web_is_method(request, is_wish ? "POST" : "GET"))
        web_send_text(request, 405, is_wish ? "only POST\n" : "only GET\n");
    else if (is_wish) take_wish(w, request, path[1] == 'f' ? WISH_FINISH : WISH_CANCEL);
    else if (strcmp(path, "/") == 0) web_send(request, 200, "text/html; charset=utf-8", watch_page, watch_page_size);
    else if (strcmp(path, "/state") == 0) send_state(w, request);
    else if (strcmp(path, "/events") == 0) stream_states(w, request);
    else if (strcmp(path, "/picture.png") == 0) send_picture(w, request);
    else web_send_text(request, 404, "there is no such page\n");
}

/* ---- The render's side --------------------------------------------------------------------------------------- */

int watch_start(const render_options *o, render_watch **watch)
{
    web_place place;
    char token[WEB_TOKEN_MOST + 1] = "";
    *watch = NULL;
    if (!o->serve) {
        if (o->serve_token || o->serve_stay)
            return fail(EXIT_USAGE, NULL, o->serve_token ? "--serve-token" : "--serve-stay", "needs --serve");
        return 0;
    }
    int status = web_place_parse("--serve", o->serve, DEFAULT_PORT, &place);
    if (!status && !place.is_loopback && !o->serve_token)
        status = fail(EXIT_USAGE, NULL, "--serve",
                      "other machines reach %s; guard it by --serve-token FILE, or give a port alone", place.host);
    if (!status && o->serve_token) status = web_token_read(o->serve_token, token);
    if (status) return status;
    render_watch *w = calloc(1, sizeof *w);
    if (!w) return fail_memory();
    w->options = o;
    w->phase = "rendering";
    w->progress = (render_progress){.noise = -1, .time_left = -1};
    pthread_mutex_init(&w->lock, NULL);
    status = web_server_start(&place, token, answer, w, &w->server);
    if (status) {
        watch_stop(w);
        return status;
    }
    *watch = w;
    if (!o->quiet) note("%s shows the picture", web_server_url(w->server));
    return 0;
}

/* Whether someone looks at an older picture than there is. */
static bool is_behind(render_watch *w)
{
    pthread_mutex_lock(&w->lock);
    const bool is_behind = w->png_version > 0 && w->png_version < w->version;
    pthread_mutex_unlock(&w->lock);
    return is_behind;
}

void watch_stop(render_watch *w)
{
    if (!w) return;
    for (int i = 0; i < MOST_WAITS && w->server && is_behind(w); i++) usleep(10000);
    web_server_stop(w->server);
    pthread_mutex_destroy(&w->lock);
    image_destroy(&w->picture);
    free(w->png);
    free(w);
}

void watch_progress(render_watch *w, const render_progress *progress)
{
    if (!w) return;
    pthread_mutex_lock(&w->lock);
    w->progress = *progress;
    pthread_mutex_unlock(&w->lock);
}

watch_wish watch_asked(render_watch *w)
{
    if (!w) return WISH_GO_ON;
    pthread_mutex_lock(&w->lock);
    const watch_wish wish = w->wish;
    pthread_mutex_unlock(&w->lock);
    return wish;
}

bool watch_wants_picture(render_watch *w)
{
    if (!w) return false;
    pthread_mutex_lock(&w->lock);
    const bool is_wanted = (w->n_streams > 0 || w->is_asked) &&
                           now() - w->shown >= fmax(PICTURE_STEP, PICTURE_COST*w->cost);
    pthread_mutex_unlock(&w->lock);
    return is_wanted;
}

void watch_show(render_watch *w, const film *f)
{
    image next;
    if (!w || !f->pixels) return;
    const double begin = now();
    if (film_develop(f, &next)) return; /* the page keeps the one before */
    pthread_mutex_lock(&w->lock);
    image_destroy(&w->picture);
    w->picture = next;
    w->version++;
    w->is_asked = false;
    w->shown = now();
    w->cost = w->shown - begin;
    pthread_mutex_unlock(&w->lock);
}

void watch_end(render_watch *w, const char *phase, const film *f)
{
    if (!w) return;
    watch_show(w, f);
    pthread_mutex_lock(&w->lock);
    w->phase = phase;
    pthread_mutex_unlock(&w->lock);
}

void watch_stay(render_watch *w)
{
    if (!w || !w->options->serve_stay || is_interrupted()) return;
    if (!w->options->quiet) note("%s shows the finished picture until Ctrl-C", web_server_url(w->server));
    while (!is_interrupted()) usleep(STEP_MS*1000);
}
