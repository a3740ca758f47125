/* test_transmission.c: light that goes through rough surfaces, found by scattered rays and by light connections.
 *
 * Truths are integrals of the library's double precision, or walks of the test's own that know no scene.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"
#include "verify/quadrature.h"

static const double pi = 3.14159265358979323846;
static const float origin[3] = {0, 0, 0};
static const char *const strategy_names[] = {"mis", "explicit", "implicit"};

/* A square that faces up and a view of a spot in its middle, from above (side 1) or below (-1), at cosine .447. */
static void build_pane_and_view(scene *s, size_t mat, int side)
{
    build_quad(s, mat, (const float[3]){-1, 0, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
    build_orthographic(s, (const float[3]){4, 2.0f*(float)side, 0}, origin, 1e-4f);
}

/* The view's direction in a frame with the normal along z; the materials here are isotropic. */
static void view_direction(int side, double wo[3])
{
    wo[0] = 4/sqrt(20);
    wo[1] = 0;
    wo[2] = side*2/sqrt(20);
}

typedef struct view {
    const facet_bsdf64 *bsdf;
    double wo[3];
} view;

static double radiance_at(double cos_i, double phi, const void *context)
{
    const view *v = context;
    double wi[3], f[3];
    any_direction(cos_i, phi, wi);
    facet_bsdf64_eval(v->bsdf, wi, v->wo, f);
    return f[0];
}

static double under_a_sky_of_one(const char *spec, int side)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    view v = {.bsdf = &bsdf.twice};
    view_direction(side, v.wo);
    const double equator[2][2] = {{0, -pi}, {0, pi}};
    return cubature(radiance_at, &v, (double[2]){-1, -pi}, equator[1], 1e-6, 3) +
           cubature(radiance_at, &v, equator[0], (double[2]){1, pi}, 1e-6, 3);
}

/* One interface: the sky is seen by reflection, and through it, where radiance is divided by eta^2. */
static void a_pane_under_a_sky_shows_what_it_scatters(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        int side;
    } panes[] = {{"glass alpha=.36", 1}, {"glass alpha=.36", -1}, {"glass alpha=.5 wall=thin tint=.5", 1}};
    for (int i = 0; i < 3; i++) {
        const double truth = under_a_sky_of_one(panes[i].spec, panes[i].side);
        for (strategy how = STRATEGY_MIS; how <= STRATEGY_IMPLICIT; how++) {
            scene *s = build_scene();
            build_pane_and_view(s, build_material(s, panes[i].spec, 0, false), panes[i].side);
            for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
            render_settings r = random_settings(32, 32, 400);
            r.strategy = how;
            r.seed = 3;
            const estimate e = measure(s, &r);
            scene_destroy(s);
            print_message("  %-32s side %2d, %-8s %.5f +- %.5f, truth %.5f\n", panes[i].spec, panes[i].side,
                          strategy_names[how], e.mean, e.error, truth);
            /* Explicit connections alone seldom hit a lobe that is narrower than the sky. */
            assert_true(estimate_agrees(e, truth));
            assert_true(e.error <= (how == STRATEGY_EXPLICIT ? 0.015 : 0.002)*sqrt(SAMPLE_DIVISOR)*truth);
        }
    }
}

/* glTF's transmission takes the roughness of the material, and mixes: half of this one is glass of alpha .6^2, half a
 * white metallic_roughness. */
static void gltf_glass_is_as_rough_as_its_material(void **state)
{
    (void)state;
    const double truth = 0.5*under_a_sky_of_one("glass alpha=.36 tint=.8", 1) +
                         0.5*under_a_sky_of_one("metallic_roughness base_color=.8 roughness=.6", 1);
    scene *s = build_scene();
    const size_t mat = build_gltf_material(s, .8f, 0, .6f);
    s->materials[mat].transmission = .5f;
    build_pane_and_view(s, mat, 1);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    const render_settings r = random_settings(32, 32, 800);
    expect_estimate("glTF, transmission .5, roughness .6", measure(s, &r), truth);
    scene_destroy(s);
}

/* A point light on either side leaves nothing to chance: f cos_i I/d^2.  From below, light that is let in comes from
 * near the horizon. */
