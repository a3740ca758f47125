/* test_limits.c: what a scene may reach and what it may take: files outside its folder, and memory.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "tests/program_folder.h"

/* A line of the shell in the folder, where $facet is the program. */
static program_run shell(const char *line)
{
    char command[2048];
    snprintf(command, sizeof command, "facet='%s'; %s", FACET_PROGRAM, line);
    return run_program(folder, NULL, NULL, (const char *const[]){"/bin/sh", "-c", command, NULL});
}

static void expect(const char *line, int status)
{
    program_run run = shell(line);
    if (run.status != status) fail_msg("%s\nstatus %d (expected %d)\n%s", line, run.status, status, run.err);
    program_run_free(&run);
}

/* Status 3, and one line that begins with `facet: error: ` and has all the parts, separated by '|'. */
static void expect_refusal(const char *line, const char *parts)
{
    program_run run = shell(line);
    const char *end = strchr(run.err, '\n');
    if (run.status != 3 || strncmp(run.err, "facet: error: ", 14) != 0 || !end || end[1])
        fail_msg("%s\nstatus %d (expected 3)\nstderr, expected one line:\n%s", line, run.status, run.err);
    char part[256];
    for (const char *p = parts; *p; p += strcspn(p, "|"), p += *p == '|') {
        snprintf(part, sizeof part, "%.*s", (int)strcspn(p, "|"), p);
        if (!strstr(run.err, part)) fail_msg("%s\nthe line lacks `%s`:\n%s", line, part, run.err);
    }
    program_run_free(&run);
}

/* ---- Files ------------------------------------------------------------------------------------- */

/* A triangle whose positions are in the file `uri`, with `more` among the members of its material. */
static void write_scene(const char *name, const char *uri, const char *more, const char *images)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}],"
             "\"materials\":[{\"pbrMetallicRoughness\":{%s}}],%s"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
             "\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
             "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
             more, images, uri);
    write_text(in_folder(folder, name), text);
}

/* scene/ with a file, one in a folder below, links that stay and links that lead out; and a file and a picture
 * outside. */
static void make_tree(void)
{
    expect("mkdir -p scene/sub other && cd scene && "
           "head -c 14 /dev/zero >a.bin && printf '\\200?' >>a.bin && head -c 14 /dev/zero >>a.bin && "
           "printf '\\200?' >>a.bin && head -c 4 /dev/zero >>a.bin && "
           "cp a.bin sub/b.bin && cp a.bin ../out.bin && cp a.bin ../other/c.bin && "
           "ln -sf sub/b.bin inner.bin && ln -sfn ../scene/sub round && ln -sf ../out.bin link.bin && "
           "ln -sf \"$(cd ..; pwd)/out.bin\" absolute.bin && ln -sf link.bin twice.bin && ln -sfn ../other far && "
           "ln -sfn .. up && ln -sf nowhere.bin broken.bin && "
           "$facet render demo --size 8x8 --spp 1 --quiet -o ../out.png",
           0);
}

static void references_inside_the_folder_are_read(void **state)
{
    (void)state;
    static const char *const uris[] = {"a.bin",       "sub/b.bin",      "sub/../a.bin", "inner.bin",
                                       "round/b.bin", "up/scene/a.bin", "%61.bin"};
    make_tree();
    for (size_t i = 0; i < sizeof uris/sizeof *uris; i++) {
        write_scene("scene/in.gltf", uris[i], "", "");
        expect("$facet info scene/in.gltf", 0);
        expect("cd scene && $facet info in.gltf", 0);
        expect("cd scene/sub && $facet info ../in.gltf", 0);
    }
}

static void references_that_lead_outside_need_the_option(void **state)
{
    (void)state;
    char uri[2][1100], more[256];
    snprintf(uri[0], sizeof uri[0], "%s/out.bin", folder);
    snprintf(uri[1], sizeof uri[1], "file://%s/out.bin", folder);
    const char *const uris[] = {"../out.bin", "%2e%2e/out.bin", "..%2Fout.bin", "sub/../../out.bin",
                                "link.bin",   "absolute.bin",   "twice.bin",    "far/c.bin",
                                "up/out.bin", uri[0],           uri[1]};
    make_tree();
    for (size_t i = 0; i < sizeof uris/sizeof *uris; i++) {
        write_scene("scene/out.gltf", uris[i], "", "");
        snprintf(more, sizeof more, "facet: error: scene/out.gltf:buffers[0].uri: |own folder|--allow-outside");
        expect_refusal("$facet info scene/out.gltf", more);
        expect_refusal("$facet render scene/out.gltf --size 8x8 --spp 1 -o x.png --quiet", more);
        expect_refusal("cd scene && $facet info out.gltf", "out.gltf:buffers[0].uri: |--allow-outside");
        expect("$facet info scene/out.gltf --allow-outside", 0);
        expect("$facet render scene/out.gltf --size 8x8 --spp 1 -o x.png --quiet --allow-outside", 0);
    }
    static const char textured[] = "\"baseColorTexture\":{\"index\":0}";
    write_scene("scene/picture.gltf", "a.bin", textured,
                "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"../out.png\"}],");
    expect_refusal("$facet info scene/picture.gltf",
                   "scene/picture.gltf:images[0].uri: |\"../out.png\"|--allow-outside");
    expect("$facet info scene/picture.gltf --allow-outside", 0);
}

