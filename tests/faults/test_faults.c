/* test_faults.c: what a world that fails does to a render: full disks, folders that vanish, no memory, inputs that are
 * damaged or changed.  One line says what happened, the exit status whose fault it is, and nothing is lost.
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

#include "io/image_file.h"
#include "tests/picture_bytes.h"
#include "tests/program_folder.h"
#include "tests/scene_builder.h"

/* A line of the shell in the folder, where $facet renders the scene. */
static program_run shell(const char *line)
{
    char command[2048];
    snprintf(command, sizeof command, "facet='%s'; r='%s render scene.gltf --size 64x32 --quiet'; %s", FACET_PROGRAM,
             FACET_PROGRAM, line);
    return run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
}

static void expect(const char *line, int status, const char *in_err)
{
    program_run run = shell(line);
    if (run.status != status || !strstr(run.err, in_err))
        fail_msg("%s\nstatus %d (expected %d)\nstdout:\n%s\nstderr, expected `%s`:\n%s", line, run.status, status,
                 run.out, in_err, run.err);
    program_run_free(&run);
}

/* The same, and the message is the only line. */
static void expect_line(const char *line, int status, const char *in_err)
{
    program_run run = shell(line);
    const char *end = strchr(run.err, '\n');
    if (run.status != status || !strstr(run.err, in_err) || strncmp(run.err, "facet: error: ", 14) != 0 || !end ||
        end[1])
        fail_msg("%s\nstatus %d (expected %d)\nstderr, expected one line with `%s`:\n%s", line, run.status, status,
                 in_err, run.err);
    program_run_free(&run);
}

/* ---- Outputs ------------------------------------------------------------------------------------------------- */

/* ulimit -f stands for a disk that fills up: writes fail after so many blocks of 512 bytes. */
static void a_checkpoint_that_cannot_be_written_leaves_the_one_before(void **state)
{
    (void)state;
    expect("$r --spp 8 -o whole.exr", 0, "");
    expect("$r --spp 8 --noise 1 -o x.exr --checkpoint a.ckpt && cp a.ckpt before.ckpt", 0, ""); /* ends at 16 */
    static const int limits[] = {1, 2, 9, 100};
    for (size_t i = 0; i < sizeof limits/sizeof *limits; i++) {
        char line[256];
        snprintf(line, sizeof line,
                 "(ulimit -f %d; $r --spp 8 -o y.exr --resume a.ckpt --checkpoint a.ckpt --checkpoint-interval 0)",
                 limits[i]);
        expect(line, 4, "facet: error: a.ckpt: cannot write: File too large");
        expect("cmp a.ckpt before.ckpt && ! ls *.tmp-*", 0, "");
    }
    expect("$r --spp 8 -o y.exr --resume a.ckpt", 0, "");
    assert_same_pixels(folder, "whole.exr", "y.exr");
}

static void need_mounts(void)
{
    program_run run = shell("mkdir -p disk && unshare -rm mount -t tmpfs -o size=64k tmpfs disk");
    const bool can_mount = run.status == 0;
    program_run_free(&run);
    if (can_mount) return;
    print_message("skipped: no mount namespaces here\n");
    skip();
}

/* A file system of 64 KiB, in a mount namespace of the test's own. */
static void a_full_disk_costs_the_checkpoint_that_did_not_fit(void **state)
{
    (void)state;
    need_mounts();
    expect("unshare -rm sh -ec 'mount -t tmpfs -o size=64k tmpfs disk; "
           "head -c 60000 /dev/zero > disk/ballast; "
           "'\"$r\"' --spp 4 -o disk/a.exr --checkpoint disk/a.ckpt'",
           4, "facet: error: disk/a.ckpt: cannot write: no space left on the device");
    /* Full only later: the checkpoint before stays whole, and the render can be resumed from it. */
    expect("$r --spp 4 -o whole.exr", 0, "");
    expect("unshare -rm sh -ec 'mount -t tmpfs -o size=260k tmpfs disk; "
           "'\"$r\"' --spp 2 --shard 1/1 --checkpoint disk/a.ckpt; cp disk/a.ckpt before; "
           "status=0; '\"$r\"' --spp 2 --shard 1/1 --checkpoint disk/a.ckpt --resume disk/a.ckpt || status=$?; "
           "cmp disk/a.ckpt before; test \"$(ls disk)\" = a.ckpt; exit $status'",
           4, "facet: error: disk/a.ckpt: cannot write: no space left on the device");
}

