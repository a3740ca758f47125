/* test_cli_checkpoint.c: `facet render` stopped and resumed, and cut into shards for `facet merge`: the same bits, or a
 * refusal with its reason.
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

#include "tests/picture_bytes.h"
#include "tests/program_folder.h"
#include "tests/small_scene.h"

#define RENDER(...) RUN("render", "scene.gltf", "--size", "48x24", "--quiet", __VA_ARGS__)

/* A render of 30 samples that SIGTERM stops as soon as its checkpoint is there; `name` is that file. */
static void stop_a_render(const char *name)
{
    unlink(in_folder(folder, name));
    const char *const argv[] = {FACET_PROGRAM,
                                "render",
                                "scene.gltf",
                                "--size",
                                "48x24",
                                "--quiet",
                                "--spp",
                                "30",
                                "-o",
                                "stopped.exr",
                                "--checkpoint",
                                name,
                                "--threads",
                                "1",
                                "--checkpoint-interval",
                                "0",
                                NULL};
    const pid_t pid = start_program(folder, NULL, NULL, argv);
    while (access(in_folder(folder, name), F_OK) != 0) usleep(500);
    kill(pid, SIGTERM);
    const int status = wait_for_program(pid);
    assert_true(status == 130 || status == 0); /* a fast machine may be through */
}

static void a_resumed_render_writes_the_same_file(void **state)
{
    (void)state;
    expect_run(RENDER("--spp", "30", "-o", "whole.exr", "-o", "whole.png"), 0, "");
    stop_a_render("a.ckpt");
    for (int n_threads = 1; n_threads <= 3; n_threads++) {
        char threads[8];
        snprintf(threads, sizeof threads, "%d", n_threads);
        expect_run(RENDER("--spp", "30", "-o", "resumed.exr", "--resume", "a.ckpt", "--threads", threads), 0, "");
        assert_same_pixels(folder, "whole.exr", "resumed.exr");
    }
    /* Metadata and all, but for the time; the command line is the first run's. */
    expect_run(RENDER("--spp", "30", "-o", "once.exr", "--checkpoint", "full.ckpt"), 0, "");
    expect_run(RENDER("--spp", "30", "-o", "again.exr", "--resume", "full.ckpt"), 0, "");
    assert_same_but_for_time(folder, "once.exr", "again.exr");
    assert_same_pixels(folder, "whole.exr", "again.exr");
}

static void one_command_starts_and_goes_on(void **state)
{
    (void)state;
    unlink(in_folder(folder, "b.ckpt"));
    expect_run(RENDER("--spp", "5", "-o", "b.exr", "--resume", "b.ckpt"), 3,
               "facet: error: b.ckpt: cannot open: No such file or directory");
    expect_run(RUN("render", "scene.gltf", "--size", "48x24", "--spp", "5", "-o", "b.exr", "--resume", "b.ckpt",
                   "--checkpoint", "b.ckpt"),
               0, "facet: note: b.ckpt is not there yet; rendering from the start");
    expect_run(RUN("render", "scene.gltf", "--size", "48x24", "--spp", "5", "-o", "b2.exr", "--resume", "b.ckpt",
                   "--checkpoint", "b.ckpt"),
               0, "facet: note: b.ckpt: going on from 5 samples per pixel");
    assert_same_but_for_time(folder, "b.exr", "b2.exr");
    program_run run = RUN("info", "b.ckpt");
    assert_non_null(strstr(run.out, "b.ckpt: checkpoint, 48 x 24 pixels, whole\n"));
    assert_non_null(strstr(run.out, "  facet:spp              5\n"));
    expect_run(run, 0, "");
    run = RUN("info", "b.ckpt", "--json");
    assert_non_null(strstr(run.out, "\"facet:samples\": \"5\""));
    expect_run(run, 0, "");
}

