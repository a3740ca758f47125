/* plugin_host.c: see plugin_host.h.
 * SPDX-License-Identifier: MIT */
#include "cli/plugin_host.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/suggest.h"

/* ---- What the library describes ---------------------------------------------------------------- */

/* What is wrong with a description, or NULL; `place`: the parameter. */
static const char *fault_of(const facet_plugin *m, const char **place)
{
    *place = "";
    if (m->struct_size < sizeof *m)
        return "its facet_plugin is smaller than this version's: set struct_size to "
               "sizeof(facet_plugin) and compile it against this facet/plugin.h";
    if (!m->name || !*m->name || !m->summary) return "it has no name, or no summary";
    if (!m->eval) return "it has no eval";
    if (!m->pdf != !m->sample) return "it has one of pdf and sample; a sampler needs both";
    if (m->parameter_count < 0 || m->parameter_count > PLUGIN_PARAMETERS)
        return "its number of parameters is not from 0 to 32";
    if (m->parameter_count > 0 && !m->parameters) return "its table of parameters is NULL";
    for (int i = 0; i < m->parameter_count; i++) {
        const facet_plugin_parameter *p = &m->parameters[i];
        if (!p->name || !*p->name) return "a parameter has no name";
        *place = p->name;
        if (!(isfinite(p->lowest) && isfinite(p->highest) && p->lowest <= p->value && p->value <= p->highest))
            return "lowest, value and highest of this parameter must be finite and in this order";
    }
    return NULL;
}

static int set_parameter(const char *path, plugin *p, const char *text)
{
    const size_t length = strcspn(text, "=");
    char name[96], *end;
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    if (text[length] != '=') return fail(EXIT_USAGE, path, name, "a parameter is written NAME=VALUE");
    suggestion near = suggestion_start(name);
    for (int i = 0; i < p->model->parameter_count; i++) {
        const facet_plugin_parameter *q = &p->model->parameters[i];
        suggestion_offer(&near, q->name);
        if (strcmp(q->name, name) != 0) continue;
        const double value = strtod(text + length + 1, &end);
        if (end == text + length + 1 || *end)
            return fail(EXIT_USAGE, path, name, "`%s` is not a number", text + length + 1);
        if (!(value >= q->lowest && value <= q->highest))
            return fail(EXIT_USAGE, path, name, "%g is out of range; it is from %g to %g", value, q->lowest,
                        q->highest);
        if (p->is_fixed[i]) return fail(EXIT_USAGE, path, name, "the parameter is given twice");
        p->values[i] = value;
        p->is_fixed[i] = true;
        return 0;
    }
    const char *meant = suggestion_get(&near);
    return fail(EXIT_USAGE, path, name, "the plugin has no such parameter%s%s%s", meant ? "; did you mean `" : "",
                meant ? meant : "", meant ? "`?" : "");
}

int plugin_open(const char *path, const char *const *texts, size_t n, plugin_watch *watch, plugin *p)
{
    char local[4096];
    if (access(path, R_OK)) return fail(EXIT_INPUT, path, NULL, "%s", strerror(errno));
    snprintf(local, sizeof local, "%s%s", strchr(path, '/') ? "" : "./", path);
    watch->path = path;
    watch->function = "the library's start";
    void *library = dlopen(local, RTLD_NOW | RTLD_LOCAL);
    if (!library) return fail(EXIT_INPUT, path, NULL, "is no shared library that can be loaded: %s", dlerror());
    const facet_plugin *(*describe)(void) = NULL;
    void *symbol = dlsym(library, "facet_plugin_describe");
    memcpy(&describe, &symbol, sizeof describe); /* ISO C has no cast from an object to a function */
    if (!describe) return fail(EXIT_INPUT, path, NULL, "defines no facet_plugin_describe (facet/plugin.h)");
    watch->function = "facet_plugin_describe";
    const facet_plugin *model = describe();
    watch->function = NULL;
    if (!model) return fail(EXIT_INPUT, path, NULL, "facet_plugin_describe returned NULL");
    const char *place, *fault = fault_of(model, &place);
    if (fault) return fail(EXIT_INPUT, path, place, "%s", fault);
    *p = (plugin){.path = path, .model = model, .watch = watch};
    for (int i = 0; i < model->parameter_count; i++) p->values[i] = model->parameters[i].value;
    for (size_t i = 0; i < n; i++) {
        const int status = set_parameter(path, p, texts[i]);
        if (status) return status;
    }
    return 0;
}

