/* test_cli_files.c: no output of the program destroys what it reads, or another file, and none fails only after the
 * work is done.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/program_folder.h"

#define RENDER(...) RUN("render", "--size", "8x8", "--spp", "2", "--quiet", __VA_ARGS__)

/* The run ends with a usage error of this text, and each byte of the file stays. */
static void expect_spared(program_run run, const char *name, const char *text, const char *error)
{
    size_t size;
    expect_run(run, 2, error);
    char *bytes = read_bytes(in_folder(folder, name), &size);
    assert_non_null(bytes);
    assert_int_equal(size, strlen(text));
    assert_memory_equal(bytes, text, size);
    free(bytes);
}

static void outputs_that_are_inputs_are_refused(void **state)
{
    (void)state;
    static const char input[] = "is an input, too, and would be lost; name another output";
    char *scene = read_bytes(in_folder(folder, "scene.gltf"), NULL);
    assert_int_equal(symlink("scene.gltf", in_folder(folder, "link.ckpt")), 0);
    expect_spared(RENDER("scene.gltf", "--checkpoint", "scene.gltf"), "scene.gltf", scene, input);
    expect_spared(RENDER("scene.gltf", "--checkpoint", "link.ckpt"), "scene.gltf", scene, input);
    expect_spared(RENDER("scene.gltf", "--events", "./scene.gltf"), "scene.gltf", scene, input);
    free(scene);
    expect_run(RENDER("-o", "sky.exr", "-o", "sky.png"), 0, "");
    expect_run(RENDER("-o", "sky.exr", "--env", "./sky.exr"), 2, input);
    write_text(in_folder(folder, "token"), "0123456789abcdef0123456789abcdef\n");
    expect_run(RENDER("--events", "token", "--serve", "0", "--serve-token", "token"), 2, input);
    expect_run(RUN("compare", "sky.png", "sky.exr", "--diff", "./sky.png"), 2, input);
    expect_run(RUN("compare", "sky.exr", "sky.png", "--diff", "sky.png"), 2, input);
    expect_run(RUN("compare", "sky.exr", "sky.png", "--diff", "other.png"), 0, "");
}