/* Waits until stderr has a line of progress: then signals are caught. */
static void wait_for_progress(void)
{
    for (bool has_begun = false; !has_begun; usleep(10000)) {
        char *text = read_bytes(in_folder(folder, "stderr"), NULL);
        has_begun = text && strstr(text, "samples");
        free(text);
    }
}

static void each_signal_saves_a_checkpoint(void **state)
{
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof signals/sizeof *signals; i++) {
        unlink(in_folder(folder, "s.ckpt"));
        unlink(in_folder(folder, "stderr"));
        const char *const argv[] = {FACET_PROGRAM, "render", "scene.gltf", "--size",       "48x24",  "-o",
                                    "s.exr",       "--time", "60",         "--checkpoint", "s.ckpt", NULL};
        const pid_t pid = start_program(folder, NULL, NULL, argv);
        wait_for_progress();
        kill(pid, signals[i]);
        assert_int_equal(wait_for_program(pid), 130);
        char *text = read_bytes(in_folder(folder, "stderr"), NULL);
        assert_non_null(strstr(text, " samples per pixel; `facet render scene.gltf --size 48x24 -o s.exr --time 60 "
                                     "--checkpoint s.ckpt --resume s.ckpt` goes on\n"));
        free(text);
        /* The time counts from the first run's start. */
        expect_run(
            RUN("render", "scene.gltf", "--size", "48x24", "--time", "0.001", "-o", "s2.exr", "--resume", "s.ckpt"), 0,
            "wrote s2.exr");
        assert_same_pixels(folder, "s.exr", "s2.exr");
    }
}

static void nohup_keeps_a_render_from_ending_with_its_terminal(void **state)
{
    (void)state;
    unlink(in_folder(folder, "stderr"));
    const char *const argv[] = {"/usr/bin/nohup", FACET_PROGRAM, "render", "scene.gltf", "--size", "48x24",
                                "--time",         "0.5",         "-o",     "n.exr",      NULL};
    const pid_t pid = start_program(folder, NULL, NULL, argv);
    wait_for_progress();
    kill(pid, SIGHUP);
    assert_int_equal(wait_for_program(pid), 0);
}

static void checkpoints_of_other_renders_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *option, *value, *reason;
    } cases[] = {
        {"--spp", "31", "was made with --spp 30; this render has --spp 31"},
        {"--seed", "1", "was made with --seed 0; this render has --seed 1"},
        {"--size", "24x48", "was made with --size 48x24; this render has --size 24x48"},
        {"--crop", "0,0,48,23", "was made with --crop 0,0,48,24; this render has --crop 0,0,48,23"},
        {"--camera", "far", "was made with --camera front; this render has --camera far"},
        {"--depth", "7", "was made with --depth 8; this render has --depth 7"},
        {"--strategy", "explicit", "was made with --strategy mis; this render has --strategy explicit"},
        {"--sampler", "random", "was made with --sampler sobol; this render has --sampler random"},
        {"--gradients", "off", "was made with --gradients auto; this render has --gradients off"},
        {"--shard", "1/2", "was made with --shard 1/1; this render has --shard 1/2"},
        {"--isa", "sse2", "this render has --isa sse2"},
        {"--env", "1,1,1", "was made with a scene (with its files, --env and --material) of hash"},
        {"--env-scale", "2", "was made with a scene"},
        {"--material", "ball=ggx alpha=.2", "was made with a scene"},
    };
    expect_run(RENDER("--spp", "30", "-o", "c.exr", "--checkpoint", "c.ckpt"), 0, "");
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        const char *argv[20] = {FACET_PROGRAM, "render", "scene.gltf",   "--quiet", "--resume",      "c.ckpt",
                                "-o",          "d.exr",  "--checkpoint", "d.ckpt",  cases[i].option, cases[i].value};
        size_t n = 12;
        if (strcmp(cases[i].option, "--spp") != 0) argv[n++] = "--spp", argv[n++] = "30";
        if (strcmp(cases[i].option, "--size") != 0) argv[n++] = "--size", argv[n++] = "48x24";
        expect_run(run_program(folder, NULL, NULL, argv), 3, cases[i].reason);
        assert_int_equal(access(in_folder(folder, "d.ckpt"), F_OK), -1);
    }
    write_text(in_folder(folder, "scene.gltf"), small_scene);
    char *changed = strdup(small_scene), *number = strstr(changed, "0.4");
    *number = '1'; /* a file that changes between runs, by one digit */
    write_text(in_folder(folder, "scene.gltf"), changed);
    free(changed);
    expect_run(RENDER("--spp", "30", "-o", "d.exr", "--resume", "c.ckpt"), 3, "c.ckpt: was made with a scene");
    write_text(in_folder(folder, "scene.gltf"), small_scene);
    expect_run(RENDER("--spp", "30", "-o", "d.exr", "--resume", "scene.gltf"), 3,
               "scene.gltf: is not a checkpoint of facet");
}

