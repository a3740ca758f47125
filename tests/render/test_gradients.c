/* test_gradients.c: pixels that compare their light have the mean that they have alone, and a fraction of the noise.
 *
 * Pixels of a tile err together there, so that the spread of pixels does not tell how far: everything is rendered with
 * SEEDS seeds, and an error is that of the mean of so many independent numbers, which follows Student's distribution.
 * Bounds are such that a whole test exceeds them by chance once in a hundred choices of seeds (the seeds are fixed).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/scene_builder.h"
#include "verify/chi_square.h"
#include "verify/quadrature.h"

enum { SEEDS = 16, WIDTH = 48, HEIGHT = 40, SIDE = 8, N_BLOCKS = WIDTH/SIDE*(HEIGHT/SIDE) };

static const double pi = 3.14159265358979323846;
static const float origin[3] = {0, 0, 0};

/* ---- Statistics ---------------------------------------------------------------------------------------------- */

/* P(|T| > t) for Student's T: with t = sqrt(degrees) tan(a), the density is that of cos^(degrees - 1) a. */
static double student_tail(double t, int degrees)
{
    const double middle = atan(t/sqrt(degrees));
    const quadrature inner = gauss_legendre(64, 0, middle), outer = gauss_legendre(64, middle, pi/2);
    double inside = 0, outside = 0;
    for (int i = 0; i < 64; i++) {
        inside += inner.w[i]*pow(cos(inner.x[i]), degrees - 1);
        outside += outer.w[i]*pow(cos(outer.x[i]), degrees - 1);
    }
    return outside/(inside + outside);
}

/* What one of n comparisons may deviate, in standard errors: of SEEDS numbers, or of two times as many, where the error
 * has as many degrees of freedom at least. */
static double student_bound(int n)
{
    const double level = sidak_level(0.01, n);
    double low = 0, high = 100;
    for (int i = 0; i < 50; i++) {
        const double middle = (low + high)/2;
        *(student_tail(middle, SEEDS - 1) > level ? &low : &high) = middle;
    }
    return high;
}

static estimate estimate_of(const double values[SEEDS])
{
    estimate e = {0, 0};
    for (int k = 0; k < SEEDS; k++) e.mean += values[k]/SEEDS;
    for (int k = 0; k < SEEDS; k++) e.error += (values[k] - e.mean)*(values[k] - e.mean);
    e.error = sqrt(e.error/(SEEDS*(SEEDS - 1)));
    return e;
}

/* ---- Pictures ------------------------------------------------------------------------------------------------ */

static double mean_of(const image *picture, size_t x0, size_t y0, size_t width, size_t height)
{
    const float *pixels = picture->pixels;
    double sum = 0;
    for (size_t y = y0; y < y0 + height; y++)
        for (size_t x = x0; x < x0 + width; x++)
            for (size_t k = 0; k < 3; k++) sum += (double)pixels[3*(y*picture->width + x) + k];
    return sum/(double)(3*width*height);
}

static bool are_same(const scene *s, const render_settings *a, const render_settings *b)
{
    image one = render_picture(s, a), other = render_picture(s, b);
    const bool is_same = memcmp(one.pixels, other.pixels, 3*sizeof(float)*one.width*one.height) == 0;
    image_destroy(&one);
    image_destroy(&other);
    return is_same;
}

/* ---- Known radiances ----------------------------------------------------------------------------------------- */

enum { N_TRUTHS = 5 };

/* What single precision may cost, of the truth. */
static const double rounding = 2e-5;

/* Pictures are of 33 x 33 pixels: one row and one column of tiles have a single pixel across.  slack: how far the truth
 * is known, of itself. */
static void expect_truth(const char *what, const scene *s, uint32_t spp, sampler_kind kind, double truth, double slack)
{
    double means[SEEDS];
    render_settings r = random_settings(33, 33, spp);
    r.gradients = GRADIENTS_ON;
    r.sampler = kind;
    r.depth = 1000;
    for (uint32_t k = 0; k < SEEDS; k++) {
        r.seed = 100 + k;
        image picture = render_picture(s, &r);
        means[k] = mean_of(&picture, 0, 0, r.width, r.height);
        image_destroy(&picture);
    }
    const estimate e = estimate_of(means);
    print_message("  %-28s %-6s %.6g +- %.2g, truth %.6g\n", what, kind == SAMPLER_SOBOL ? "sobol" : "random", e.mean,
                  e.error, truth);
    assert_true(fabs(e.mean - truth) <= student_bound(N_TRUTHS)*e.error + slack*truth);
    assert_true(e.error <= 0.00125*truth*sqrt(SAMPLE_DIVISOR)); /* so that half a percent would be found */
}

