/* test_assets.c: every model and scene of ../shared/assets that the reader takes renders without a bad sample.
 * SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "io/gltf.h"
#include "tests/scene_builder.h"

static const char folder[] = FACET_SOURCE_DIR "/../shared/assets/";

typedef struct tally {
    int n_rendered, n_refused, n_dark;
} tally;

/* The sum of a small picture's values, which must be finite and, of pixels that share no light, not negative. */
static double render_small(const char *path, const scene *s, bool has_gradients)
{
    render_settings r;
    render_settings_defaults(&r);
    r.width = 32;
    r.height = 24;
    r.spp = 2;
    r.n_threads = 2;
    r.gradients = has_gradients ? GRADIENTS_ON : GRADIENTS_OFF;
    render_result result = {0};
    facet_error why = {0};
    if (render(s, &r, &result, &why)) fail_msg("%s: %s: %s", path, why.place, why.text);
    double sum = 0;
    for (size_t i = 0; i < 3*r.width*r.height; i++) {
        const float value = ((const float *)result.picture.pixels)[i];
        if (!((has_gradients || value >= 0) && isfinite(value)))
            fail_msg("%s: pixel %zu is %g", path, i/3, (double)value);
        sum += (double)value;
    }
    if (result.n_bad) fail_msg("%s: %llu bad samples", path, (unsigned long long)result.n_bad);
    render_result_destroy(&result);
    return sum;
}

static void render_file(const char *path, tally *t)
{
    scene *s = NULL;
    facet_error why = {0};
    if (gltf_read(path, NULL, NULL, &s, &why)) {
        /* Refused for a reason that is told: something required that is not supported. */
        assert_true(why.status == FACET_UNSUPPORTED || why.status == FACET_BAD_FILE);
        assert_true(strlen(why.text) > 0);
        print_message("  refused: %s: %s\n", strrchr(path, '/') + 1, why.text);
        t->n_refused++;
        return;
    }
    if (s->n_cameras == 0) assert_int_equal(scene_add_framing_camera(s, NULL), FACET_OK);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    const double light = render_small(path, s, false);
    render_small(path, s, true);
    t->n_dark += !(light > 0);
    t->n_rendered++;
    scene_destroy(s);
}

static int is_name(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static bool ends_in(const char *name, const char *end)
{
    const size_t n = strlen(name), m = strlen(end);
    return n > m && strcmp(name + n - m, end) == 0;
}

/* In the order of the names, so that failures repeat. */
static void walk(const char *path, tally *t)
{
    struct dirent **entries;
    const int n = scandir(path, &entries, is_name, alphasort);
    for (int i = 0; i < n; i++) {
        char below[1024];
        struct stat status;
        assert_true(snprintf(below, sizeof below, "%s/%s", path, entries[i]->d_name) < (int)sizeof below);
        if (stat(below, &status) == 0 && S_ISDIR(status.st_mode)) walk(below, t);
        if (ends_in(below, ".gltf") || ends_in(below, ".glb")) render_file(below, t);
        free(entries[i]);
    }
    if (n >= 0) free(entries);
}

static void walk_part(const char *part, int least_rendered)
{
    if (access(folder, R_OK) != 0) {
        print_message("  skipped: %s is not here\n", folder);
        skip();
    }
    char path[512];
    snprintf(path, sizeof path, "%s%s", folder, part);
    tally t = {0, 0, 0};
    walk(path, &t);
    print_message("  %s: %d rendered, %d refused\n", part, t.n_rendered, t.n_refused);
    assert_true(t.n_rendered >= least_rendered);
    assert_int_equal(t.n_dark, 0); /* the sky is white */
}

static void all_models_render_without_a_bad_sample(void **state)
{
    (void)state;
    walk_part("models", 40);
}

static void all_scenes_render_without_a_bad_sample(void **state)
{
    (void)state;
    walk_part("scenes", 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_models_render_without_a_bad_sample),
        cmocka_unit_test(all_scenes_render_without_a_bad_sample),
    };
    return cmocka_run_group_tests_name("assets", tests, NULL, NULL);
}
