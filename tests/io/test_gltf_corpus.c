/* test_gltf_corpus.c: the collections of real and hostile glTF files in ../shared/assets, all of them.
 *
 * Skips, and says so, where the collections are absent.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "io/gltf.h"

static const char assets[] = FACET_SOURCE_DIR "/../shared/assets";

static void need_assets(void)
{
    struct stat info;
    if (stat(assets, &info) == 0) return;
    print_message("skipped: %s is absent\n", assets);
    skip();
}

/* Whoever fills a scene guarantees that every index is in range (scene.h). */
static void check_scene(const scene *s, const char *path)
{
    bool is_good = true;
    for (size_t i = 0; i < s->n_instances; i++) is_good = is_good && s->instances[i].mesh < s->n_meshes;
    for (size_t i = 0; i < s->n_spheres; i++)
        is_good = is_good && s->spheres[i].material < s->n_materials && s->spheres[i].radius > 0;
    for (size_t i = 0; i < s->n_meshes; i++) {
        const mesh *const m = &s->meshes[i];
        is_good = is_good && m->material < s->n_materials && m->n_triangles > 0;
        for (size_t k = 0; k < 3*m->n_triangles; k++) is_good = is_good && m->triangles[k/3][k%3] < m->n_vertices;
        for (size_t k = 0; m->normals && k < m->n_vertices; k++) {
            const float *const n = m->normals[k];
            /* unit up to the rounding of three components to float: 3 * 2^-24, doubled by the square */
            const float length = n[0]*n[0] + n[1]*n[1] + n[2]*n[2];
            is_good = is_good && length > 1 - 4e-7f && length < 1 + 4e-7f;
        }
    }
    for (size_t i = 0; i < s->n_textures; i++) is_good = is_good && s->textures[i].image < s->n_images;
    if (!is_good) fail_msg("%s: a scene with bad indices or normals", path);
}

static bool reads(const char *path, facet_error *why)
{
    scene *s = NULL;
    *why = (facet_error){0};
    if (gltf_read(path, NULL, NULL, &s, why)) {
        if (s || !why->text[0]) fail_msg("%s: refused without a reason, or with a result", path);
        return false;
    }
    check_scene(s, path);
    scene_destroy(s);
    return true;
}

static bool ends_with(const char *text, const char *end)
{
    const size_t n = strlen(text), m = strlen(end);
    return n >= m && strcmp(text + n - m, end) == 0;
}

/* Calls visit for each .gltf and .glb in the folder and below. */
static size_t walk(const char *folder, void (*visit)(const char *path))
{
    size_t n = 0;
    DIR *list = opendir(folder);
    if (!list) fail_msg("cannot open %s", folder);
    for (struct dirent *entry = readdir(list); entry; entry = readdir(list)) {
        char path[1024];
        struct stat info;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] == '.' || stat(path, &info) != 0) continue;
        if (S_ISDIR(info.st_mode)) {
            n += walk(path, visit);
        } else if (ends_with(path, ".gltf") || ends_with(path, ".glb")) {
            visit(path);
            n++;
        }
    }
    closedir(list);
    return n;
}

static void must_read(const char *path)
{
    facet_error why;
    const bool is_read = reads(path, &why);
    const char *const codec = strstr(path, "glTF-Draco") || strstr(path, "DracoSparse") ? "KHR_draco_mesh_compression"
                              : strstr(path, "BoxMeshopt")                              ? "EXT_meshopt_compression"
                                                                                        : NULL;
    if (!codec && !is_read) fail_msg("%s: %s: %s", path, why.place, why.text);
    if (codec && (is_read || why.status != FACET_UNSUPPORTED || !strstr(why.text, codec)))
        fail_msg("%s: not refused by the name of its codec, but: %s", path, why.text);
}

