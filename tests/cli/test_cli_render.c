/* test_cli_render.c: `facet render`, from scenes to files, with `facet compare` and `facet info` to look at them.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <pty.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>
#include <jansson.h>

#include "tests/program_folder.h"

static json_t *parse(const program_run *run)
{
    json_error_t why;
    json_t *root = json_loads(run->out, JSON_REJECT_DUPLICATES, &why);
    if (!root) fail_msg("line %d: %s\n%s", why.line, why.text, run->out);
    return root;
}

static long long whole(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_integer(value)) fail_msg("no whole number `%s`", key);
    return json_integer_value(value);
}

/* True if the file holds the bytes of the text. */
static bool holds(const char *name, const char *text)
{
    size_t size, length = strlen(text);
    char *bytes = read_bytes(in_folder(folder, name), &size);
    assert_non_null(bytes);
    bool found = false;
    for (size_t i = 0; !found && i + length <= size; i++) found = memcmp(bytes + i, text, length) == 0;
    free(bytes);
    return found;
}

static void remove_file(const char *name)
{
    unlink(in_folder(folder, name));
}

/* Renders the scene to `name` and fails if that fails; arguments end with NULL. */
static void make_picture(const char *name, const char *const *arguments)
{
    const char *argv[20] = {FACET_PROGRAM, "render", "scene.gltf", "--quiet", "--size",
                            "32x16",       "--spp",  "4",          "-o",      name};
    for (size_t i = 0; arguments[i]; i++) argv[10 + i] = arguments[i];
    program_run run = run_program(folder, NULL, NULL, argv);
    expect_run(run, 0, "");
}
#define MAKE(name, ...) make_picture(name, (const char *const[]){__VA_ARGS__, NULL})

/* ---- Outputs ----------------------------------------------------------------------------------- */

static void pictures_carry_their_provenance(void **state)
{
    (void)state;
    program_run run = RUN("render", "scene.gltf", "-o", "a.exr", "--output=b.png", "--size", "20x10", "-s3", "--seed",
                          "77", "--json", "--quiet", "--strategy", "mis", "--crop", "2,1,16,8");
    program_run_check(&run, 0, "", "");
    assert_int_equal(strlen(run.err), 0); /* --quiet */
    json_t *root = parse(&run);
    assert_int_equal(whole(root, "width"), 16);
    assert_int_equal(whole(root, "height"), 8);
    assert_int_equal(whole(root, "spp"), 3);
    assert_int_equal(whole(root, "seed"), 77);
    assert_int_equal(whole(root, "paths"), 16*8*3);
    assert_int_equal(whole(root, "bad_samples"), 0);
    assert_true(json_is_true(json_object_get(root, "complete")));
    assert_true(json_is_false(json_object_get(root, "interrupted")));
    assert_int_equal(json_array_size(json_object_get(root, "outputs")), 2);
    json_decref(root);
    program_run_free(&run);
    static const char *const keys[] = {"facet:version", "facet:command",      "facet:scene_hash", "facet:seed",
                                       "facet:spp",     "facet:time_seconds", "facet:isa",        "facet:strategy",
                                       "facet:sampler", "facet:depth",        "facet:camera",     "facet:clamped",
                                       "facet:dropped", "facet:gradients"};
    for (size_t i = 0; i < sizeof keys/sizeof *keys; i++) {
        assert_true(holds("a.exr", keys[i]));
        assert_true(holds("b.png", keys[i]));
    }
    assert_true(holds("a.exr", "facet render scene.gltf -o a.exr --output=b.png --size 20x10 -s3 --seed 77"));
    assert_true(holds("b.png", "facet render scene.gltf -o a.exr --output=b.png --size 20x10 -s3 --seed 77"));
    assert_true(holds("a.exr", "worldToCamera"));
    assert_true(holds("b.png", "facet:world_to_camera"));
    static const char *const files[] = {"a.exr", "b.png"};
    for (size_t i = 0; i < 2; i++) {
        run = RUN("info", "--json", files[i]);
        program_run_check(&run, 0, "", "");
        root = parse(&run);
        assert_int_equal(whole(root, "width"), 16);
        assert_int_equal(json_array_size(json_object_get(root, "channels")), 3);
        json_decref(root);
        program_run_free(&run);
    }
}