/* ---- Shards -------------------------------------------------------------------------------------------------- */

static void make_shard(const char *number, const char *file)
{
    expect_run(RENDER("--spp", "7", "--shard", number, "--checkpoint", file), 0, "");
}

static void shards_merge_in_any_order_to_the_whole(void **state)
{
    (void)state;
    expect_run(RENDER("--spp", "7", "-o", "all.exr", "-o", "all.png"), 0, "");
    make_shard("1/3", "1.ckpt");
    make_shard("2/3", "2.ckpt");
    make_shard("3/3", "3.ckpt");
    static const char *const orders[][3] = {
        {"1.ckpt", "2.ckpt", "3.ckpt"}, {"3.ckpt", "1.ckpt", "2.ckpt"}, {"2.ckpt", "3.ckpt", "1.ckpt"}};
    for (size_t i = 0; i < 3; i++) {
        expect_run(RUN("merge", orders[i][0], orders[i][1], orders[i][2], "-o", "m.exr", "-o", "m.png"), 0,
                   "facet: wrote m.exr: 48x24, 7 spp of 3 shards");
        assert_same_pixels(folder, "all.exr", "m.exr");
        assert_same_pixels(folder, "all.png", "m.png");
    }
    make_shard("1/1", "whole.ckpt");
    expect_run(RUN("merge", "whole.ckpt", "-o", "m.exr"), 0, "7 spp of 1 shards");
    assert_same_pixels(folder, "all.exr", "m.exr");
}

static void merge_refuses_what_does_not_fit(void **state)
{
    (void)state;
    make_shard("1/2", "1.ckpt");
    make_shard("2/2", "2.ckpt");
    make_shard("2/3", "third.ckpt");
    expect_run(RENDER("--spp", "7", "--shard", "2/2", "--seed", "5", "--checkpoint", "seed.ckpt"), 0, "");
    expect_run(RUN("merge", "1.ckpt", "-o", "x.exr"), 3, "facet: error: shard 2/2 is missing; 1 of 2 are given");
    expect_run(RUN("merge", "1.ckpt", "2.ckpt", "1.ckpt", "-o", "x.exr"), 3,
               "facet: error: 1.ckpt: is shard 1/2, and so is 1.ckpt; leave one out");
    expect_run(RUN("merge", "1.ckpt", "seed.ckpt", "-o", "x.exr"), 3,
               "facet: error: seed.ckpt: was made with --seed 5; 1.ckpt has --seed 0");
    expect_run(RUN("merge", "1.ckpt", "third.ckpt", "-o", "x.exr"), 3,
               "facet: error: third.ckpt: is a shard of 3; 1.ckpt is one of 2");
    expect_run(RUN("merge", "1.ckpt", "none.ckpt", "-o", "x.exr"), 3, "facet: error: none.ckpt: cannot open");
    expect_run(RUN("merge", "1.ckpt", "2.ckpt"), 2, "merge needs an output");
    expect_run(RUN("merge", "-o", "x.exr"), 2, "merge needs FILE.ckpt...");
    size_t size;
    char *bytes = read_bytes(in_folder(folder, "2.ckpt"), &size);
    bytes[size/2] ^= 1;
    FILE *file = fopen(in_folder(folder, "2.ckpt"), "wb");
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    free(bytes);
    expect_run(RUN("merge", "1.ckpt", "2.ckpt", "-o", "x.exr"), 3, "facet: error: 2.ckpt: is damaged");
    assert_int_equal(access(in_folder(folder, "x.exr"), F_OK), -1);
}