/* A closed sphere of albedo a that emits 1 has the radiance 1/(1 - a). */
static scene *glowing_sphere(const char *spec)
{
    scene *s = build_scene();
    build_sphere(s, build_material(s, spec, 1, true), 0, 0, 0, 1);
    return s;
}

static void a_glowing_sphere_has_its_series_of_reflections(void **state)
{
    (void)state;
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        scene *s = glowing_sphere("lambert kd=.2");
        build_camera(s, origin, (const float[3]){1, .3f, .2f}, 1);
        expect_truth("closed sphere", s, 16, kind, 1.25, rounding);
        scene_destroy(s);
    }
}

/* What reflects or refracts all light cannot be told from the rest there, and neither can its outline, though it hides
 * from one pixel what another has found. */
static void white_things_in_a_glowing_sphere_are_not_seen(void **state)
{
    (void)state;
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        scene *s = glowing_sphere("lambert kd=.5");
        const size_t white = build_material(s, "lambert kd=1", 0, true);
        build_sphere(s, white, .2f, -.1f, 0, .15f);
        build_sphere(s, build_material(s, "glass ior=1.5", 0, false), -.15f, .2f, .1f, .12f);
        build_instance(s, build_box(s, white, (const float[3]){-.4f, -.5f, -.4f}, (const float[3]){-.1f, -.2f, 0}),
                       NULL);
        build_camera(s, (const float[3]){0, 0, .8f}, origin, 1);
        expect_truth("white things", s, 32, kind, 2, rounding);
        scene_destroy(s);
    }
}

/* Case B of test_analytic_truths.c: a tenth of a closed sphere is a black lamp.  A quarter of the facets keep it
 * true to four times 2e-4.  (In A and C all light is direct.) */
static void a_lamp_in_a_closed_sphere_lights_it_evenly(void **state)
{
    (void)state;
    scene *s = build_scene();
    build_instance(s, build_zone(s, build_material(s, "lambert kd=.7", 0, false), .8f, -1, 90, 200, true), NULL);
    build_instance(s, build_zone(s, build_material(s, "lambert kd=0", 1, false), 1, .8f, 10, 200, true), NULL);
    build_camera(s, origin, (const float[3]){.3f, -1, .2f}, .8f);
    expect_truth("lamp in a sphere", s, 32, SAMPLER_SOBOL, .7*.1/(1 - .7*.9), 8e-4);
    scene_destroy(s);
}

/* ---- A room -------------------------------------------------------------------------------------------------- */