static void names_and_sizes_have_sensible_defaults(void **state)
{
    (void)state;
    program_run run = RUN("render", "--size", "16x9", "--spp", "1");
    expect_run(run, 0, "wrote facet.png: 16x9, 1 spp");
    run = RUN("render", in_folder(folder, "scene.gltf"), "--spp", "1", "--depth", "0");
    program_run_check(&run, 0, "", "wrote scene.png: 1080x540, 1 spp"); /* the camera's aspect is 2 */
    program_run_free(&run);
    run = RUN("render", "scene.gltf", "--spp", "1", "--depth", "0", "--camera", "far");
    program_run_check(&run, 0, "", "wrote scene.png: 960x540, 1 spp"); /* that of the other is open */
    program_run_free(&run);
}

static void a_file_that_cannot_be_written_leaves_the_old_one(void **state)
{
    (void)state;
    write_text(in_folder(folder, "old.exr"), "the old content");
    char command[1024];
    /* A limit of one block of 512 bytes stands for a full disk. */
    snprintf(command, sizeof command,
             "ulimit -f 1; exec '%s' render scene.gltf --size 64x64 --spp 1 --quiet -o old.exr", FACET_PROGRAM);
    program_run run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
    expect_run(run, 4, "facet: error: old.exr:");
    char *bytes = read_bytes(in_folder(folder, "old.exr"), NULL);
    assert_string_equal(bytes, "the old content");
    free(bytes);
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;)
        if (strstr(entry->d_name, "old.exr") && strcmp(entry->d_name, "old.exr") != 0)
            fail_msg("left behind: %s", entry->d_name);
    closedir(directory);
}

static void an_output_must_be_a_file(void **state)
{
    (void)state;
    program_run run = RUN("render", "scene.gltf", "-o", "/dev/null/x.png");
    expect_run(run, 4, "facet: error: /dev/null/x.png: ");
    run = run_program(folder, NULL, NULL, (const char *const[]){"/bin/mkdir", "-p", "folder.png", NULL});
    program_run_free(&run);
    run = RUN("render", "scene.gltf", "-o", "folder.png");
    expect_run(run, 4, "folder.png: exists and is not a regular file");
}

/* ---- What is rendered -------------------------------------------------------------------------- */

static void threads_do_not_change_a_pixel_and_seeds_do(void **state)
{
    (void)state;
    MAKE("one.exr", "--threads", "1");
    MAKE("three.exr", "-t", "3");
    MAKE("other.exr", "--seed", "1");
    program_run run = RUN("compare", "one.exr", "three.exr", "--metric", "mse", "--max", "0", "--json");
    program_run_check(&run, 0, "", "");
    json_t *root = parse(&run);
    assert_int_equal(whole(root, "different_pixels"), 0);
    json_decref(root);
    program_run_free(&run);
    run = RUN("compare", "one.exr", "other.exr", "--metric", "mse", "--max", "0");
    expect_run(run, 1, "");
}

