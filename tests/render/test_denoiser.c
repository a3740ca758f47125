/* test_denoiser.c: what is handed to Open Image Denoise, by a library that stands in for it, and what it does to a
 * noisy picture, where FACET_OIDN names the real one.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/denoiser.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

static image some_picture(size_t width, size_t height, uint64_t seed)
{
    draws d = {seed};
    float *pixels = calloc(width*height, 3*sizeof *pixels);
    assert_non_null(pixels);
    for (size_t i = 0; i < 3*width*height; i++) pixels[i] = (float)draw(&d);
    return (image){.width = width, .height = height, .n_channels = 3, .type = PIXEL_F32, .pixels = pixels};
}

static void all_three_pictures_are_handed_over(void **state)
{
    (void)state;
    denoiser *d = NULL;
    facet_error why = {0};
    if (denoiser_load(FACET_FAKE_OIDN, &d, &why)) fail_msg("%s", why.text);
    assert_string_equal(denoiser_name(d), "Open Image Denoise 2.3.99");
    image picture = some_picture(17, 5, 1), albedo = some_picture(17, 5, 2), normal = some_picture(17, 5, 3), result;
    if (denoiser_run(d, &picture, &albedo, &normal, &result, &why)) fail_msg("%s", why.text);
    assert_true(result.width == 17 && result.height == 5 && result.n_channels == 3 && result.type == PIXEL_F32);
    for (size_t i = 0; i < (size_t)17*5*3; i++) {
        const float *c = picture.pixels, *a = albedo.pixels, *n = normal.pixels, *r = result.pixels;
        assert_true(r[i] == c[i] + 2*a[i] + 4*n[i]);
    }
    image_destroy(&result);
    image_destroy(&normal);
    image_destroy(&albedo);
    image_destroy(&picture);
    denoiser_destroy(d);
}

static void what_the_library_complains_of_is_an_error(void **state)
{
    (void)state;
    denoiser *d = NULL;
    facet_error why = {0};
    assert_int_equal(denoiser_load(FACET_FAKE_OIDN, &d, &why), FACET_OK);
    image picture = some_picture(13, 5, 1), result = {0};
    assert_int_equal(denoiser_run(d, &picture, &picture, &picture, &result, &why), FACET_UNSUPPORTED);
    assert_string_equal(why.text, "Open Image Denoise: thirteen");
    assert_null(result.pixels);
    image_destroy(&picture);
    denoiser_destroy(d);
    denoiser_destroy(NULL);
}

static void what_is_no_such_library_is_refused(void **state)
{
    (void)state;
    denoiser *d = NULL;
    facet_error why = {0};
    assert_int_equal(denoiser_load("/nowhere/libOpenImageDenoise.so.2", &d, &why), FACET_IO);
    assert_string_equal(why.text, "cannot be loaded: cannot open shared object file: No such file or directory");
    assert_int_equal(denoiser_load(FACET_SOURCE_DIR "/README.md", &d, &why), FACET_IO);
    assert_int_equal(denoiser_load("libm.so.6", &d, &why), FACET_BAD_FILE);
    assert_non_null(strstr(why.text, "is not Open Image Denoise"));
    assert_null(d);
}

/* Relative to the mean of a reference of many samples, in the mean over pixels. */
static double error_of(const image *picture, const image *reference)
{
    const float *p = picture->pixels, *q = reference->pixels;
    double error = 0, sum = 0;
    for (size_t i = 0; i < 3*picture->width*picture->height; i++) {
        error += fabs((double)(p[i] - q[i]));
        sum += (double)q[i];
    }
    return error/sum;
}

static void the_real_library_halves_the_error(void **state)
{
    (void)state;
    const char *path = getenv("FACET_OIDN");
    denoiser *d = NULL;
    facet_error why = {0};
    if (!path || !*path) {
        print_message("FACET_OIDN names no library: not tried\n");
        skip();
    }
    if (denoiser_load(path, &d, &why)) fail_msg("%s", why.text);
    scene *s = build_scene();
    build_quad(s, build_material(s, "lambert kd=.6", 0, false), (const float[3]){-2, 0, 2}, (const float[3]){4, 0, 0},
               (const float[3]){0, 0, -4});
    build_sphere(s, build_material(s, "ggx alpha=.3 ks=.8", 0, false), 0, .5f, 0, .5f);
    build_sphere(s, build_material(s, "lambert kd=0", 20, false), 1, 3.5f, .5f, 1); /* out of sight */
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .2f;
    build_camera(s, (const float[3]){0, 1, 4}, (const float[3]){0, .5f, 0}, .8f);
    render_settings r;
    render_settings_defaults(&r);
    r.width = 200;
    r.height = 100;
    r.spp = 4;
    r.keeps_features = true;
    render_state made = {0};
    render_result noisy = {0}, exact = {0};
    image albedo = {0}, normal = {0}, result = {0};
    assert_int_equal(render_continue(s, &r, &made, &noisy, NULL), FACET_OK);
    r.spp = 1024/SAMPLE_DIVISOR;
    r.seed = 1;
    assert_int_equal(render(s, &r, &exact, NULL), FACET_OK);
    assert_int_equal(film_develop_layer(&made.film, FILM_ALBEDO, &albedo), FACET_OK);
    assert_int_equal(film_develop_layer(&made.film, FILM_NORMAL, &normal), FACET_OK);
    if (denoiser_run(d, &noisy.picture, &albedo, &normal, &result, &why)) fail_msg("%s", why.text);
    const double before = error_of(&noisy.picture, &exact.picture), after = error_of(&result, &exact.picture);
    print_message("relative error %.4f, denoised %.4f\n", before, after);
    assert_true(after < before/2);
    image_destroy(&result);
    image_destroy(&normal);
    image_destroy(&albedo);
    render_result_destroy(&exact);
    render_result_destroy(&noisy);
    render_state_destroy(&made);
    scene_destroy(s);
    denoiser_destroy(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_three_pictures_are_handed_over),
        cmocka_unit_test(what_the_library_complains_of_is_an_error),
        cmocka_unit_test(what_is_no_such_library_is_refused),
        cmocka_unit_test(the_real_library_halves_the_error),
    };
    return cmocka_run_group_tests_name("denoiser", tests, NULL, NULL);
}
