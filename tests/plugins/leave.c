/* leave.c: Lambert, whose eval ends the process as if all had gone well.
 * A verifier must report it: the work is not done. For the tests of the loader.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <unistd.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

/* f cos(theta_i) = cos(theta_i)/pi, if the process were to go on. */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    (void)p;
    _exit(0);
    for (int i = 0; i < 3; i++) f[i] = wi[2] > 0 && wo[2] > 0 ? wi[2]/PI : 0;
}

/* The density cos(theta_i)/pi. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    (void)p;
    return wi[2] > 0 && wo[2] > 0 ? wi[2]/PI : 0;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    const double sine = sqrt(u[0]), phi = 2*PI*u[1];
    wi[0] = sine*cos(phi);
    wi[1] = sine*sin(phi);
    wi[2] = sqrt(1 - u[0]);
    const double density = pdf(p, wi, wo);
    if (!(density > 0)) return 0;
    eval(p, wi, wo, weight);
    for (int i = 0; i < 3; i++) weight[i] /= density;
    return 1;
}

static const facet_plugin_parameter parameters[] = {
    {"unused", 0, 1, 0, "not used"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "leave",
    .summary = "ends the process in eval",
    .parameter_count = 1,
    .parameters = parameters,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