/* Of two pictures the one that fits is written, and nothing is left of the other. */
static void a_full_disk_costs_the_picture_that_did_not_fit(void **state)
{
    (void)state;
    need_mounts();
    expect("unshare -rm sh -ec 'mount -t tmpfs -o size=64k tmpfs disk; "
           "head -c 65536 /dev/zero > disk/ballast; status=0; "
           "'\"$r\"' --spp 1 -o disk/a.exr -o fits.png || status=$?; test \"$(ls disk)\" = ballast; exit $status'",
           4, "facet: error: disk/a.exr: cannot write: no space left on the device");
    expect("$facet info fits.png", 0, "");
}

static void a_read_only_disk_is_told_before_rendering(void **state)
{
    (void)state;
    need_mounts();
    static const char *const outputs[] = {"-o disk/a.png", "-o b.png --checkpoint disk/a.ckpt",
                                          "-o b.png --events disk/e"};
    for (size_t i = 0; i < sizeof outputs/sizeof *outputs; i++) {
        char line[256];
        snprintf(line, sizeof line,
                 "unshare -rm sh -ec 'mount -t tmpfs -o ro tmpfs disk; '\"$r\"' --spp 1 %s; exit $?'", outputs[i]);
        expect_line(line, 4, "Read-only file system");
        expect("! test -e b.png", 0, "");
    }
}

static void read_only_and_vanished_folders_are_told(void **state)
{
    (void)state;
    expect_line("$r --spp 1 -o none/x.exr", 4, "facet: error: none/x.exr: the folder `none` cannot be used");
    expect_line("$r --spp 1 --checkpoint none/x.ckpt", 4, "facet: error: none/x.ckpt: the folder `none`");
    expect_line("$r --spp 1 -o /proc/x.exr", 4, "facet: error: /proc/x.exr: ");
    if (geteuid() != 0) expect_line("mkdir ro; chmod 555 ro; $r --spp 1 -o ro/x.exr", 4, "the folder `ro` cannot be");
    /* A folder that goes while the render runs: the picture is lost, the checkpoint has all of it. */
    expect("$r --spp 64 -o whole.exr", 0, "");
    expect("mkdir out; ($r --time 0.5 -o out/x.exr --checkpoint v.ckpt; echo $? > status) & "
           "sleep 0.2; rmdir out; wait; exit $(cat status)",
           4, "facet: error: out/x.exr: cannot create: No such file or directory");
    expect("$r --time 0.5 -o x.exr --resume v.ckpt && $facet merge v.ckpt -o y.exr", 0, "");
    assert_same_pixels(folder, "x.exr", "y.exr");
}

/* ---- Inputs -------------------------------------------------------------------------------------------------- */