static void the_option_reads_files_of_this_machine_alone(void **state)
{
    (void)state;
    static const struct {
        const char *uri, *said;
    } cases[] = {
        {"http://localhost/out.bin", "only data URIs and files of this machine"},
        {"file://elsewhere/out.bin", "only data URIs and files of this machine"},
        {"/dev/zero", "not a regular file"},
        {"broken.bin", "No such file"},
    };
    make_tree();
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        write_scene("scene/out.gltf", cases[i].uri, "", "");
        expect_refusal("$facet info scene/out.gltf --allow-outside", cases[i].said);
    }
}

/* ---- Memory ------------------------------------------------------------------------------------ */

/* A triangle list of n vertices that are all zero, without a buffer: a small file that asks for much. */
static void write_zeros(const char *name, size_t n)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"accessors\":[{\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[0,0,0]}]}",
        n);
    write_text(in_folder(folder, name), text);
}

static void memory_is_refused_before_it_is_taken(void **state)
{
    (void)state;
    write_zeros("zeros.gltf", 3000000000u); /* 36 GB */
    expect_refusal("$facet info zeros.gltf", "above|MiB|--max-memory SIZE");
    expect_refusal("$facet info zeros.gltf --max-memory 16G", "above 16384 MiB of memory; --max-memory SIZE");
    write_zeros("some.gltf", 3000000); /* 36 MB of positions */
    expect_refusal("$facet info some.gltf --max-memory 32M", "above 32 MiB of memory; --max-memory SIZE");
    expect("$facet info some.gltf --max-memory 1G", 0);
    expect_refusal("$facet info some.gltf --max-memory 100", "files of up to 100 bytes|--max-memory SIZE");
    expect_refusal("$facet render some.gltf -o x.png --max-memory 32M", "above 32 MiB of memory; --max-memory SIZE");
}

static void json_of_many_small_values_is_refused(void **state)
{
    (void)state;
    expect("(printf '{\"asset\":{\"version\":\"2.0\"},\"extras\":['; yes '{},' | head -n 200000 | tr -d '\\n'; "
           "printf '{}]}') >many.gltf",
           0);
    expect_refusal("$facet info many.gltf --max-memory 32M", "many.gltf: |above 32 MiB of memory; --max-memory SIZE");
    expect("$facet info many.gltf --max-memory 256M", 0);
}

static void pictures_are_refused_before_they_are_decoded(void **state)
{
    (void)state;
    expect("$facet render demo --size 64x64 --spp 1 --quiet -o p.png -o p.exr", 0); /* 12 and 48 KiB */
    static const char *const pictures[] = {"p.png", "p.exr"};
    static const char *const sizes[] = {"12287", "49151"}, *const enough[] = {"12288", "49152"};
    for (int i = 0; i < 2; i++) {
        char line[256];
        snprintf(line, sizeof line, "$facet info %s --max-memory %s", pictures[i], sizes[i]);
        expect_refusal(line, "64 x 64 pixels|--max-memory SIZE");
        snprintf(line, sizeof line, "$facet compare %s %s --max-memory %s", pictures[i], pictures[i], sizes[i]);
        expect_refusal(line, "64 x 64 pixels|--max-memory SIZE");
        snprintf(line, sizeof line, "$facet info %s --max-memory %s", pictures[i], enough[i]);
        expect(line, 0);
    }
    expect_refusal("$facet render demo --env p.exr --max-memory 40K -o x.png", "p.exr: |--max-memory SIZE");
}

/* Where the limit is the world's and not the option's, the status is 4. */
static void without_address_space_a_scene_ends_in_order(void **state)
{
    (void)state;
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    print_message("skipped: sanitizers reserve terabytes\n");
    skip();
#endif
#endif
    int n_refused = 0, n_read = 0;
    write_zeros("large.gltf", 12000000); /* 144 MB of positions, and as much of normals */
    for (int limit = 50; limit <= 1000; limit += 50) {
        char line[128];
        snprintf(line, sizeof line, "ulimit -v %d; $facet info large.gltf --max-memory 2G", limit*1024);
        program_run run = shell(line);
        if (run.status != 0 && run.status != 4 && run.status != 127) /* 127: no room for the program itself */
            fail_msg("%d MiB: status %d\n%s", limit, run.status, run.err);
        if (run.status == 4) assert_true(strncmp(run.err, "facet: error: ", 14) == 0);
        n_refused += run.status == 4;
        n_read += run.status == 0;
        program_run_free(&run);
    }
    assert_true(n_refused > 0 && n_read > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(references_inside_the_folder_are_read),
        cmocka_unit_test(references_that_lead_outside_need_the_option),
        cmocka_unit_test(the_option_reads_files_of_this_machine_alone),
        cmocka_unit_test(memory_is_refused_before_it_is_taken),
        cmocka_unit_test(json_of_many_small_values_is_refused),
        cmocka_unit_test(pictures_are_refused_before_they_are_decoded),
        cmocka_unit_test(without_address_space_a_scene_ends_in_order),
    };
    return cmocka_run_group_tests_name("limits", tests, make_test_folder, remove_test_folder);
}
