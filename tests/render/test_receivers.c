/* test_receivers.c: how surfaces say which lights they take up (light_receiver.h): what pictures show only by their
 * noise.
 * SPDX-License-Identifier: MIT */
#include "render/light_receiver.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "render/stages.h"

static vertex_list *v; /* of one vertex */

static int set_up(void **state)
{
    (void)state;
    v = aligned_alloc(64, (sizeof *v + 63)/64*64);
    return v ? 0 : 1;
}

static int tear_down(void **state)
{
    (void)state;
    free(v);
    return 0;
}

/* The receiver of a material that is seen from wo, in a frame whose axes are world's y, z, x. */
static light_receiver receiver_of(const char *spec, real3 wo, bool transmits)
{
    facet_material described;
    facet_bsdf bsdf;
    facet_error why = {0};
    if (facet_material_parse(spec, &described, &why) || facet_bsdf_prepare(&described, &bsdf, &why))
        fail_msg("%s: %s", spec, why.text);
    *v = (vertex_list){.n = 1};
    v->t.y[0] = v->b.z[0] = v->up.x[0] = 1;
    v->transmits[0] = transmits ? UINT32_MAX : 0;
    set3(&v->position, 0, make3(1, 2, 3));
    set3(&v->wo, 0, wo);
    const render_loops *loops = render_loops_chosen();
    void (*const steps[2])(vertex_list *) = {loops->look_aside, loops->look_at_mirror};
    for (int i = 0; i < 2; i++) {
        steps[i](v);
        const float wi[3] = {v->wi.x[0], v->wi.y[0], v->wi.z[0]}, from[3] = {wo.x, wo.y, wo.z};
        v->pdf[0] = facet_bsdf_pdf(&bsdf, wi, from);
    }
    loops->receive(v);
    return receiver_at(receivers_of(&v->position, &v->receiver), 0);
}

static real3 seen_at(double degrees)
{
    const double theta = degrees*(double)PI/180;
    return make3((float)sin(theta), 0, (float)cos(theta));
}

static void assert_direction(real3 a, real3 b)
{
    assert_true(length3(sub3(a, b)) < 1e-6f);
}

static void a_matte_surface_takes_light_up_by_the_cosine(void **state)
{
    (void)state;
    for (int i = 0; i < 5; i++) {
        const light_receiver to = receiver_of("lambert kd=.5", seen_at(20*i), false);
        assert_direction(to.position, make3(1, 2, 3));
        assert_direction(to.normal, make3(1, 0, 0));
        assert_true(fabsf(to.broad*PI - 1) < 1e-5f);
        assert_true(to.peak < 1e-5f);
    }
}

/* A lobe of width alpha^2, less than a third wider by masking and by what lies beside the mirror image; next to nothing
 * is taken up elsewhere. */
static void a_mirror_takes_up_what_it_mirrors(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        float alpha;
    } metals[] = {{"ggx alpha=.01 ks=.9", .01f},
                  {"ggx alpha=.1 ks=.9", .1f},
                  {"beckmann alpha=.1 ks=.9", .1f},
                  {"metallic_roughness roughness=.3 metallic=1", .09f}};
    for (size_t m = 0; m < sizeof metals/sizeof *metals; m++)
        for (int i = 0; i < 4; i++) {
            const real3 wo = seen_at(20*i);
            const light_receiver to = receiver_of(metals[m].spec, wo, false);
            /* wo's mirror image (-x, 0, z) in the frame */
            assert_direction(to.mirror, make3(wo.z, -wo.x, 0));
            const float ratio = to.width/(metals[m].alpha*metals[m].alpha);
            if (!(ratio > 0.8f && ratio < 1.3f)) fail_msg("%s, %d: width %g", metals[m].spec, 20*i, (double)to.width);
            assert_true(to.broad < 0.1f*to.peak);
        }
}

static void what_is_both_has_both(void **state)
{
    (void)state;
    const light_receiver to = receiver_of("ggx alpha=.1 ior=1.5 kd=.5", seen_at(30), false);
    assert_true(to.broad > 0.1f && to.broad < INV_PI);
    assert_true(to.peak > to.broad);
    assert_true(to.width < 0.05f);
}

static void glass_takes_light_up_from_all_around(void **state)
{
    (void)state;
    const light_receiver to = receiver_of("glass alpha=.2", seen_at(30), true),
                         anywhere = receiver_anywhere(to.position);
    assert_direction(to.normal, splat3(0));
    assert_direction(to.mirror, splat3(0));
    assert_true(to.around == anywhere.around && to.broad == anywhere.broad && to.peak == anywhere.peak);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_matte_surface_takes_light_up_by_the_cosine),
        cmocka_unit_test(a_mirror_takes_up_what_it_mirrors),
        cmocka_unit_test(what_is_both_has_both),
        cmocka_unit_test(glass_takes_light_up_from_all_around),
    };
    return cmocka_run_group_tests_name("receivers", tests, set_up, tear_down);
}
