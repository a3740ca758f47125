/* events.c: what happens to a render, one JSON object a line.
 * SPDX-License-Identifier: MIT */
#include "cli/events.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <time.h>

#include "cli/json_writer.h"
#include "cli/report.h"

static const double PROGRESS_STEP = 1; /* [s] */

int events_open(event_log *log, const char *path)
{
    *log = (event_log){.path = path, .told = -PROGRESS_STEP};
    if (!path) return 0;
    log->stream = strcmp(path, "-") == 0 ? stderr : fopen(path, "a");
    return log->stream ? 0 : fail(EXIT_WORLD, path, NULL, "cannot be opened: %s", strerror(errno));
}

void events_close(event_log *log)
{
    if (log->stream && log->stream != stderr) fclose(log->stream);
    log->stream = NULL;
}

/* NaN, which JSON shows as null, for what is not known. */
static double known(double value)
{
    return value >= 0 ? value : NAN;
}

static double to_milliseconds(double seconds)
{
    return round(1e3*seconds)/1e3;
}

static json_writer begin(const event_log *log, const char *name)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    json_writer j = json_put_line_start(log->stream);
    json_put_open(&j, NULL, '{');
    json_put_text(&j, "event", name);
    json_put_number(&j, "time", to_milliseconds((double)now.tv_sec + 1e-9*(double)now.tv_nsec));
    return j;
}

/* A watcher that has gone away does not disturb the render; a disk that is full is told of once. */
static void end(event_log *log, json_writer *j)
{
    json_put_close(j, '}');
    const bool is_written = fflush(log->stream) == 0 && !ferror(log->stream);
    if (is_written || errno == EPIPE || log->is_lost) return;
    log->is_lost = true;
    warn("%s: events cannot be written: %s; the render goes on", log->path, strerror(errno));
}

void events_start(event_log *log, const render_options *o, const render_settings *settings, const render_state *state)
{
    if (!log->stream) return;
    json_writer j = begin(log, "start");
    json_put_text(&j, "version", facet_version());
    json_put_text(&j, "command", o->command_line);
    json_put_integer(&j, "width", settings->crop_w ? settings->crop_w : settings->width);
    json_put_integer(&j, "height", settings->crop_h ? settings->crop_h : settings->height);
    json_put_integer(&j, "spp", settings->spp);
    json_put_integer(&j, "shard", settings->n_shards ? settings->shard : 1);
    json_put_integer(&j, "shards", settings->n_shards ? settings->n_shards : 1);
    json_put_integer(&j, "ranks", settings->crew ? settings->crew->n_ranks : 1);
    json_put_integer(&j, "resumed_spp", state->spp);
    end(log, &j);
}

void events_progress(event_log *log, const render_progress *progress)
{
    if (!log->stream || progress->seconds - log->told < PROGRESS_STEP) return;
    log->told = progress->seconds;
    json_writer j = begin(log, "progress");
    json_put_integer(&j, "samples", progress->samples_done);
    json_put_integer(&j, "samples_total", progress->samples_total);
    json_put_number(&j, "samples_per_second", round(progress->samples_per_second));
    json_put_number(&j, "noise", known(progress->noise));
    json_put_number(&j, "seconds", to_milliseconds(progress->seconds));
    json_put_number(&j, "seconds_left", to_milliseconds(known(progress->time_left)));
    end(log, &j);
}

void events_checkpoint(event_log *log, const char *path, const render_state *state, bool is_written)
{
    if (!log->stream) return;
    json_writer j = begin(log, "checkpoint");
    json_put_text(&j, "file", path);
    json_put_bool(&j, "written", is_written);
    json_put_integer(&j, "spp", state->spp);
    end(log, &j);
}

void events_warning(event_log *log, const char *text)
{
    if (!log->stream) return;
    json_writer j = begin(log, "warning");
    json_put_text(&j, "text", text);
    end(log, &j);
}

void events_done(event_log *log, const render_options *o, const render_result *result, int status)
{
    if (!log->stream) return;
    json_writer j = begin(log, "done");
    json_put_integer(&j, "status", (uint64_t)status);
    json_put_integer(&j, "spp", result->spp);
    json_put_bool(&j, "complete", result->is_complete);
    json_put_number(&j, "noise", result->spp ? known(result->noise) : NAN);
    json_put_number(&j, "seconds", to_milliseconds(result->seconds));
    json_put_open(&j, "outputs", '[');
    for (size_t i = 0; i < o->outputs.n; i++) json_put_text(&j, NULL, o->outputs.items[i]);
    json_put_close(&j, ']');
    end(log, &j);
}
