/* plot_materials.h: what `facet plot` is given: facet's materials, measurements and plugins, as text.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "cli/plugin_host.h"
#include "io/merl.h"
#include "plot/figure.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One SPEC: "merl file=FILE", "plugin file=FILE NAME=VALUE ...", or a material of the library. */
typedef struct plot_spec {
    const char *text;
    enum { SPEC_MATERIAL, SPEC_MERL, SPEC_PLUGIN } kind;
    char *copy;                                /* the words of a plugin */
    const char *path;                          /* of a measurement or a plugin */
    const char *parameters[PLUGIN_PARAMETERS]; /* of a plugin: NAME=VALUE */
    size_t n_parameters;
    merl measured;
    plugin model;
} plot_spec;

/* Finds out what the text is, which is referred to.  0, or the exit status of the error that it printed. */
int plot_spec_read(const char *text, plot_spec *s);

/* Loads what the text names; `m` refers to `s`.  watch: for plugins, by plugin_supervise. */
int plot_spec_open(plot_spec *s, const char *label, plugin_watch *watch, figure_material *m);

void plot_spec_free(plot_spec *s);

#ifdef __cplusplus
}
#endif
