/* test_mpi.c: `mpirun -n N facet render`: the bits of one process on any number of ranks; one voice; a rank that dies
 * costs what came after the last checkpoint.  Skipped where facet was built without MPI.
 * SPDX-License-Identifier: MIT */
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
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/checkpoint.h"
#include "tests/picture_bytes.h"
#include "tests/program_folder.h"

#define SHELL(...) run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", __VA_ARGS__, NULL})

/* $MPIRUN and $FACET are there for the tests' shell lines. */
static int setup(void **state)
{
    make_scene_folder(state);
    setenv("MPIRUN", FACET_MPIRUN, 1);
    setenv("FACET", FACET_PROGRAM, 1);
    setenv("OPTIONS", "--size 96x48 --quiet --threads 1", 1);
    setenv("TWO_THREADS", "--size 96x48 --quiet --threads 2", 1);
    /* Open MPI refuses these by itself: root, and more ranks than processors. */
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
    setenv("OMPI_MCA_mpi_yield_when_idle", "1", 1);
    return 0;
}

static void skip_without_mpi(void)
{
    if (!FACET_MPIRUN[0]) {
        print_message("skipped: facet was built without MPI, or there is no mpirun\n");
        skip();
    }
}

/* The line must end with this status; the run's output is returned for more. */
static program_run shell(const char *line, int status)
{
    const program_run run = SHELL(line);
    if (run.status != status)
        fail_msg("%s\nstatus %d (expected %d)\nstdout:\n%s\nstderr:\n%s", line, run.status, status, run.out, run.err);
    return run;
}

static void expect(const char *line)
{
    program_run run = shell(line, 0);
    program_run_free(&run);
}

static size_t count(const char *text, const char *part)
{
    size_t n = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part)) n++;
    return n;
}

static void assert_same_films(const char *a, const char *b)
{
    checkpoint x, y;
    facet_error why = {0};
    if (checkpoint_read(in_folder(folder, a), true, &x, &why)) fail_msg("%s: %s", a, why.text);
    if (checkpoint_read(in_folder(folder, b), true, &y, &why)) fail_msg("%s: %s", b, why.text);
    const film *f = &x.state.film, *g = &y.state.film;
    assert_true(f->width == g->width && f->height == g->height);
    for (size_t i = 0; i < f->width*f->height; i++) {
        assert_memory_equal(f->pixels[i].rgb, g->pixels[i].rgb, sizeof f->pixels[i].rgb);
        assert_memory_equal(&f->pixels[i].luminance_squares, &g->pixels[i].luminance_squares, sizeof(exact_sum));
        assert_int_equal(f->pixels[i].n, g->pixels[i].n);
    }
    assert_int_equal(x.state.n_paths, y.state.n_paths);
    assert_int_equal(x.state.n_rays, y.state.n_rays);
    assert_int_equal(x.state.spp, y.state.spp);
    checkpoint_destroy(&x);
    checkpoint_destroy(&y);
}

/* ---- The same picture ---------------------------------------------------------------------------------------- */

static void any_number_of_ranks_gives_the_bits_of_one_process(void **state)
{
    (void)state;
    skip_without_mpi();
    expect("$FACET render scene.gltf $OPTIONS --spp 40 -o one.exr -o one.png --checkpoint one.ckpt");
    for (int n = 1; n <= 4; n++) {
        char line[256];
        snprintf(line, sizeof line,
                 "$MPIRUN -n %d $FACET render scene.gltf $OPTIONS --spp 40 -o many.exr -o many.png --checkpoint "
                 "many.ckpt && $FACET compare one.exr many.exr --max 0",
                 n);
        expect(line);
        assert_same_pixels(folder, "one.exr", "many.exr");
        assert_same_pixels(folder, "one.png", "many.png");
        assert_same_films("one.ckpt", "many.ckpt");
    }
}

static void ranks_with_threads_stop_at_the_same_noise(void **state)
{
    (void)state;
    skip_without_mpi();
    expect("$FACET render scene.gltf $OPTIONS --noise .1 -o one.exr --checkpoint one.ckpt");
    expect("$MPIRUN -n 2 $FACET render scene.gltf $TWO_THREADS --noise .1 -o many.exr --checkpoint many.ckpt");
    assert_same_pixels(folder, "one.exr", "many.exr");
    assert_same_films("one.ckpt", "many.ckpt");
}