/* 2 x 2 x 2, open in front, with a lamp of .8 x .8 under the ceiling that is as bright as `lamp`. */
static scene *bare_room(float lamp)
{
    scene *s = build_scene();
    build_wall(s, "lambert kd=.7", (const float[3]){-1, 0, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
    build_wall(s, "lambert kd=.7", (const float[3]){-1, 2, -1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, 2});
    build_wall(s, "lambert kd=.7", (const float[3]){-1, 0, -1}, (const float[3]){2, 0, 0}, (const float[3]){0, 2, 0});
    build_wall(s, "lambert kd=.6,.1,.1", (const float[3]){-1, 0, 1}, (const float[3]){0, 0, -2},
               (const float[3]){0, 2, 0});
    build_wall(s, "lambert kd=.1,.6,.1", (const float[3]){1, 0, -1}, (const float[3]){0, 0, 2},
               (const float[3]){0, 2, 0});
    build_quad(s, build_material(s, "lambert kd=.5", lamp, false), (const float[3]){-.4f, 1.9f, -.4f},
               (const float[3]){.8f, 0, 0}, (const float[3]){0, 0, .8f});
    return s;
}

/* A ball of 128 triangles whose normals are a sphere's. */
static void add_smooth_ball(scene *s, size_t mat, float x, float y, float z, float radius)
{
    const size_t index = build_zone(s, mat, 1, -1, 8, 8, false);
    mesh *m = &s->meshes[index];
    m->normals = malloc(m->n_vertices*sizeof *m->normals);
    assert_non_null(m->normals);
    memcpy(m->normals, m->positions, m->n_vertices*sizeof *m->normals); /* of the unit sphere */
    build_instance(s, index, (const float[3][4]){{radius, 0, 0, x}, {0, radius, 0, y}, {0, 0, radius, z}});
}

/* A room with a bit of all, and a sky before it. */
static scene *full_room(alpha_mode alpha)
{
    scene *s = bare_room(4);
    build_sphere(s, build_material(s, "glass ior=1.5", 0, false), -.45f, .35f, -.1f, .35f);
    build_sphere(s, build_material(s, "ggx alpha=.15 ks=.9,.7,.4", 0, false), .5f, .3f, -.4f, .3f);
    add_smooth_ball(s, build_material(s, "lambert kd=.8", 0, false), .15f, 1, -.3f, .3f);
    add_smooth_ball(s, build_material(s, "ggx alpha=.3 ks=.3 kd=.4", 0, false), -.5f, 1.3f, -.4f, .25f);
    build_sphere(s, build_material(s, "lambert kd=.3", .8f, true), 0, .15f, .5f, .15f);
    build_sphere(s, build_gltf_material(s, .6f, 1, .5f), .55f, .8f, -.5f, .2f);
    build_veil(s, alpha, -.8f, .5f);
    build_camera(s, (const float[3]){0, 1, 4.2f}, (const float[3]){0, .95f, 0}, .55f);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .7f;
    return s;
}

/* ---- The same mean ------------------------------------------------------------------------------------------- */

/* Of blocks, and of the whole picture as the last. */
typedef struct block_means {
    estimate at[N_BLOCKS + 1];
} block_means;

static block_means measure_blocks(const scene *s, render_settings r)
{
    static double values[N_BLOCKS + 1][SEEDS];
    for (uint32_t k = 0; k < SEEDS; k++) {
        image picture = render_picture(s, &r);
        for (size_t i = 0; i < N_BLOCKS; i++)
            values[i][k] = mean_of(&picture, i%(WIDTH/SIDE)*SIDE, i/(WIDTH/SIDE)*SIDE, SIDE, SIDE);
        values[N_BLOCKS][k] = mean_of(&picture, 0, 0, WIDTH, HEIGHT);
        image_destroy(&picture);
        r.seed++;
    }
    block_means b;
    for (size_t i = 0; i <= N_BLOCKS; i++) b.at[i] = estimate_of(values[i]);
    return b;
}

/* The largest deviation in standard errors. */
static double worst_of(const char *what, const block_means *a, const block_means *b)
{
    double worst = 0, sensitivity = 0;
    for (int i = 0; i <= N_BLOCKS; i++) {
        const double error = hypot(a->at[i].error, b->at[i].error);
        const double z = (a->at[i].mean - b->at[i].mean)/error;
        if (fabs(z) > fabs(worst)) worst = z;
        if (i < N_BLOCKS) sensitivity += error/b->at[i].mean/N_BLOCKS;
    }
    const estimate *all_a = &a->at[N_BLOCKS], *all_b = &b->at[N_BLOCKS];
    print_message("  %-22s %.5f(%.0f) %.5f(%.0f), worst %+.2f sigma, a block's sigma %.2f %%\n", what, all_a->mean,
                  1e5*all_a->error, all_b->mean, 1e5*all_b->error, worst, 100*sensitivity);
    assert_true(sensitivity <= 0.015*sqrt(SAMPLE_DIVISOR));
    return fabs(worst);
}

/* Against pixels that are alone, for each strategy and sampler.  The comparison finds what paths of five events lack of
 * those of six: 1.1 % of the light.  (With few samples: what those of two lack.) */
static void the_light_of_a_room_stays_where_it_is(void **state)
{
    (void)state;
    scene *s = full_room(ALPHA_MASK);
    const double bound = student_bound(4*(N_BLOCKS + 1));
    render_settings r = random_settings(WIDTH, HEIGHT, 32);
    r.depth = 6;
    r.seed = 1000;
    const block_means alone = measure_blocks(s, r);
    r.gradients = GRADIENTS_ON;
    for (strategy how = STRATEGY_MIS; how <= STRATEGY_IMPLICIT; how++) {
        static const char *const names[] = {"mis", "explicit", "implicit"};
        r.strategy = how;
        r.seed += SEEDS;
        const block_means compared = measure_blocks(s, r);
        assert_true(worst_of(names[how], &compared, &alone) <= bound);
    }
    r.strategy = STRATEGY_MIS;
    r.sampler = SAMPLER_SOBOL;
    r.seed += SEEDS;
    const block_means by_sobol = measure_blocks(s, r);
    assert_true(worst_of("sobol", &by_sobol, &alone) <= bound);
    r.depth = SAMPLE_DIVISOR > 1 ? 2 : 5;
    const block_means less = measure_blocks(s, r);
    assert_true(worst_of("fewer events", &less, &alone) > bound);
    scene_destroy(s);
}

/* A floor from above, white, between a white wall and a black one that a lamp stands between, and behind the black one:
 * there is no light.  What pixels pass on stays in the picture, so that a mistake is seen where it falls: by rows. */
static scene *floor_by_walls(void)
{
    scene *s = build_scene();
    build_wall(s, "lambert kd=.9", (const float[3]){-1, 0, 9}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -18});
    build_wall(s, "lambert kd=.9", (const float[3]){-1, 0, 9}, (const float[3]){0, 0, -18}, (const float[3]){0, 1, 0});
    build_wall(s, "lambert kd=0", (const float[3]){0, 0, 9}, (const float[3]){0, 0, -18}, (const float[3]){0, 1, 0});
    const punctual_light lamp = {.kind = LIGHT_POINT, .position = {-.5f, .6f, 0}, .intensity = {1, 1, 1}};
    assert_int_equal(scene_add_light(s, &lamp, NULL), FACET_OK);
    build_orthographic(s, (const float[3]){0, 4, 0}, origin, 1); /* upwards in the picture: x from -1 to 1 */
    return s;
}

static void measure_rows(const scene *s, render_settings r, estimate rows[HEIGHT])
{
    static double values[HEIGHT][SEEDS];
    for (uint32_t k = 0; k < SEEDS; k++) {
        image picture = render_picture(s, &r);
        for (size_t y = 0; y < HEIGHT; y++) values[y][k] = mean_of(&picture, 0, y, WIDTH, 1);
        image_destroy(&picture);
        r.seed++;
    }
    for (size_t y = 0; y < HEIGHT; y++) rows[y] = estimate_of(values[y]);
}

/* A screen from before, the lower half of which a glossy strip on the floor throws the sun's light at. */
static scene *screen_by_a_glossy_strip(void)
{
    scene *s = build_scene();
    build_wall(s, "lambert kd=.9", (const float[3]){-9, 0, 0}, (const float[3]){18, 0, 0}, (const float[3]){0, 1, 0});
    build_wall(s, "ggx alpha=.1 ks=.9", (const float[3]){-9, 0, .6f}, (const float[3]){18, 0, 0},
               (const float[3]){0, 0, -.4f});
    const punctual_light sun = {
        .kind = LIGHT_DIRECTIONAL, .direction = {0, -sqrtf(.5f), -sqrtf(.5f)}, .intensity = {1, 1, 1}};
    assert_int_equal(scene_add_light(s, &sun, NULL), FACET_OK);
    build_orthographic(s, (const float[3]){0, .5f, 4}, (const float[3]){0, .5f, 0}, 1);
    return s;
}

/* A rectangle that shines, in cuts x cuts pieces of which each is a mesh. */
static void build_lamp(scene *s, float emission, const float corner[3], float width, float depth, int cuts)
{
    const size_t glow = build_material(s, "lambert kd=0", emission, false);
    const float u = width/(float)cuts, v = depth/(float)cuts;
    for (int i = 0; i < cuts*cuts; i++) {
        const float piece[3] = {corner[0] + u*(float)(i%cuts), corner[1], corner[2] + v*(float)(i/cuts)};
        build_quad(s, glow, piece, (const float[3]){u, 0, 0}, (const float[3]){0, 0, v});
    }
}

/* A floor from below a lamp, half of which a screen hides from its left; on the right there is another lamp, which is
 * hidden from all, but is chosen more often the nearer it is. */
static scene *floor_by_lamps(const char *spec, int cuts)
{
    scene *s = build_scene();
    const size_t black = build_material(s, "lambert kd=0", 0, true);
    build_wall(s, spec, (const float[3]){-1, 0, 9}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -18});
    build_lamp(s, 1, (const float[3]){-.9f, .8f, -.5f}, .8f, 1, cuts);
    build_lamp(s, 30, (const float[3]){.7f, .6f, -.2f}, .2f, .4f, cuts);
    build_instance(s, build_box(s, black, (const float[3]){.65f, .5f, -.3f}, (const float[3]){.95f, .7f, .3f}), NULL);
    build_quad(s, black, (const float[3]){-.3f, .3f, -9}, (const float[3]){0, .4f, 0}, (const float[3]){0, 0, 18});
    build_orthographic(s, (const float[3]){0, .25f, 0}, origin, 1);
    return s;
}