static void point_lights_shine_through_rough_panes(void **state)
{
    (void)state;
    for (int light_side = -1; light_side <= 1; light_side += 2)
        for (int view_side = -1; view_side <= 1; view_side += 2) {
            const any_bsdf bsdf = any_bsdf_of("glass alpha=.5", 1);
            const float height = view_side > 0 ? 4 : 1;
            const double distance2 = 9 + (double)(height*height), distance = sqrt(distance2);
            scene *s = build_scene();
            build_pane_and_view(s, build_material(s, "glass alpha=.5", 0, false), view_side);
            const punctual_light light = {
                .kind = LIGHT_POINT, .position = {-3, height*(float)light_side, 0}, .intensity = {10, 10, 10}};
            assert_int_equal(scene_add_light(s, &light, NULL), FACET_OK);
            const double wi[3] = {-3/distance, 0, (double)height*light_side/distance};
            double wo[3], f[3];
            view_direction(view_side, wo);
            facet_bsdf64_eval(&bsdf.twice, wi, wo, f);
            const double truth = f[0]*10/distance2;
            const render_settings r = random_settings(8, 8, 2);
            const double L = measure(s, &r).mean;
            if (!(fabs(L - truth) <= 1e-4*truth && truth > 0))
                fail_msg("light on side %d, view from %d: %.8g is not %.8g", light_side, view_side, L, truth);
            scene_destroy(s);
        }
}

/* A chord of a sphere meets it at the same cosine at both ends, so that a walk inside needs no positions.  Returns the
 * mean of what walks bring back from a sky of 1, for the cosines that a parallel view of a sphere shows. */
static estimate walk_through_a_sphere(const char *spec, int n)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    draws d = {77};
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        double W = 1, wo[3];
        any_direction(sqrt((i + draw(&d))/n), 0, wo);
        for (int event = 0; event < 200; event++) {
            const double u[3] = {draw(&d), draw(&d), draw(&d)};
            const facet_sample64 s = facet_bsdf64_sample(&bsdf.twice, wo, u);
            W *= s.weight[0];
            if (!(W > 0) || s.wi[2] > 0) break;
            any_direction(s.wi[2], 0, wo);
        }
        sum += W;
        squares += W*W;
    }
    const double mean = sum/n;
    return (estimate){mean, sqrt((squares/n - mean*mean)/n)};
}

static void a_rough_sphere_in_a_furnace_loses_what_is_masked(void **state)
{
    (void)state;
    static const char *const specs[] = {"glass alpha=.1", "glass alpha=.4 ior=1.33"};
    for (int i = 0; i < 2; i++) {
        const estimate walk = walk_through_a_sphere(specs[i], 400000/SAMPLE_DIVISOR);
        for (strategy how = STRATEGY_MIS; how <= STRATEGY_IMPLICIT; how++) {
            scene *s = build_scene();
            build_sphere(s, build_material(s, specs[i], 0, false), 0, 0, 0, 1);
            for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
            build_orthographic(s, (const float[3]){0, 3, 4}, origin, 1);
            render_settings r = random_settings(64, 64, 100);
            r.depth = 200;
            r.strategy = how;
            const estimate e = measure(s, &r);
            scene_destroy(s);
            const double truth = 1 - pi/4*(1 - walk.mean), error = hypot(e.error, pi/4*walk.error);
            print_message("  %-24s %-8s %.5f +- %.5f, walks %.5f +- %.5f\n", specs[i], strategy_names[how], e.mean,
                          e.error, truth, pi/4*walk.error);
            assert_true(fabs(e.mean - truth) <= 4*error + 2e-5);
            assert_true(error <= (how == STRATEGY_EXPLICIT ? 0.05 : 0.002)*sqrt(SAMPLE_DIVISOR));
            assert_true(walk.mean < 1);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pane_under_a_sky_shows_what_it_scatters),
        cmocka_unit_test(gltf_glass_is_as_rough_as_its_material),
        cmocka_unit_test(point_lights_shine_through_rough_panes),
        cmocka_unit_test(a_rough_sphere_in_a_furnace_loses_what_is_masked),
    };
    return cmocka_run_group_tests_name("transmission", tests, NULL, NULL);
}
