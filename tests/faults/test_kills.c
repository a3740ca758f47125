/* test_kills.c: kill -9 at random moments of a render, each followed by a resume that ends bit for bit as if nothing
 * had happened.  10 kills; FACET_KILLS=200 is the long form.  Prints what the kills met.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/checkpoint.h"
#include "tests/draws.h"
#include "tests/picture_bytes.h"
#include "tests/program_folder.h"

static double in_seconds(struct timespec t)
{
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* Since 1970, as file times are. */
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_REALTIME, &t);
    return in_seconds(t);
}

static void wait_for(double seconds)
{
    const struct timespec time = {(time_t)seconds, (long)(1e9*(seconds - (double)(time_t)seconds))};
    nanosleep(&time, NULL);
}

/* The same command each time: it starts, or goes on. */
static pid_t start(const char *interval, const char *threads)
{
    const char *const argv[] = {FACET_PROGRAM,
                                "render",
                                "scene.gltf",
                                "--size",
                                "96x48",
                                "--spp",
                                "160",
                                "-o",
                                "killed.exr",
                                "--quiet",
                                "--threads",
                                threads,
                                "--resume",
                                "k.ckpt",
                                "--checkpoint",
                                "k.ckpt",
                                "--checkpoint-interval",
                                interval,
                                NULL};
    return start_program(folder, NULL, NULL, argv);
}

/* Files that a killed writer left: at most one, since each start clears them away. */
static size_t count_leftovers(void)
{
    size_t n = 0;
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) n += strstr(entry->d_name, ".tmp-") != NULL;
    closedir(entries);
    return n;
}

typedef struct tally {
    size_t n_kills, n_empty, n_inside_writing, n_late; /* without a checkpoint yet; while it is written; too late */
    double worst_loss; /* [s], beyond the interval: since the start or the last checkpoint, whichever is later */
} tally;

/* Kills the render after that time and looks at what it left. */
static void kill_once(const char *interval, const char *threads, double after, tally *t)
{
    double saved = now();
    const pid_t pid = start(interval, threads);
    wait_for(after);
    const double end = now();
    kill(pid, SIGKILL);
    const int status = wait_for_program(pid);
    if (status == 0) {
        t->n_late++;
        return;
    }
    assert_int_equal(status, 128 + SIGKILL);
    t->n_kills++;
    const size_t n_leftovers = count_leftovers();
    assert_true(n_leftovers <= 1);
    t->n_inside_writing += n_leftovers;
    struct stat information;
    if (stat(in_folder(folder, "k.ckpt"), &information) != 0) {
        t->n_empty++;
    } else {
        checkpoint c;
        facet_error why = {0};
        if (checkpoint_read(in_folder(folder, "k.ckpt"), true, &c, &why)) fail_msg("after a kill: %s", why.text);
        checkpoint_destroy(&c);
        saved = fmax(saved, in_seconds(information.st_mtim));
    }
    t->worst_loss = fmax(t->worst_loss, end - saved - strtod(interval, NULL));
}

static void a_killed_render_resumes_to_the_same_bits(void **state)
{
    (void)state;
    static const char *const intervals[] = {"0", "0", "0.02", "0.1"}, *const threads[] = {"1", "2", "3"};
    const char *wanted = getenv("FACET_KILLS");
    const size_t n = wanted ? strtoul(wanted, NULL, 10) : 10;
    draws d = {(uint64_t)getpid()};
    tally t = {0};
    const double begin = now();
    assert_int_equal(wait_for_program(start("60", "2")), 0);
    const double duration = now() - begin;
    assert_int_equal(rename(in_folder(folder, "killed.exr"), in_folder(folder, "whole.exr")), 0);
    unlink(in_folder(folder, "k.ckpt"));
    while (t.n_kills < n) {
        const char *interval = intervals[draw_bits(&d)%4];
        kill_once(interval, threads[draw_bits(&d)%3], draw_between(&d, 0, duration), &t);
        if (draw(&d) < .3) continue; /* killed again as it resumes */
        const int status = wait_for_program(start(interval, threads[draw_bits(&d)%3]));
        if (status != 0) fail_msg("resuming ended with status %d", status);
        assert_same_pixels(folder, "whole.exr", "killed.exr");
        assert_int_equal(count_leftovers(), 0);
        unlink(in_folder(folder, "k.ckpt"));
        unlink(in_folder(folder, "killed.exr"));
    }
    assert_true(n == 0 || t.n_kills >= n);
    print_message("%zu kills: %zu before the first checkpoint, %zu inside the writing of one; %zu came too late; "
                  "the most lost beyond the interval: %.2f s\n",
                  t.n_kills, t.n_empty, t.n_inside_writing, t.n_late, t.worst_loss);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_killed_render_resumes_to_the_same_bits)};
    return cmocka_run_group_tests_name("kills", tests, make_scene_folder, remove_test_folder);
}
