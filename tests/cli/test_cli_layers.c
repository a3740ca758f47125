/* test_cli_layers.c: `facet render` and `facet merge` with --aov and --denoise, and --noise.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>
#include <jansson.h>

#include "tests/program_folder.h"

#define RENDER(...) RUN("render", "scene.gltf", "--size", "48x24", __VA_ARGS__)

static int setup(void **state)
{
    unsetenv("FACET_OIDN");
    make_scene_folder(state);
    return 0;
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

static void layers_stand_beside_the_picture(void **state)
{
    (void)state;
    static const char *const channels[] = {"albedo.R", "albedo.B", "normal.X", "normal.Z", "distance.Z", "samples.Y"};
    expect_run(RENDER("--spp", "3", "--quiet", "-o", "plain.exr"), 0, "");
    expect_run(
        RENDER("--spp", "3", "--quiet", "--aov", "normal,albedo,samples,distance", "-o", "all.exr", "-o", "all.png"), 0,
        "");
    expect_run(RUN("compare", "plain.exr", "all.exr", "--metric", "mse", "--max", "0"), 0, "");
    for (size_t i = 0; i < sizeof channels/sizeof *channels; i++) {
        assert_true(holds("all.exr", channels[i]));
        assert_false(holds("plain.exr", channels[i]));
    }
    assert_false(holds("all.exr", "noisy.R"));
}

static void info_tells_how_a_picture_was_made(void **state)
{
    (void)state;
    expect_run(
        RENDER("--spp", "2", "--quiet", "--half", "--aov", "albedo", "--seed", "7", "-o", "i.exr", "-o", "i.png"), 0,
        "");
    program_run run = RUN("info", "i.exr");
    assert_int_equal(run.status, 0);
    static const char *const lines[] = {"3 channels, half\n", "\n  channel albedo.R       half\n",
                                        "\n  facet:seed             7\n", "\n  facet:command          "};
    for (size_t i = 0; i < sizeof lines/sizeof *lines; i++) assert_non_null(strstr(run.out, lines[i]));
    program_run_free(&run);
    run = RUN("info", "i.png");
    assert_non_null(strstr(run.out, "\n  facet:seed             7\n"));
    assert_null(strstr(run.out, "  channel "));
    program_run_free(&run);
    run = RUN("info", "i.exr", "--json");
    json_t *told = json_loads(run.out, 0, NULL);
    assert_string_equal(json_string_value(json_object_get(json_object_get(told, "types"), "albedo.G")), "half");
    assert_string_equal(json_string_value(json_object_get(json_object_get(told, "texts"), "facet:seed")), "7");
    json_decref(told);
    program_run_free(&run);
}

static void what_layers_need_is_said_at_once(void **state)
{
    (void)state;
    expect_run(RENDER("--aov", "albedo,depth", "-o", "x.exr"), 2,
               "facet: error: --aov: `depth` is none of albedo, normal,");
    expect_run(RENDER("--aov", "noisy", "-o", "x.exr"), 2,
               "--aov: noisy is the picture before --denoise, which is not given");
    expect_run(RENDER("--oidn", FACET_FAKE_OIDN, "-o", "x.exr"), 2,
               "--oidn: is the library of --denoise, which is not given");
    expect_run(
        RENDER("--denoise", "--oidn", "/nowhere/x.so", "-o", "x.exr"), 4,
        "facet: error: /nowhere/x.so: cannot be loaded: cannot open shared object file: No such file or directory; "
        "give --oidn");
    expect_run(RENDER("--spp", "1", "--aov", "albedo", "-o", "x.png"), 0,
               "--aov has no effect: no output is an .exr file");
    assert_true(access(in_folder(folder, "x.exr"), F_OK) != 0);
}

static void the_denoised_picture_takes_the_place_of_the_noisy_one(void **state)
{
    (void)state;
    expect_run(RENDER("--spp", "3", "--quiet", "-o", "noisy.exr"), 0, "");
    expect_run(
        RENDER("--spp", "3", "--quiet", "--denoise", "--oidn", FACET_FAKE_OIDN, "--aov", "noisy", "-o", "clean.exr"), 0,
        "");
    expect_run(RUN("compare", "noisy.exr", "clean.exr", "--metric", "mse", "--max", "0"), 1, "");
    assert_true(holds("clean.exr", "noisy.G") && holds("clean.exr", "facet:denoiser"));
    assert_true(holds("clean.exr", "Open Image Denoise 2.3.99") && !holds("noisy.exr", "facet:denoiser"));
    setenv("FACET_OIDN", FACET_FAKE_OIDN, 1);
    expect_run(RENDER("--spp", "3", "--quiet", "--denoise", "-o", "again.exr"), 0, "");
    unsetenv("FACET_OIDN");
    expect_run(RUN("compare", "again.exr", "clean.exr", "--metric", "mse", "--max", "0"), 0, "");
}

static void shards_keep_what_layers_need(void **state)
{
    (void)state;
    expect_run(RENDER("--spp", "4", "--quiet", "--aov", "normal", "-o", "whole.exr"), 0, "");
    expect_run(RENDER("--spp", "4", "--quiet", "--denoise", "--oidn", FACET_FAKE_OIDN, "-o", "clean.exr"), 0, "");
    expect_run(RENDER("--spp", "4", "--quiet", "--aov", "normal", "--shard", "1/2", "--checkpoint", "1.ckpt"), 0, "");
    expect_run(RENDER("--spp", "4", "--quiet", "--aov", "albedo", "--shard", "2/2", "--checkpoint", "2.ckpt"), 0, "");
    expect_run(RENDER("--spp", "4", "--quiet", "--shard", "2/2", "--checkpoint", "bare.ckpt"), 0, "");
    expect_run(RUN("merge", "2.ckpt", "1.ckpt", "--aov", "normal,samples", "-o", "merged.exr"), 0, "");
    expect_run(RUN("compare", "whole.exr", "merged.exr", "--metric", "mse", "--max", "0"), 0, "");
    assert_true(holds("merged.exr", "normal.Y") && holds("merged.exr", "samples.Y"));
    expect_run(RUN("merge", "2.ckpt", "1.ckpt", "--denoise", "--oidn", FACET_FAKE_OIDN, "-o", "merged.exr"), 0, "");
    expect_run(RUN("compare", "clean.exr", "merged.exr", "--metric", "mse", "--max", "0"), 0, "");
    expect_run(RUN("merge", "1.ckpt", "bare.ckpt", "-o", "x.exr"), 3,
               "was made with features (--aov, --denoise) not kept; 1.ckpt has features (--aov, --denoise) kept");
    expect_run(RENDER("--spp", "4", "--quiet", "--checkpoint", "alone.ckpt", "-o", "x.exr"), 0, "");
    expect_run(RUN("merge", "alone.ckpt", "--aov", "albedo", "-o", "x.exr"), 3,
               "alone.ckpt: keeps no features for --aov and --denoise; render it with one of them");
    expect_run(RENDER("--spp", "4", "--aov", "albedo", "--resume", "alone.ckpt", "-o", "x.exr"), 3,
               "was made with features (--aov, --denoise) not kept");
    /* What a checkpoint keeps is kept on, asked for or not. */
    expect_run(RENDER("--spp", "4", "--resume", "1.ckpt", "--shard", "1/2", "--checkpoint", "1.ckpt"), 0, "");
}

static void a_noise_target_ends_tiles_and_the_render(void **state)
{
    (void)state;
    program_run run = RENDER("--noise", "0.05", "--quiet", "--json", "--seed", "3", "-o", "n.exr");
    json_t *root = json_loads(run.out, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(root);
    const double noise = json_number_value(json_object_get(root, "noise")),
                 mean = json_number_value(json_object_get(root, "mean_spp")),
                 spp = (double)json_integer_value(json_object_get(root, "spp"));
    assert_true(noise > 0 && noise <= .05 && mean >= 16 && mean <= spp);
    assert_true(json_is_false(json_object_get(root, "complete")));
    json_decref(root);
    expect_run(run, 0, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_stand_beside_the_picture),
        cmocka_unit_test(info_tells_how_a_picture_was_made),
        cmocka_unit_test(what_layers_need_is_said_at_once),
        cmocka_unit_test(the_denoised_picture_takes_the_place_of_the_noisy_one),
        cmocka_unit_test(shards_keep_what_layers_need),
        cmocka_unit_test(a_noise_target_ends_tiles_and_the_render),
    };
    return cmocka_run_group_tests(tests, setup, remove_test_folder);
}