static void options_change_the_picture_as_they_say(void **state)
{
    (void)state;
    static const struct {
        const char *option, *value;
    } changes[] = {
        {"--camera", "far"},        {"--env", "0.2,0.3,0.4"}, {"--material", "ball=ggx alpha=.2 ks=.9,.6,.2"},
        {"--strategy", "explicit"}, {"--sampler", "random"},  {"--depth", "0"},
    };
    MAKE("base.exr", "--depth=8");
    for (size_t i = 0; i < sizeof changes/sizeof *changes; i++) {
        MAKE("changed.exr", changes[i].option, changes[i].value);
        program_run run = RUN("compare", "base.exr", "changed.exr", "--metric", "mse", "--max", "0");
        if (run.status != 1)
            fail_msg("%s %s changed nothing: %s%s", changes[i].option, changes[i].value, run.out, run.err);
        program_run_free(&run);
    }
    /* Neighbouring pixels have something to compare where what lies behind their surfaces is matte. */
    MAKE("on.exr", "--env", "1,1,1", "--material", "ball=lambert kd=.8", "--material", "lamp=lambert kd=.8",
         "--gradients", "on");
    MAKE("off.exr", "--env", "1,1,1", "--material", "ball=lambert kd=.8", "--material", "lamp=lambert kd=.8",
         "--gradients", "off");
    expect_run(RUN("compare", "on.exr", "off.exr", "--metric", "mse", "--max", "0"), 1, "");
    /* Twice the environment alone is twice the picture: exactly, as floats double exactly. */
    MAKE("once.exr", "--env", "1,1,1", "--material", "lamp=lambert", "--depth", "0");
    MAKE("twice.exr", "--env", "1,1,1", "--material", "lamp=lambert", "--depth", "0", "--env-scale", "2");
    program_run run = RUN("compare", "twice.exr", "once.exr", "--metric", "mean", "--json");
    json_t *root = parse(&run);
    const json_t *a = json_object_get(root, "mean_a"), *b = json_object_get(root, "mean_b");
    /* The lamp's own light is in both: take it from the difference of three pictures' means. */
    MAKE("none.exr", "--env", "0,0,0", "--material", "lamp=lambert", "--depth", "0");
    program_run dark = RUN("compare", "none.exr", "once.exr", "--json");
    json_t *dark_root = parse(&dark);
    const double lamp = json_real_value(json_array_get(json_object_get(dark_root, "mean_a"), 0));
    const double once = json_number_value(json_array_get(b, 0)) - lamp;
    const double twice = json_number_value(json_array_get(a, 0)) - lamp;
    assert_true(once > 0.1 && twice > 1.999999*once && twice < 2.000001*once);
    json_decref(root);
    json_decref(dark_root);
    program_run_free(&run);
    program_run_free(&dark);
}

static void unknown_names_are_answered_with_the_known_ones(void **state)
{
    (void)state;
    program_run run = RUN("render", "scene.gltf", "--camera", "frnt", "-o", "x.png");
    program_run_check(
        &run, 2, "",
        "facet: error: --camera: the scene has no camera `frnt`; did you mean `front`? it has `front`, `far`\n");
    program_run_free(&run);
    run = RUN("render", "scene.gltf", "--material", "bal=ggx", "-o", "x.png");
    expect_run(run, 2, "no material `bal`; did you mean `ball`? it has `ball`, `lamp`");
    run = RUN("render", "scene.gltf", "--material", "ball=ggx alpha=9e9", "-o", "x.png");
    expect_run(run, 2, "facet: error: --material ball:alpha: ");
}

static void dark_scenes_without_cameras_are_shown_with_notes(void **state)
{
    (void)state;
    write_text(in_folder(folder, "bare.gltf"),
               "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"extensions\":"
               "{\"FACET_shape\":{\"sphere\":{\"radius\":1}}}}],\"extensionsUsed\":[\"FACET_shape\"]}");
    program_run run = RUN("render", "bare.gltf", "--size", "8x8", "--spp", "16");
    program_run_check(&run, 0, "", "facet: note: the scene has no camera;");
    expect_run(run, 0, "facet: note: the scene has no light;");
    run = RUN("info", "bare.png", "--json");
    json_t *root = parse(&run);
    const json_t *red = json_array_get(json_object_get(root, "channels"), 0);
    assert_true(json_number_value(json_object_get(red, "min")) > 0.1); /* lit all around */
    json_decref(root);
    program_run_free(&run);
}

static void damaged_scenes_are_status_3_and_leave_no_file(void **state)
{
    (void)state;
    write_text(in_folder(folder, "broken.gltf"), "{\"asset\": {\"version\": \"2.0\"}, ");
    program_run run = RUN("render", "broken.gltf");
    program_run_check(&run, 3, "", "facet: error: broken.gltf:");
    assert_null(read_bytes(in_folder(folder, "broken.png"), NULL));
    program_run_free(&run);
    run = RUN("info", "scene.gltf", "--json");
    json_t *root = parse(&run);
    assert_int_equal(whole(root, "spheres"), 2);
    assert_int_equal(json_array_size(json_object_get(root, "cameras")), 2);
    json_decref(root);
    program_run_free(&run);
}

