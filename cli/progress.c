/* progress.c: the progress bar and its plain form.
 * SPDX-License-Identifier: MIT */
#include "progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { LINE_STEP = 10, BAR_MAX = 40 };

progress progress_start(bool is_quiet)
{
    const char *terminal = getenv("TERM");
    const bool can_redraw = isatty(STDERR_FILENO) && terminal && strcmp(terminal, "dumb") != 0;
    return (progress){.is_quiet = is_quiet, .is_terminal = can_redraw, .next_line = LINE_STEP};
}

void format_duration(double seconds, char *text, size_t size)
{
    if (!(seconds < 1e9)) seconds = 1e9;
    const long whole = lround(seconds);
    if (seconds < 10) snprintf(text, size, "%.1f s", seconds);
    else if (whole < 60) snprintf(text, size, "%ld s", whole);
    else if (whole < 3600) snprintf(text, size, "%ld:%02ld", whole/60, whole%60);
    else snprintf(text, size, "%ld:%02ld:%02ld", whole/3600, whole/60%60, whole%60);
}

/* Columns of the terminal; COLUMNS wins, as users expect. */
static int terminal_columns(void)
{
    const char *columns = getenv("COLUMNS");
    const long wanted = columns ? strtol(columns, NULL, 10) : 0;
    if (wanted > 0 && wanted < 10000) return (int)wanted;
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/* "3.1 M of 33 M samples, 3.2 M/s, noise 4.1 %, 12 s left"; what is unknown is left out. */
static void describe(const render_progress *state, char *text, size_t size)
{
    char left[32], noise[32] = "", time[48] = "";
    if (state->noise >= 0) snprintf(noise, sizeof noise, ", noise %.3g %%", 100*fmin(state->noise, 9.99));
    if (state->time_left >= 0) {
        format_duration(state->time_left, left, sizeof left);
        snprintf(time, sizeof time, ", %s left", left);
    }
    snprintf(text, size, "%.3g M samples, %.3g M/s%s%s", 1e-6*(double)state->samples_done,
             1e-6*state->samples_per_second, noise, time);
}

/* The part done of whatever ends the render: samples, or the time that its limits leave. */
static double fraction_done(const render_progress *state)
{
    const double by_samples = state->samples_total ? (double)state->samples_done/(double)state->samples_total : 0;
    const double total_time = state->seconds + state->time_left;
    const double by_time = state->time_left >= 0 && total_time > 0 ? state->seconds/total_time : 0;
    return fmin(fmax(by_samples, by_time), 1);
}

/* One line of `columns` at most: "\r 42 % [#####.....] text". */
static void draw_bar(double fraction, const char *text)
{
    const int columns = terminal_columns() - 1; /* the last column makes some terminals wrap */
    int width = columns - (int)strlen(text) - 9;
    if (width > BAR_MAX) width = BAR_MAX;
    char line[512];
    int n = snprintf(line, sizeof line, "%3d %% ", (int)(100*fraction));
    if (width >= 4) {
        char bar[BAR_MAX + 1];
        const int full = (int)(fraction*width);
        for (int i = 0; i < width; i++) bar[i] = i < full ? '#' : '.';
        bar[width] = 0;
        n += snprintf(line + n, sizeof line - (size_t)n, "[%s] ", bar);
    }
    snprintf(line + n, sizeof line - (size_t)n, "%s", text);
    fprintf(stderr, "\r%.*s\033[K", columns > 0 ? columns : 1, line);
    fflush(stderr);
}

void progress_show(progress *p, const render_progress *state)
{
    if (p->is_quiet) return;
    char text[256];
    p->fraction = fmax(p->fraction, fraction_done(state));
    describe(state, text, sizeof text);
    if (p->is_terminal) {
        draw_bar(p->fraction, text);
        p->is_drawn = true;
    } else if (100*p->fraction >= p->next_line) {
        fprintf(stderr, "facet: %d %%, %s\n", (int)(100*p->fraction), text);
        p->next_line = ((int)(100*p->fraction)/LINE_STEP + 1)*LINE_STEP;
    }
}

void progress_end(progress *p)
{
    if (p->is_drawn) fputc('\n', stderr);
    p->is_drawn = false;
}

void progress_show_step(size_t n_done, size_t n, const char *what)
{
    enum { WIDTH = 24 };
    if (n < 2 || !isatty(STDERR_FILENO)) return;
    const int full = (int)(WIDTH*n_done/n);
    fprintf(stderr, "\r[%.*s%*s] %zu/%zu %-60.60s", full, "########################", WIDTH - full, "", n_done + 1, n,
            what);
    fflush(stderr);
}

void progress_end_steps(size_t n)
{
    if (n > 1 && isatty(STDERR_FILENO)) fprintf(stderr, "\r%100s\r", "");
}