static void an_unfinished_shard_tells_how_to_finish_it(void **state)
{
    (void)state;
    unlink(in_folder(folder, "u.ckpt"));
    const char *const argv[] = {
        FACET_PROGRAM, "render",  "scene.gltf", "--size",       "48x24",  "--spp",
        "65536",       "--shard", "2/2",        "--checkpoint", "u.ckpt", "--checkpoint-interval",
        "0",           NULL};
    const pid_t pid = start_program(folder, NULL, NULL, argv);
    while (access(in_folder(folder, "u.ckpt"), F_OK) != 0) usleep(500);
    kill(pid, SIGTERM);
    assert_int_equal(wait_for_program(pid), 130);
    program_run run = RUN("merge", "u.ckpt", "-o", "x.exr");
    assert_non_null(strstr(run.err, "facet: error: u.ckpt: shard 2/2 has "));
    expect_run(run, 3,
               " of its 32768 samples per pixel; finish it: facet render scene.gltf --size 48x24 --spp 65536 "
               "--shard 2/2 --checkpoint u.ckpt --checkpoint-interval 0 --resume u.ckpt\n");
}

static void wrong_usage_is_told_before_rendering(void **state)
{
    (void)state;
    expect_run(RENDER("--shard", "1/2"), 2, "facet: error: --shard: needs --checkpoint FILE");
    static const char *const bad[] = {"0/2", "3/2", "1", "1/", "/2", "a/2", "1/b", "1/2x", "-1/2", "1/-2", "1/0"};
    for (size_t i = 0; i < sizeof bad/sizeof *bad; i++)
        expect_run(RENDER("--shard", bad[i], "--checkpoint", "y.ckpt"), 2, "is not K/N with K from 1 to N");
    expect_run(RENDER("--shard", "1/9", "--spp", "8", "--checkpoint", "y.ckpt"), 2, "9 shards for 8 samples per pixel");
    expect_run(RENDER("--shard", "1/2", "--time", "8", "--checkpoint", "y.ckpt"), 2,
               "does not go with --time or --noise");
    expect_run(RENDER("--checkpoint-interval", "8"), 2, "needs --checkpoint FILE");
    expect_run(RENDER("--checkpoint", "no/such/y.ckpt"), 4, "no/such/y.ckpt: the folder `no/such` cannot be used");
    expect_run(RENDER("--checkpoint", "y.exr"), 2, "named like a picture");
    expect_run(RENDER("--checkpoint", "."), 4, "exists and is not a regular file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_resumed_render_writes_the_same_file),
        cmocka_unit_test(one_command_starts_and_goes_on),
        cmocka_unit_test(each_signal_saves_a_checkpoint),
        cmocka_unit_test(nohup_keeps_a_render_from_ending_with_its_terminal),
        cmocka_unit_test(checkpoints_of_other_renders_are_refused),
        cmocka_unit_test(shards_merge_in_any_order_to_the_whole),
        cmocka_unit_test(merge_refuses_what_does_not_fit),
        cmocka_unit_test(an_unfinished_shard_tells_how_to_finish_it),
        cmocka_unit_test(wrong_usage_is_told_before_rendering),
    };
    return cmocka_run_group_tests_name("cli_checkpoint", tests, make_scene_folder, remove_test_folder);
}