static void every_model_and_scene_is_read(void **state)
{
    (void)state;
    char folder[sizeof assets + 16];
    need_assets();
    snprintf(folder, sizeof folder, "%s/models", assets);
    assert_int_equal(walk(folder, must_read), 53);
    snprintf(folder, sizeof folder, "%s/scenes", assets);
    assert_int_equal(walk(folder, must_read), 25);
}

static void may_refuse(const char *path)
{
    facet_error why;
    (void)reads(path, &why);
}

static void damaged_collections_end_in_a_scene_or_a_reason(void **state)
{
    (void)state;
    static const char *const names[] = {"assimp", "cgltf-fuzz", "tinygltf"};
    char folder[sizeof assets + 32];
    need_assets();
    for (size_t i = 0; i < sizeof names/sizeof *names; i++) {
        snprintf(folder, sizeof folder, "%s/badinput/%s", assets, names[i]);
        assert_true(walk(folder, may_refuse) > 0);
    }
}

/* Opens a table under badinput/ and skips its header line. */
static FILE *open_table(const char *name)
{
    char path[sizeof assets + 64], line[512];
    snprintf(path, sizeof path, "%s/badinput/%s", assets, name);
    FILE *table = fopen(path, "r");
    assert_non_null(table);
    assert_non_null(fgets(line, sizeof line, table));
    return table;
}

static void crafted_files_end_as_expected(void **state)
{
    (void)state;
    char line[512], name[256], expected[32], path[sizeof assets + 320];
    size_t n = 0;
    need_assets();
    FILE *table = open_table("crafted/expected.tsv");
    while (fgets(line, sizeof line, table)) {
        assert_int_equal(sscanf(line, "%255s %31s", name, expected), 2);
        if (!ends_with(name, ".gltf") && !ends_with(name, ".glb")) continue;
        snprintf(path, sizeof path, "%s/badinput/crafted/%s", assets, name);
        facet_error why;
        const bool is_read = reads(path, &why);
        if (strcmp(expected, "must_load") == 0 && !is_read) fail_msg("%s: %s: %s", name, why.place, why.text);
        if (strcmp(expected, "must_reject") == 0 && is_read) fail_msg("%s is read; %s", name, strchr(line, '\t'));
        n++;
    }
    fclose(table);
    assert_int_equal(n, 88);
}

/* Files without a validator error that are refused, each for a reason. */
static bool is_valid_but_refused(const char *name)
{
    return ends_with(name, "accessor/unknown_type.gltf") || /* a type that only an unknown extension could read */
           ends_with(name, "asset/min_version_valid.gltf"); /* asks for glTF 2.1 */
}

static void files_that_the_validator_passes_are_read(void **state)
{
    (void)state;
    char line[512], name[512], path[sizeof assets + 600];
    size_t n_valid = 0;
    need_assets();
    FILE *table = open_table("gltf-validator/expected.tsv");
    while (fgets(line, sizeof line, table)) {
        char *const tab = strchr(line, '\t');
        assert_non_null(tab);
        *tab = 0;
        snprintf(name, sizeof name, "%s", line);
        snprintf(path, sizeof path, "%s/badinput/%s", assets, name);
        const int n_errors = atoi(tab + 1);
        facet_error why;
        const bool is_read = reads(path, &why);
        if (n_errors > 0) continue;
        n_valid++;
        if (is_read == is_valid_but_refused(name)) fail_msg("%s: %s: %s", name, why.place, why.text);
    }
    fclose(table);
    assert_int_equal(n_valid, 68);
}

static void no_file_took_more_than_two_gigabytes(void **state)
{
    (void)state;
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    assert_true(usage.ru_maxrss < 2l << 20); /* [KiB] */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crafted_files_end_as_expected),
        cmocka_unit_test(files_that_the_validator_passes_are_read),
        cmocka_unit_test(damaged_collections_end_in_a_scene_or_a_reason),
        cmocka_unit_test(every_model_and_scene_is_read),
        cmocka_unit_test(no_file_took_more_than_two_gigabytes),
    };
    return cmocka_run_group_tests_name("glTF collections", tests, NULL, NULL);
}