/* ---- Ends -------------------------------------------------------------------------------------- */

static void a_time_limit_ends_the_render(void **state)
{
    (void)state;
    program_run run = RUN("render", "scene.gltf", "--time", "0.1", "--size", "64x32", "-o", "t.exr", "--json");
    program_run_check(&run, 0, "", "");
    json_t *root = parse(&run);
    assert_true(json_is_false(json_object_get(root, "complete")));
    assert_true(whole(root, "spp") >= 1 && whole(root, "spp") < 65536);
    json_decref(root);
    program_run_free(&run);
}

static void sleep_ms(long milliseconds)
{
    const struct timespec time = {milliseconds/1000, milliseconds%1000*1000000};
    nanosleep(&time, NULL);
}

/* Waits until stderr has a line of progress: then the render runs, and signals are caught. */
static void wait_for_progress(pid_t pid)
{
    for (int i = 0; i < 3000; i++) {
        char *text = read_bytes(in_folder(folder, "stderr"), NULL);
        const bool has_begun = text && strstr(text, "samples");
        free(text);
        if (has_begun) return;
        sleep_ms(20);
    }
    kill(pid, SIGKILL);
    fail_msg("no progress in a minute");
}

static void interrupted_renders_save_what_they_have(void **state)
{
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM};
    for (size_t i = 0; i < 2; i++) {
        remove_file("i.png");
        remove_file("stderr");
        const char *const argv[] = {FACET_PROGRAM, "render", "scene.gltf", "--size", "64x32", "--time",
                                    "8",           "-o",     "i.png",      "--json", NULL};
        const pid_t pid = start_program(folder, NULL, NULL, argv);
        wait_for_progress(pid);
        kill(pid, signals[i]);
        program_run run = {.status = wait_for_program(pid)};
        run.out = read_bytes(in_folder(folder, "stdout"), NULL);
        run.err = read_bytes(in_folder(folder, "stderr"), NULL);
        program_run_check(&run, 130, "", "facet: note: interrupted after ");
        json_t *root = parse(&run);
        assert_true(json_is_true(json_object_get(root, "interrupted")));
        assert_true(whole(root, "spp") >= 1);
        json_decref(root);
        program_run_free(&run);
        run = RUN("info", "i.png");
        expect_run(run, 0, "");
    }
}

/* ---- Progress ---------------------------------------------------------------------------------- */

/* stderr on a terminal of 80 columns: what the program prints there, all of it. */
static char *run_on_terminal(const char *const *argv)
{
    struct winsize size = {.ws_row = 24, .ws_col = 80};
    int terminal;
    const pid_t pid = forkpty(&terminal, NULL, NULL, &size);
    assert_true(pid >= 0);
    if (pid == 0) {
        unsetenv("COLUMNS");
        setenv("TERM", "xterm", 1);
        if (chdir(folder) != 0) _exit(127);
        execv(argv[0], (char *const *)argv);
        _exit(127);
    }
    char *text = calloc(1, 1 << 20);
    size_t n = 0;
    for (ssize_t got; (got = read(terminal, text + n, (1 << 20) - 1 - n)) > 0;) n += (size_t)got;
    assert_int_equal(wait_for_program(pid), 0);
    close(terminal);
    return text;
}

static void a_terminal_shows_a_bar_that_fits_and_ends(void **state)
{
    (void)state;
    const char *const argv[] = {FACET_PROGRAM, "render", "scene.gltf", "--size", "64x32",
                                "--time",      "0.6",    "-o",         "p.png",  NULL};
    char *text = run_on_terminal(argv);
    size_t n_bars = 0;
    for (char *bar = strchr(text, '\r'); bar; bar = strchr(bar + 1, '\r')) {
        if (bar[1] == '\n') continue; /* the terminal's own end of line */
        const size_t length = strcspn(bar + 1, "\r\033");
        if (length >= 80 || !strstr(bar, "% [")) fail_msg("a bar of %zu columns: %.100s", length, bar + 1);
        n_bars++;
    }
    assert_true(n_bars >= 2);
    assert_non_null(strstr(text, "\033[K\r\nfacet: wrote p.png"));
    free(text);
}