/* ---- Its functions, watched -------------------------------------------------------------------- */

static void enter(const plugin *p, const char *function)
{
    p->watch->path = p->path;
    p->watch->function = function;
}

static void leave(const plugin *p)
{
    p->watch->function = NULL;
    p->watch->calls++;
}

static void eval(const void *self, const double wi[3], const double wo[3], double f[3])
{
    const plugin *p = self;
    enter(p, "eval");
    p->model->eval(p->values, wi, wo, f);
    leave(p);
}

static double pdf(const void *self, const double wi[3], const double wo[3])
{
    const plugin *p = self;
    enter(p, "pdf");
    const double density = p->model->pdf(p->values, wi, wo);
    leave(p);
    return density;
}

static int sample(const void *self, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    const plugin *p = self;
    enter(p, "sample");
    const int is_one = p->model->sample(p->values, wo, u, wi, weight);
    leave(p);
    return is_one;
}

static double D(const void *self, const double m[3])
{
    const plugin *p = self;
    enter(p, "D");
    const double density = p->model->D(p->values, m);
    leave(p);
    return density;
}

static double G1(const void *self, const double v[3])
{
    const plugin *p = self;
    enter(p, "G1");
    const double masking = p->model->G1(p->values, v);
    leave(p);
    return masking;
}

verify_subject plugin_subject(const plugin *p)
{
    return (verify_subject){.self = p,
                            .claims = p->model->claims,
                            .eval = eval,
                            .pdf = p->model->pdf ? pdf : NULL,
                            .sample = p->model->sample ? sample : NULL,
                            .D = p->model->D ? D : NULL,
                            .G1 = p->model->G1 ? G1 : NULL};
}

/* ---- A process of its own ---------------------------------------------------------------------- */

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}

/* Where the plugin was when its process ended. */
static const char *whereabouts(const plugin_watch *w, char *text, size_t size)
{
    const char *function = w->function, *check = w->check;
    snprintf(text, size, "%s%s%s%s", function ? "in " : "outside its functions", function ? function : "",
             function && check ? ", called by the check " : "", function && check ? check : "");
    return text;
}

int plugin_supervise(const char *path, double patience, int (*work)(void *context, plugin_watch *watch), void *context)
{
    plugin_watch *watch = mmap(NULL, sizeof *watch, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (watch == MAP_FAILED) return fail_memory();
    watch->path = path;
    fflush(NULL);
    const pid_t child = fork();
    if (child < 0) return fail(EXIT_WORLD, path, NULL, "no process for the plugin: %s", strerror(errno));
    if (child == 0) {
        /* A crash ends the process, whatever else was to report it: the parent does. */
        static const int crashes[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
        for (size_t i = 0; i < sizeof crashes/sizeof *crashes; i++) signal(crashes[i], SIG_DFL);
        const int status = work(context, watch);
        watch->has_finished = true;
        fflush(NULL);
        _exit(status);
    }
    int status = 0;
    uint64_t calls = 0;
    double since = seconds_now();
    bool is_killed = false;
    char where[160];
    while (waitpid(child, &status, WNOHANG) == 0) {
        const struct timespec pause = {0, 20000000};
        nanosleep(&pause, NULL);
        if (watch->calls != calls || !watch->function) {
            calls = watch->calls;
            since = seconds_now();
        }
        if (seconds_now() - since > patience && !is_killed) {
            is_killed = true;
            kill(child, SIGKILL);
        }
    }
    if (WIFEXITED(status) && watch->has_finished) return WEXITSTATUS(status);
    whereabouts(watch, where, sizeof where);
    if (WIFEXITED(status)) /* whose status says nothing of the work, even if it is 0 */
        return fail(EXIT_INPUT, watch->path, NULL,
                    "the plugin ended its process, with status %d, %s; its functions must return", WEXITSTATUS(status),
                    where);
    if (is_killed)
        return fail(EXIT_INPUT, watch->path, NULL,
                    "the plugin has not returned for %g s %s; --patience gives it longer", patience, where);
    return fail(EXIT_INPUT, watch->path, NULL,
                "the plugin was ended by signal %d (%s) %s; run it alone under a debugger there", WTERMSIG(status),
                strsignal(WTERMSIG(status)), where);
}
