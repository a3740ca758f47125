/* leave.c: a model whose eval ends the process as if all had gone well.
 * A verifier must report it: the work is not done. For the tests of the loader.
 * SPDX-License-Identifier: MIT */
#include <unistd.h>

#include "facet/plugin.h"

static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    (void)p, (void)wi, (void)wo, (void)f;
    _exit(0);
}

/* Uniform over the hemisphere, 1/(2 pi): it is not asked. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    (void)p, (void)wi, (void)wo;
    return 0.15915494309189535;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    (void)p, (void)wo, (void)u, (void)wi, (void)weight;
    return 0;
}

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "leave",
    .summary = "ends the process in eval",
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