static void the_clock_ends_a_shared_render_between_passes(void **state)
{
    (void)state;
    skip_without_mpi();
    expect("$MPIRUN -n 2 $FACET render scene.gltf $OPTIONS --time .3 -o timed.exr --checkpoint timed.ckpt");
    checkpoint c;
    assert_int_equal(checkpoint_read(in_folder(folder, "timed.ckpt"), true, &c, NULL), FACET_OK);
    const film *f = &c.state.film;
    assert_true(c.state.spp > 0);
    for (size_t i = 0; i < f->width*f->height; i++) assert_int_equal(f->pixels[i].n, c.state.spp);
    checkpoint_destroy(&c);
}

/* ---- One voice ----------------------------------------------------------------------------------------------- */

static void an_error_is_told_once(void **state)
{
    (void)state;
    skip_without_mpi();
    static const struct {
        const char *arguments, *text;
        int status;
    } cases[] = {{"none.gltf", "facet: error: none.gltf: cannot open: No such file or directory\n", 3},
                 {"--sizes 3x3", "facet: error: render has no option `--sizes`", 2},
                 {"-o no/such.exr", "facet: error: no/such.exr: the folder `no` cannot be used", 4},
                 {"--resume no.ckpt", "facet: error: no.ckpt: cannot open", 3},
                 {"--crop 0,0,9999,9", "facet: error: --crop: 0,0,9999,9 does not lie inside the picture", 2},
                 {"--shard 1/2", "facet: error: --shard: needs --checkpoint FILE", 2}};
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        char line[256];
        snprintf(line, sizeof line, "$MPIRUN -n 3 $FACET render %s", cases[i].arguments);
        program_run run = shell(line, cases[i].status);
        assert_int_equal(count(run.err, "facet: "), 1);
        if (!strstr(run.err, cases[i].text)) fail_msg("%s: %s", line, run.err);
        program_run_free(&run);
    }
}

static void ranks_of_other_renders_are_refused(void **state)
{
    (void)state;
    skip_without_mpi();
    program_run run = shell("$MPIRUN -n 1 $FACET render scene.gltf $OPTIONS -o a.exr --seed 1 : "
                            "-n 1 $FACET render scene.gltf $OPTIONS -o a.exr --seed 2",
                            3);
    assert_non_null(strstr(run.err, "renders another scene or has other options"));
    assert_int_equal(count(run.err, "facet: "), 1);
    program_run_free(&run);
    run = shell("$MPIRUN -n 1 $FACET render scene.gltf $OPTIONS -o a.exr : "
                "-n 1 $FACET render gone.gltf $OPTIONS -o a.exr",
                3);
    assert_non_null(strstr(run.err, "facet: error: on rank 1 ("));
    assert_non_null(strstr(run.err, "): gone.gltf: cannot open: No such file or directory"));
    program_run_free(&run);
    assert_int_equal(access(in_folder(folder, "a.exr"), F_OK), -1);
}

static void only_the_leader_writes_and_speaks(void **state)
{
    (void)state;
    skip_without_mpi();
    program_run run = shell("$MPIRUN -n 3 $FACET render scene.gltf --size 96x48 --spp 30 --threads 1 -o a.exr --json "
                            "--events events.json",
                            0);
    assert_int_equal(count(run.out, "\"version\""), 1);
    assert_non_null(strstr(run.out, "\"ranks\": 3"));
    assert_int_equal(count(run.err, "facet: wrote a.exr: 96x48, 30 spp"), 1);
    assert_int_equal(count(run.err, "facet: 100 %"), 1);
    program_run_free(&run);
    char *events = read_bytes(in_folder(folder, "events.json"), NULL);
    assert_non_null(events);
    assert_int_equal(count(events, "\"event\": \"start\""), 1);
    assert_int_equal(count(events, "\"event\": \"done\""), 1);
    assert_non_null(strstr(events, "\"ranks\": 3"));
    free(events);
}

static void ranks_can_render_each_on_its_own(void **state)
{
    (void)state;
    skip_without_mpi();
    expect("$MPIRUN -n 2 sh -c 'r=${PMI_RANK:-$OMPI_COMM_WORLD_RANK}; exec $FACET render scene.gltf $OPTIONS --spp 7 "
           "--mpi off --shard $((r + 1))/2 --checkpoint part$r.ckpt' && $FACET merge part0.ckpt part1.ckpt -o m.exr && "
           "$FACET render scene.gltf $OPTIONS --spp 7 -o one.exr");
    assert_same_pixels(folder, "one.exr", "m.exr");
}

/* ---- Ends ---------------------------------------------------------------------------------------------------- */

