/* fuzz_uri.c: libFuzzer's way into the names of files in a scene: whatever is written there, a scene read without
 * --allow-outside never comes to the file outside of its folder, to which links lead, too.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/gltf.h"
#include "tests/fuzz/parts/harness.h"

/* A triangle's positions; those outside are larger. */
static const float inside[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, outside[9] = {0, 0, 0, 7, 0, 0, 0, 7, 0};

static char scene_path[160], root[128];

static void remove_tree(void)
{
    static const char *const names[] = {"in/scene.gltf", "in/a.bin", "in/link.bin", "in/inner.bin", "in/up",
                                        "in/sub/b.bin",  "in/sub",   "in",          "out.bin",      ""};
    for (size_t i = 0; i < sizeof names/sizeof *names; i++) {
        char path[192];
        snprintf(path, sizeof path, "%s/%s", root, names[i]);
        if (unlink(path)) rmdir(path);
    }
}

static const char *in_root(const char *name)
{
    static char paths[2][192];
    static int next;
    char *path = paths[next++ & 1];
    snprintf(path, sizeof paths[0], "%s/%s", root, name);
    return path;
}

static void write_numbers(const char *path, const float numbers[9])
{
    FILE *file = fopen(path, "wb");
    require(file && fwrite(numbers, sizeof *numbers, 9, file) == 9 && fclose(file) == 0);
}

/* A folder with two files, one more below it, a link that stays and two that lead out. */
static void make_tree(void)
{
    strcpy(root, own_path("tree"));
    atexit(remove_tree);
    require(mkdir(root, 0700) == 0 && mkdir(in_root("in"), 0700) == 0 && mkdir(in_root("in/sub"), 0700) == 0);
    write_numbers(in_root("out.bin"), outside);
    write_numbers(in_root("in/a.bin"), inside);
    write_numbers(in_root("in/sub/b.bin"), inside);
    require(symlink("../out.bin", in_root("in/link.bin")) == 0);
    require(symlink("sub/b.bin", in_root("in/inner.bin")) == 0);
    require(symlink("..", in_root("in/up")) == 0);
    strcpy(scene_path, in_root("in/scene.gltf"));
}

/* The input as a JSON string, byte by byte; what is not ASCII becomes a character of its own. */
static void put_string(FILE *file, const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        if (bytes[i] >= 32 && bytes[i] < 127 && bytes[i] != '"' && bytes[i] != '\\') fputc(bytes[i], file);
        else fprintf(file, "\\u%04x", bytes[i]);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (!scene_path[0]) make_tree();
    FILE *file = fopen(scene_path, "w");
    require(file != NULL);
    fputs("{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"scene\":0,\"nodes\":[{\"mesh\":0}],"
          "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
          "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
          "\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
          "\"buffers\":[{\"byteLength\":36,\"uri\":\"",
          file);
    put_string(file, bytes, size);
    fputs("\"}]}", file);
    require(fclose(file) == 0);
    scene *s = NULL;
    facet_error why = {0};
    if (gltf_read(scene_path, NULL, NULL, &s, &why)) {
        require(why.text[0] != 0);
    } else {
        require(s->n_meshes == 1 && s->meshes[0].n_vertices == 3);
        for (int i = 0; i < 9; i++) require(s->meshes[0].positions[i/3][i%3] != 7);
    }
    scene_destroy(s);
    return 0;
}