/* A floor with a wall on it, under a sky of which one quarter is bright, and a lamp, so that the sky gets a part of the
 * numbers that choose. */
static scene *floor_under_a_sky(void)
{
    enum { W = 16, H = 8 };
    static float texels[3*W*H];
    for (size_t i = 0; i < (size_t)W*H; i++)
        for (size_t k = 0; k < 3; k++) texels[3*i + k] = i%W < W/4 ? 1 : 0.05f;
    scene *s = build_scene();
    build_wall(s, "lambert kd=.9", (const float[3]){-1, 0, 9}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -18});
    build_quad(s, build_material(s, "lambert kd=0", 0, true), (const float[3]){0, 0, -9}, (const float[3]){0, .4f, 0},
               (const float[3]){0, 0, 18});
    build_quad(s, build_material(s, "lambert kd=0", 1, false), (const float[3]){-.9f, .8f, -.5f},
               (const float[3]){.8f, 0, 0}, (const float[3]){0, 0, 1});
    build_sky(s, W, H, texels);
    build_orthographic(s, (const float[3]){0, .5f, 0}, origin, 1);
    return s;
}

/* precision: the largest error of a row, of the brightest. */
static void compare_rows(scene *s, uint32_t spp, uint32_t depth, double precision)
{
    estimate alone[HEIGHT], compared[HEIGHT];
    render_settings r = random_settings(WIDTH, HEIGHT, spp);
    r.depth = depth;
    measure_rows(s, r, alone);
    r.gradients = GRADIENTS_ON;
    r.seed += SEEDS;
    measure_rows(s, r, compared);
    scene_destroy(s);
    double worst = 0, most = 0, brightest = 0;
    for (size_t y = 0; y < HEIGHT; y++) {
        const double error = hypot(compared[y].error, alone[y].error), off = compared[y].mean - alone[y].mean;
        if (error > 0) worst = fmax(worst, fabs(off)/error);
        else assert_true(off == 0);
        most = fmax(most, error);
        brightest = fmax(brightest, alone[y].mean);
    }
    print_message("  rows up to %.3f, sigma %.2g, worst %.2f sigma\n", brightest, most, worst);
    assert_true(most <= precision*brightest*sqrt(SAMPLE_DIVISOR));
    assert_true(worst <= student_bound(5*HEIGHT));
}