/* Starts 3 ranks on a long render, each with its process's number in a file; waits until there is a checkpoint. */
static pid_t start_ranks(void)
{
    static const char line[] =
        "exec $MPIRUN -n 3 sh -c 'echo $$ > pid${PMI_RANK:-$OMPI_COMM_WORLD_RANK}; exec $FACET render scene.gltf "
        "$OPTIONS --spp 1000 -o long.exr --checkpoint long.ckpt --checkpoint-interval 0.05'";
    unlink(in_folder(folder, "long.ckpt"));
    const char *const argv[] = {"/bin/sh", "-c", line, NULL};
    const pid_t pid = start_program(folder, NULL, NULL, argv);
    while (access(in_folder(folder, "long.ckpt"), F_OK) != 0) usleep(500);
    return pid;
}

static pid_t pid_of(int rank)
{
    char name[8], *text;
    snprintf(name, sizeof name, "pid%d", rank);
    assert_non_null(text = read_bytes(in_folder(folder, name), NULL));
    const pid_t pid = (pid_t)strtol(text, NULL, 10);
    free(text);
    assert_true(pid > 1);
    return pid;
}

static void finish_on_other_ranks(void)
{
    static const char *const launchers[] = {"", "$MPIRUN -n 2", "$MPIRUN -n 4"};
    expect("$FACET render scene.gltf $TWO_THREADS --spp 1000 -o whole.exr");
    for (size_t i = 0; i < sizeof launchers/sizeof *launchers; i++) {
        char line[256];
        snprintf(line, sizeof line, "%s $FACET render scene.gltf $OPTIONS --spp 1000 -o resumed.exr --resume long.ckpt",
                 launchers[i]);
        expect(line);
        assert_same_pixels(folder, "whole.exr", "resumed.exr");
    }
}

static void a_rank_that_dies_ends_the_job_with_its_checkpoint_whole(void **state)
{
    (void)state;
    skip_without_mpi();
    for (int rank = 0; rank < 3; rank += 2) { /* the leader, too */
        const pid_t pid = start_ranks();
        kill(pid_of(rank), SIGKILL);
        assert_int_not_equal(wait_for_program(pid), 0);
        for (int i = 0; i < 3; i++) /* nobody is left behind */
            while (kill(pid_of(i), 0) == 0) usleep(1000);
        finish_on_other_ranks();
    }
}

static void a_signal_to_any_rank_saves_the_work_of_all(void **state)
{
    (void)state;
    skip_without_mpi();
    for (int rank = 0; rank < 3; rank += 2) {
        const pid_t pid = start_ranks();
        kill(pid_of(rank), SIGTERM);
        assert_int_equal(wait_for_program(pid), 130);
        char *text = read_bytes(in_folder(folder, "long.exr"), NULL);
        assert_non_null(text);
        free(text);
        expect("$FACET merge long.ckpt -o saved.exr");
        assert_same_pixels(folder, "long.exr", "saved.exr");
    }
    finish_on_other_ranks();
}

/* ---- Without mpirun ------------------------------------------------------------------------------------------ */

static void a_launcher_of_another_mpi_is_told(void **state)
{
    (void)state;
    skip_without_mpi();
    program_run run = shell(
        "env ASAN_OPTIONS=detect_leaks=0 PMI_RANK=0 PMI_SIZE=4 OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=4 "
        "$FACET render scene.gltf $OPTIONS -o a.exr",
        2);
    assert_non_null(strstr(run.err, "started as one of 4 processes by another MPI than facet's"));
    program_run_free(&run);
    expect("env OMPI_COMM_WORLD_RANK=3 OMPI_COMM_WORLD_SIZE=4 $FACET render scene.gltf $OPTIONS -o a.exr --mpi off "
           "--spp 1");
    expect("env PMI_RANK=0 PMI_SIZE=1 $FACET render scene.gltf $OPTIONS -o a.exr --spp 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_ranks_gives_the_bits_of_one_process),
        cmocka_unit_test(ranks_with_threads_stop_at_the_same_noise),
        cmocka_unit_test(the_clock_ends_a_shared_render_between_passes),
        cmocka_unit_test(an_error_is_told_once),
        cmocka_unit_test(ranks_of_other_renders_are_refused),
        cmocka_unit_test(only_the_leader_writes_and_speaks),
        cmocka_unit_test(ranks_can_render_each_on_its_own),
        cmocka_unit_test(a_rank_that_dies_ends_the_job_with_its_checkpoint_whole),
        cmocka_unit_test(a_signal_to_any_rank_saves_the_work_of_all),
        cmocka_unit_test(a_launcher_of_another_mpi_is_told),
    };
    return cmocka_run_group_tests_name("mpi", tests, setup, remove_test_folder);
}