/* A quad with a texture and an external buffer. */
static const char textured_scene[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
    "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"texture.png\"}],"
    "\"buffers\":[{\"uri\":\"scene.bin\",\"byteLength\":60}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
    "\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}]}";

static void write_textured_scene(const char *texture_name)
{
    static const float values[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
    unsigned char texels[48];
    for (size_t i = 0; i < sizeof texels; i++) texels[i] = (unsigned char)(5*i);
    const image picture = {.width = 4, .height = 4, .n_channels = 3, .type = PIXEL_U8, .pixels = texels};
    write_text(in_folder(folder, "t.gltf"), textured_scene);
    FILE *file = fopen(in_folder(folder, "scene.bin"), "wb");
    assert_int_equal(fwrite(values, sizeof values, 1, file), 1);
    fclose(file);
    assert_int_equal(png_write(in_folder(folder, texture_name), &picture, NULL, 0, NULL), FACET_OK);
}

#define TEXTURED "$facet render t.gltf --size 64x32 --spp 4 --quiet "

static void damaged_and_vanished_inputs_are_told(void **state)
{
    (void)state;
    write_textured_scene("texture.png");
    expect(TEXTURED "-o t.exr --checkpoint t.ckpt", 0, "");
    expect_line("mv scene.bin away; " TEXTURED "-o u.exr; s=$?; mv away scene.bin; exit $s", 3,
                "facet: error: t.gltf:buffers[0].uri: \"scene.bin\": cannot open: No such file or directory");
    expect_line("mv t.gltf away; " TEXTURED "-o u.exr; s=$?; mv away t.gltf; exit $s", 3,
                "facet: error: t.gltf: cannot open: No such file or directory");
    for (int size = 0; size < 70; size += 7) {
        char line[256];
        snprintf(line, sizeof line,
                 "cp texture.png whole; head -c %d whole > texture.png; " TEXTURED
                 "-o u.exr; s=$?; cp whole texture.png; exit $s",
                 size);
        expect_line(line, 3, "facet: error: t.gltf:images[0]");
    }
    expect("! test -e u.exr", 0, "");
    /* Once it is read, a scene may go. */
    expect(
        "$facet render t.gltf --size 64x32 --time 0.4 --quiet -o v.exr & sleep 0.2; rm texture.png scene.bin; wait $!",
        0, "");
}

static void a_scene_whose_files_change_is_another_scene(void **state)
{
    (void)state;
    write_textured_scene("texture.png");
    expect(TEXTURED "-o t.exr --checkpoint t.ckpt", 0, "");
    expect("touch texture.png; " TEXTURED "-o u.exr --resume t.ckpt", 0, "");
    assert_same_but_for_time(folder, "t.exr", "u.exr");
    expect_line("printf '\\1' | dd of=scene.bin bs=1 seek=10 conv=notrunc 2>/dev/null; " TEXTURED
                "-o u.exr --resume t.ckpt",
                3, "facet: error: t.ckpt: was made with a scene (with its files, --env and --material) of hash ");
    write_textured_scene("texture.png");
    expect_line("printf 'x' >> texture.png; " TEXTURED "-o u.exr --resume t.ckpt", 3, "was made with a scene");
    write_textured_scene("texture.png");
    expect("cp t.exr sky.exr; " TEXTURED "--env sky.exr -o t.exr --checkpoint s.ckpt", 0, "");
    expect_line("cp whole.exr sky.exr; " TEXTURED "--env sky.exr -o u.exr --resume s.ckpt", 3, "was made with a scene");
    expect(TEXTURED "--env t.exr -o u.exr --resume t.ckpt", 3, "was made with a scene");
}

/* ---- Memory -------------------------------------------------------------------------------------------------- */

/* Limits from nothing to plenty: the render works, or says that there is no memory; it never does anything else.  A
 * program that cannot be loaded (127) has had no chance. */
static void without_memory_a_render_ends_in_order(void **state)
{
    (void)state;
    if (SAMPLE_DIVISOR > 1) {
        print_message("skipped: sanitizers reserve terabytes\n");
        skip();
    }
    int n_refused = 0, n_rendered = 0;
    expect("$r --spp 4 -o whole.exr --checkpoint m.ckpt && cp m.ckpt before.ckpt", 0, "");
    for (int limit = 40; limit <= 400; limit += 10) {
        char line[256];
        snprintf(line, sizeof line, "ulimit -v %d; $r --spp 4 --threads 2 -o m.exr --resume m.ckpt --checkpoint m.ckpt",
                 limit*1024);
        program_run run = shell(line);
        if (run.status != 0 && run.status != 4 && run.status != 127)
            fail_msg("%d MiB: status %d\n%s", limit, run.status, run.err);
        if (run.status == 4) assert_non_null(strstr(run.err, "facet: error: "));
        n_refused += run.status == 4;
        n_rendered += run.status == 0;
        program_run_free(&run);
        expect("$r --spp 4 -o n.exr --resume m.ckpt", 0, "");
        assert_same_pixels(folder, "whole.exr", "n.exr");
    }
    print_message("%d limits refused, %d rendered\n", n_refused, n_rendered);
    assert_true(n_refused > 0 && n_rendered > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_checkpoint_that_cannot_be_written_leaves_the_one_before),
        cmocka_unit_test(a_full_disk_costs_the_checkpoint_that_did_not_fit),
        cmocka_unit_test(a_full_disk_costs_the_picture_that_did_not_fit),
        cmocka_unit_test(a_read_only_disk_is_told_before_rendering),
        cmocka_unit_test(read_only_and_vanished_folders_are_told),
        cmocka_unit_test(damaged_and_vanished_inputs_are_told),
        cmocka_unit_test(a_scene_whose_files_change_is_another_scene),
        cmocka_unit_test(without_memory_a_render_ends_in_order),
    };
    return cmocka_run_group_tests_name("faults", tests, make_scene_folder, remove_test_folder);
}