static void light_stays_on_its_side_of_a_wall(void **state)
{
    (void)state;
    compare_rows(floor_by_walls(), 32, 8, 0.0065);
}

static void a_gloss_stays_where_it_falls(void **state)
{
    (void)state;
    compare_rows(screen_by_a_glossy_strip(), 256, 8, 0.0065);
}

static void lamps_shine_where_they_do(void **state)
{
    (void)state;
    compare_rows(floor_by_lamps("lambert kd=.9", 1), 256, 1, 0.0075);
    compare_rows(floor_by_lamps("ggx alpha=.3 ks=.9", 1), 256, 1, 0.0075);
    compare_rows(floor_by_lamps("lambert kd=.9", 12), 256, 1, 0.0075); /* 576 triangles: by a tree */
    compare_rows(floor_by_lamps("ggx alpha=.3 ks=.9", 12), 256, 1, 0.0075);
    compare_rows(floor_under_a_sky(), 256, 1, 0.0075);
}

/* ---- Less noise ---------------------------------------------------------------------------------------------- */

/* Root mean square of the difference of two pictures. */
static double noise_of(const scene *s, render_settings r)
{
    image a = render_picture(s, &r);
    r.seed++;
    image b = render_picture(s, &r);
    double sum = 0;
    for (size_t i = 0; i < 3*r.width*r.height; i++) {
        const double d = (double)((const float *)a.pixels)[i] - (double)((const float *)b.pixels)[i];
        sum += d*d;
    }
    image_destroy(&a);
    image_destroy(&b);
    return sqrt(sum/(double)(3*r.width*r.height));
}

/* Their light comes from the lamp by way of other walls, too: that is compared.  (The lamp itself is not seen: nothing
 * takes the noise from its edges.) */