static void files_of_the_scene_are_spared(void **state)
{
    (void)state;
    /* The default picture of box.gltf is box.png, which is a texture of it here. */
    static const char scene[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"images\":[{\"uri\":\"box.png\"}],"
        "\"nodes\":[{\"extensions\":{\"FACET_shape\":{\"sphere\":{\"radius\":1},\"material\":0}}}],"
        "\"extensionsUsed\":[\"FACET_shape\"],\"textures\":[{\"source\":0}],"
        "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]}";
    write_text(in_folder(folder, "box.gltf"), scene);
    expect_run(RENDER("-o", "box.png"), 0, "");
    expect_run(RENDER("box.gltf"), 2, "box.png: is a file of the scene, and would be lost; name another output by -o");
    expect_run(RENDER("box.gltf", "-o", "seen.png"), 0, "");
}

static void a_checkpoint_replaces_checkpoints_alone(void **state)
{
    (void)state;
    static const char error[] = "facet: error: --checkpoint: `notes.txt` is there and is not a checkpoint";
    write_text(in_folder(folder, "notes.txt"), "notes of years");
    expect_spared(RENDER("scene.gltf", "--checkpoint", "notes.txt"), "notes.txt", "notes of years", error);
    write_text(in_folder(folder, "notes.txt"), "facet");
    expect_spared(RENDER("scene.gltf", "--checkpoint", "notes.txt"), "notes.txt", "facet", error);
    write_text(in_folder(folder, "notes.txt"), "");
    for (int i = 0; i < 2; i++) expect_run(RENDER("scene.gltf", "--checkpoint", "notes.txt"), 0, "");
    expect_run(RENDER("scene.gltf", "--checkpoint", "notes.txt", "--resume", "./notes.txt"), 0, "");
    expect_run(RENDER("scene.gltf", "--checkpoint", "b.ckpt", "--resume", "notes.txt"), 0, "");
    expect_run(RENDER("scene.gltf", "--events", "notes.txt", "--resume", "notes.txt"), 2, "is an input, too");
    /* Another name of the same checkpoint, as merge's input. */
    assert_int_equal(link(in_folder(folder, "b.ckpt"), in_folder(folder, "b.exr")), 0);
    expect_run(RUN("merge", "b.ckpt", "-o", "b.exr"), 2, "b.exr: is an input, too");
}

static void one_file_cannot_be_two_outputs(void **state)
{
    (void)state;
    static const char error[] = "is named twice as an output; name it once";
    expect_run(RENDER("-o", "dup.png", "-o", "./dup.png"), 2, error);
    expect_run(RENDER("-o", "dup.exr", "--events", "dup.exr"), 2, error);
    expect_run(RENDER("--checkpoint", "d", "--events", "d"), 2, error);
    assert_int_not_equal(access(in_folder(folder, "dup.exr"), F_OK), 0);
    expect_run(RENDER("-o", "facet.exr", "--events", "-"), 0, "");
}

static void names_that_cannot_be_written_are_told_before_rendering(void **state)
{
    (void)state;
    char name[300];
    for (int length = 220; length <= 260; length += 5) {
        memset(name, 'a', sizeof name);
        strcpy(name + length - 4, ".png");
        program_run run = RUN("render", "--size", "8x8", "--spp", "1", "-o", name);
        assert_int_equal(run.status, length <= 255 ? 0 : 4);
        if (run.status && strstr(run.err, "%")) fail_msg("rendered first: %s", run.err);
        assert_int_equal(access(in_folder(folder, name), F_OK) == 0, length <= 255);
        program_run_free(&run);
    }
    memset(name, 'c', sizeof name);
    name[256] = 0;
    program_run run = RUN("render", "--size", "8x8", "--spp", "1", "--checkpoint", name);
    program_run_check(&run, 4, "", "cannot create: File name too long");
    assert_null(strstr(run.err, "%"));
    program_run_free(&run);
    run = RUN("render", "--size", "8x8", "--spp", "1", "-o", "/dev/none.png");
    program_run_check(&run, 4, "", "facet: error: /dev/none.png: cannot create: ");
    assert_null(strstr(run.err, "%"));
    program_run_free(&run);
}

static void a_link_leads_to_the_file_that_is_written(void **state)
{
    (void)state;
    struct stat info;
    assert_int_equal(symlink("real.png", in_folder(folder, "by link.png")), 0);
    for (int i = 0; i < 2; i++) {
        expect_run(RENDER("-o", "by link.png"), 0, "");
        assert_int_equal(lstat(in_folder(folder, "by link.png"), &info), 0);
        assert_true(S_ISLNK(info.st_mode));
        assert_int_equal(lstat(in_folder(folder, "real.png"), &info), 0);
        assert_true(S_ISREG(info.st_mode) && info.st_size > 0);
    }
}

static void pipes_are_refused_and_not_waited_for(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(in_folder(folder, "pipe"), 0600), 0);
    expect_run(RUN("info", "pipe"), 3, "facet: error: pipe: is not a regular file");
}

static void layers_that_a_checkpoint_keeps_are_no_cause_for_a_warning(void **state)
{
    (void)state;
    expect_run(RENDER("--shard", "2/2", "--checkpoint", "2.ckpt", "--aov", "albedo"), 0, "");
    program_run run = RENDER("-o", "w.png", "--checkpoint", "w.ckpt", "--aov", "albedo");
    assert_int_equal(run.status, 0);
    assert_int_equal(strlen(run.err), 0);
    program_run_free(&run);
    run = RENDER("--shard", "1/2", "--checkpoint", "1.ckpt", "--aov", "albedo");
    assert_int_equal(strlen(run.err), 0);
    program_run_free(&run);
    expect_run(RUN("merge", "1.ckpt", "2.ckpt", "--aov", "albedo", "-o", "merged.exr"), 0, "");
    expect_run(RENDER("-o", "w.png", "--aov", "albedo"), 0, "warning: --aov has no effect");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outputs_that_are_inputs_are_refused),
        cmocka_unit_test(files_of_the_scene_are_spared),
        cmocka_unit_test(a_checkpoint_replaces_checkpoints_alone),
        cmocka_unit_test(one_file_cannot_be_two_outputs),
        cmocka_unit_test(names_that_cannot_be_written_are_told_before_rendering),
        cmocka_unit_test(a_link_leads_to_the_file_that_is_written),
        cmocka_unit_test(pipes_are_refused_and_not_waited_for),
        cmocka_unit_test(layers_that_a_checkpoint_keeps_are_no_cause_for_a_warning),
    };
    return cmocka_run_group_tests_name("cli_files", tests, make_scene_folder, remove_test_folder);
}