static void elsewhere_progress_is_ten_lines_at_most(void **state)
{
    (void)state;
    program_run run = RUN("render", "scene.gltf", "--size", "64x32", "--time", "0.5", "-o", "p.png");
    program_run_check(&run, 0, "", " M samples, ");
    size_t n = 0;
    for (const char *p = run.err; (p = strstr(p, " %, ")) != NULL; p++) n++;
    assert_true(n >= 1 && n <= 10);
    assert_null(strchr(run.err, '\r'));
    program_run_free(&run);
}

/* ---- compare ----------------------------------------------------------------------------------- */

static void comparisons_pass_and_fail_by_their_limit(void **state)
{
    (void)state;
    MAKE("x.exr", "--seed", "2");
    MAKE("x.png", "--seed", "2", "--view", "standard");
    MAKE("y.png", "--seed", "3", "--view", "standard");
    static const struct {
        const char *a, *b, *metric, *limit;
        int status;
    } cases[] = {
        {"x.png", "y.png", "rmse", "0", 1},
        {"x.png", "y.png", "rmse", "10", 0},
        {"x.png", "y.png", "flip", "0", 1},
        {"x.png", "y.png", "flip", "1", 0},
        {"x.png", "x.png", "flip", "0", 0},
        {"x.png", "x.png", "psnr", "300", 0},
        {"x.png", "y.png", "psnr", "300", 1},
        {"x.png", "y.png", "psnr", "0", 0},
        {"x.png", "y.png", "relmse", "0", 1},
        {"x.png", "x.png", "mean", "0", 0},
        {"x.png", "y.png", "mean", "0", 1},
        {"x.exr", "x.png", "psnr", "50", 0}, /* what is shown differs by the rounding to 8 bits only: 59 dB */
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        program_run run = RUN("compare", cases[i].a, cases[i].b, "--metric", cases[i].metric, "--max", cases[i].limit);
        program_run_check(&run, cases[i].status, "", "");
        assert_non_null(strstr(run.out, cases[i].metric));
        program_run_free(&run);
    }
    program_run run = RUN("compare", "x.png", "y.png", "--diff", "d.png");
    expect_run(run, 0, "note: d.png: white is a difference of ");
    run = RUN("info", "d.png");
    program_run_check(&run, 0, "", "");
    assert_non_null(strstr(run.out, "32 x 16 pixels"));
    program_run_free(&run);
    MAKE("small.png", "--crop", "0,0,8,8");
    run = RUN("compare", "x.png", "small.png");
    expect_run(run, 3, "small.png: has 8 x 8 pixels where x.png has 32 x 16; sizes have to match");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_carry_their_provenance),
        cmocka_unit_test(names_and_sizes_have_sensible_defaults),
        cmocka_unit_test(a_file_that_cannot_be_written_leaves_the_old_one),
        cmocka_unit_test(an_output_must_be_a_file),
        cmocka_unit_test(threads_do_not_change_a_pixel_and_seeds_do),
        cmocka_unit_test(options_change_the_picture_as_they_say),
        cmocka_unit_test(unknown_names_are_answered_with_the_known_ones),
        cmocka_unit_test(dark_scenes_without_cameras_are_shown_with_notes),
        cmocka_unit_test(damaged_scenes_are_status_3_and_leave_no_file),
        cmocka_unit_test(a_time_limit_ends_the_render),
        cmocka_unit_test(interrupted_renders_save_what_they_have),
        cmocka_unit_test(a_terminal_shows_a_bar_that_fits_and_ends),
        cmocka_unit_test(elsewhere_progress_is_ten_lines_at_most),
        cmocka_unit_test(comparisons_pass_and_fail_by_their_limit),
    };
    return cmocka_run_group_tests(tests, make_scene_folder, remove_test_folder);
}