static void walls_are_far_less_noisy(void **state)
{
    (void)state;
    scene *s = bare_room(4);
    build_camera(s, (const float[3]){0, 1, 1}, (const float[3]){0, .4f, -1}, .8f);
    for (sampler_kind kind = SAMPLER_SOBOL; kind <= SAMPLER_RANDOM; kind++) {
        render_settings r = random_settings(64, 64, 64);
        r.sampler = kind;
        const double alone = noise_of(s, r);
        r.gradients = GRADIENTS_ON;
        const double compared = noise_of(s, r);
        print_message("  %s: %.3g alone, %.3g compared\n", kind == SAMPLER_SOBOL ? "sobol" : "random", alone, compared);
        assert_true(compared < 0.5*alone);
    }
    scene_destroy(s);
}

/* ---- Where there is nothing to compare ----------------------------------------------------------------------- */

/* Half-transparent surfaces meet one ray and let the next one through; light that is seen directly is nobody else's. */
static void without_gradients_pictures_have_the_same_bits(void **state)
{
    (void)state;
    static const struct {
        alpha_mode alpha;
        uint32_t depth;
        bool is_same;
    } cases[] = {{ALPHA_BLEND, 6, true}, {ALPHA_MASK, 0, true}, {ALPHA_MASK, 1, false}, {ALPHA_MASK, 2, false}};
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        scene *s = full_room(cases[i].alpha);
        render_settings alone = random_settings(WIDTH, HEIGHT, 16);
        alone.depth = cases[i].depth;
        render_settings compared = alone;
        compared.gradients = GRADIENTS_ON;
        assert_int_equal(are_same(s, &alone, &compared), cases[i].is_same);
        scene_destroy(s);
    }
}

/* ---- Where it pays ------------------------------------------------------------------------------------------- */

/* Each thread, rank, shard and crop decides alike. */
static void light_is_shared_where_it_pays(void **state)
{
    (void)state;
    scene *walls = bare_room(4), *plane = build_scene();
    build_camera(walls, (const float[3]){0, 1, 1}, (const float[3]){0, .4f, -1}, .8f);
    build_quad(plane, build_material(plane, "lambert kd=.7", 0, false), (const float[3]){-1, 0, 1},
               (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
    const punctual_light lamp = {
        .kind = LIGHT_POINT, .position = {0, 2, 0}, .intensity = {1, 1, 1}}; /* without noise */
    assert_int_equal(scene_add_light(plane, &lamp, NULL), FACET_OK);
    build_camera(plane, (const float[3]){0, 1, 1}, (const float[3]){0, 0, 0}, .8f);
    static const struct {
        size_t width, height, crop_w;
        uint32_t n_threads, shard;
    } cases[] = {{140, 100, 0, 1, 0}, {140, 100, 0, 3, 0}, {140, 100, 20, 1, 2}, {20, 20, 0, 2, 0}};
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++) {
        render_settings r = random_settings(cases[i].width, cases[i].height, 2*SAMPLE_DIVISOR), on, off;
        r.crop_w = r.crop_h = cases[i].crop_w;
        r.n_threads = cases[i].n_threads;
        r.shard = r.n_shards = cases[i].shard;
        on = off = r;
        r.gradients = GRADIENTS_AUTO;
        on.gradients = GRADIENTS_ON;
        assert_true(are_same(walls, &r, &on));
        assert_false(are_same(walls, &r, &off));
        assert_true(are_same(plane, &r, &off));
    }
    scene_destroy(plane);
    scene_destroy(walls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_glowing_sphere_has_its_series_of_reflections),
        cmocka_unit_test(white_things_in_a_glowing_sphere_are_not_seen),
        cmocka_unit_test(a_lamp_in_a_closed_sphere_lights_it_evenly),
        cmocka_unit_test(the_light_of_a_room_stays_where_it_is),
        cmocka_unit_test(light_stays_on_its_side_of_a_wall),
        cmocka_unit_test(a_gloss_stays_where_it_falls),
        cmocka_unit_test(lamps_shine_where_they_do),
        cmocka_unit_test(walls_are_far_less_noisy),
        cmocka_unit_test(without_gradients_pictures_have_the_same_bits),
        cmocka_unit_test(light_is_shared_where_it_pays),
    };
    return cmocka_run_group_tests_name("gradients", tests, NULL, NULL);
}
