/* test_merl.c: MERL files made here, read back at directions whose angles are computed in another way.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "io/merl.h"
#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/run_program.h"

#define PI 3.14159265358979323846

static char *folder;

static int setup(void **state)
{
    (void)state;
    folder = make_folder();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    remove_folder(folder);
    return 0;
}

static void put_little_endian(FILE *file, uint64_t word, int n)
{
    for (int i = 0; i < n; i++) fputc((int)(word >> 8*i & 255), file);
}

/* What a made file holds at these indices, before the scale of a channel. */
static double linear(double i, double j, double k, int channel)
{
    (void)k;
    return 0.1*(channel + 1) + 0.01*i + 0.002*j;
}

static double wave(double i, double j, double k, int channel)
{
    (void)i;
    (void)j;
    return 1 + 0.5*cos(2*PI*k/180) + 0.1*channel;
}

static const char *make_file(const char *name, const int sizes[3], double (*value)(double, double, double, int))
{
    static const double scale[3] = {1500, 1500/1.15, 1500/1.66};
    const char *path = in_folder(folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    for (int k = 0; k < 3; k++) put_little_endian(file, (uint64_t)sizes[k], 4);
    for (int channel = 0; channel < 3; channel++)
        for (int i = 0; i < 90; i++)
            for (int j = 0; j < 90; j++)
                for (int k = 0; k < 180; k++) {
                    const double x = value(i, j, k, channel)*scale[channel];
                    uint64_t word;
                    memcpy(&word, &x, sizeof word);
                    put_little_endian(file, word, 8);
                }
    assert_int_equal(fclose(file), 0);
    return path;
}

static const int right_sizes[3] = {90, 90, 180};

/* The angles by turning the whole frame: h to the pole by -phi_h about z, then by -theta_h about y. */
static void angles_of(const double wi[3], const double wo[3], double *theta_h, double *theta_d, double *phi_d)
{
    const double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    const double length = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2]), phi_h = atan2(h[1], h[0]);
    *theta_h = acos(h[2]/length);
    const double x = wi[0]*cos(-phi_h) - wi[1]*sin(-phi_h), y = wi[0]*sin(-phi_h) + wi[1]*cos(-phi_h);
    const double turned[3] = {x*cos(-*theta_h) + wi[2]*sin(-*theta_h), y,
                              -x*sin(-*theta_h) + wi[2]*cos(-*theta_h)};
    *theta_d = acos(fmin(turned[2], 1));
    *phi_d = atan2(turned[1], turned[0]);
    if (*phi_d < 0) *phi_d += PI;
}

static void values_are_found_between_the_measured_angles(void **state)
{
    (void)state;
    merl by_angle, by_azimuth;
    facet_error why;
    assert_int_equal(merl_read(make_file("linear.binary", right_sizes, linear), &by_angle, &why), FACET_OK);
    assert_int_equal(merl_read(make_file("wave.binary", right_sizes, wave), &by_azimuth, &why), FACET_OK);
    draws random = {1};
    for (int i = 0; i < 20000; i++) {
        double wi[3], wo[3], f[3], g[3], reversed[3], theta_h, theta_d, phi_d;
        any_direction(draw_between(&random, .05, 1), draw_between(&random, 0, 2*PI), wi);
        any_direction(draw_between(&random, .05, 1), draw_between(&random, 0, 2*PI), wo);
        angles_of(wi, wo, &theta_h, &theta_d, &phi_d);
        /* The last measured half angle and difference angle are held beyond. */
        const double at_h = fmin(90*sqrt(theta_h/(PI/2)), 89), at_d = fmin(theta_d*180/PI, 89),
                     at_p = phi_d*180/PI;
        merl_eval(&by_angle, wi, wo, f);
        merl_eval(&by_azimuth, wi, wo, g);
        merl_eval(&by_angle, wo, wi, reversed);
        for (int k = 0; k < 3; k++) {
            /* acos loses half of the digits near 0 */
            assert_true(fabs(f[k]/wi[2] - linear(at_h, at_d, 0, k)) < 1e-5);
            assert_true(fabs(f[k]/wi[2] - reversed[k]/wo[2]) < 1e-12);
            /* half a step of 1 degree off the line: .5 (2 pi/180)^2/8 */
            if (theta_d > 1e-3) assert_true(fabs(g[k]/wi[2] - wave(0, 0, at_p, k)) < 1e-4);
        }
    }
    const double up[3] = {0, 0, 1}, below[3] = {0.6, 0, -0.8};
    double f[3];
    merl_eval(&by_angle, below, up, f);
    assert_true(f[0] == 0 && f[1] == 0 && f[2] == 0);
    merl_eval(&by_angle, up, up, f);
    assert_true(fabs(f[0] - linear(0, 0, 0, 0)) < 1e-12);
    merl_free(&by_angle);
    merl_free(&by_azimuth);
}

static double spoilt(double i, double j, double k, int channel)
{
    return i == 3 && j == 4 && k == 5 && channel == 1 ? NAN : 1;
}

static void refuses(const char *path, facet_status status, const char *text)
{
    merl m;
    facet_error why = {0};
    assert_int_equal(merl_read(path, &m, &why), status);
    assert_null(m.values);
    if (!strstr(why.text, text) && !strstr(why.place, text)) fail_msg("%s: %s: no `%s`", why.place, why.text, text);
}

static void other_files_are_refused(void **state)
{
    (void)state;
    static const int other_sizes[3] = {90, 90, 360};
    refuses(make_file("other.binary", other_sizes, linear), FACET_BAD_FILE, "90, 90, 360");
    /* 3 4 5 of green: 12 + 8 (90 90 180 + (3 90 + 4) 180 + 5) */
    refuses(make_file("nan.binary", right_sizes, spoilt), FACET_BAD_FILE, "byte 12058612");
    size_t size;
    char *bytes = read_bytes(in_folder(folder, "nan.binary"), &size);
    FILE *file = fopen(in_folder(folder, "short.binary"), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size - 1, file), size - 1);
    fclose(file);
    free(bytes);
    refuses(in_folder(folder, "short.binary"), FACET_BAD_FILE, "34992011 bytes");
    write_text(in_folder(folder, "empty.binary"), "");
    refuses(in_folder(folder, "empty.binary"), FACET_BAD_FILE, "0 bytes");
    refuses(in_folder(folder, "absent.binary"), FACET_IO, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_found_between_the_measured_angles),
        cmocka_unit_test(other_files_are_refused),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
