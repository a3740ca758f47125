/* verify_report.c: runs the checks of `facet verify` and says what they found.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/progress.h"
#include "cli/report.h"
#include "cli/verify_job.h"

static const char *const verdict_names[] = {"holds", "FAILS", "-"};

/* The command that runs this check of this case alone. */
static void reproduction(const verdicts *v, const verify_case *c, const verify_result *r, char *text, size_t size)
{
    char quoted[512];
    if (v->o->plugin) {
        shell_quote(quoted, sizeof quoted, v->o->plugin);
        snprintf(text, size, "facet verify --plugin %s %s --check %s --fixed --samples %llu --seed %llu", quoted,
                 c->text, verify_names[r->check], (unsigned long long)v->o->samples, (unsigned long long)v->o->seed);
    } else {
        shell_quote(quoted, sizeof quoted, c->text);
        snprintf(text, size, "facet verify %s --check %s --fixed --samples %llu --seed %llu", quoted,
                 verify_names[r->check], (unsigned long long)v->o->samples, (unsigned long long)v->o->seed);
    }
}

static void print_row(const verdicts *v, const verify_case *c, const verify_result *r)
{
    char again[1024], worst[24] = "", allowed[24] = "";
    if (r->verdict != VERIFY_LEFT_OUT) snprintf(worst, sizeof worst, "%.2g", r->worst);
    if (r->verdict != VERIFY_LEFT_OUT && isfinite(r->tolerance))
        snprintf(allowed, sizeof allowed, "%.2g", r->tolerance);
    printf("  %-18s %-6s %-9s %-9s %s\n", verify_names[r->check], verdict_names[r->verdict], worst, allowed, r->found);
    if (r->verdict != VERIFY_FAILED) return;
    const bool is_pair = r->wi[0] != 0 || r->wi[1] != 0 || r->wi[2] != 0;
    printf("    at wo %.9g,%.9g,%.9g", r->wo[0], r->wo[1], r->wo[2]);
    if (is_pair) printf(" wi %.9g,%.9g,%.9g", r->wi[0], r->wi[1], r->wi[2]);
    reproduction(v, c, r, again, sizeof again);
    printf("\n    again: %s\n", again);
}

static void write_row(verdicts *v, const verify_case *c, const verify_result *r)
{
    static const char *const names[] = {"passed", "failed", "left out"};
    json_writer *j = &v->json;
    char again[1024];
    json_put_open(j, NULL, '{');
    json_put_text(j, "check", verify_names[r->check]);
    json_put_text(j, "verdict", names[r->verdict]);
    if (r->verdict != VERIFY_LEFT_OUT) {
        json_put_number(j, "worst", r->worst);
        json_put_number(j, "allowed", r->tolerance);
        json_put_text(j, "reason", verify_reasons[r->check]);
        json_put_numbers(j, "wo", r->wo, 3);
        json_put_numbers(j, "wi", r->wi, 3);
    }
    json_put_text(j, "found", r->found);
    if (r->verdict == VERIFY_FAILED) {
        reproduction(v, c, r, again, sizeof again);
        json_put_text(j, "command", again);
    }
    json_put_close(j, '}');
}

bool verify_is_chosen(const verify_options *o, verify_check check)
{
    return !o->check || strcmp(o->check, verify_names[check]) == 0;
}

verdicts verdicts_begin(const verify_options *o, size_t n_cases)
{
    verdicts v = {.o = o, .n_cases = n_cases};
    if (o->json) {
        v.json = json_put_start(stdout);
        json_put_open(&v.json, NULL, '{');
        if (o->plugin) json_put_text(&v.json, "plugin", o->plugin);
        json_put_open(&v.json, "cases", '[');
    }
    return v;
}

void case_title(const verify_options *o, const verify_case *c, char *title, size_t size)
{
    snprintf(title, size, "%s%s%s", o->plugin ? o->plugin : "", o->plugin && *c->text ? " " : "", c->text);
}

static void write_results(verdicts *v, const verify_case *c, const verify_result results[VERIFY_CHECKS])
{
    const verify_options *o = v->o;
    json_put_open(&v->json, NULL, '{');
    json_put_text(&v->json, o->plugin ? "parameters" : "material", c->text);
    json_put_open(&v->json, "checks", '[');
    for (int k = 0; k < VERIFY_CHECKS; k++)
        if (verify_is_chosen(o, (verify_check)k)) write_row(v, c, &results[k]);
    json_put_close(&v->json, ']');
    json_put_close(&v->json, '}');
}

/* With --all one line, and the checks that fail. */
static void print_results(const verdicts *v, const verify_case *c, const verify_result results[VERIFY_CHECKS])
{
    const verify_options *o = v->o;
    char title[512];
    size_t held = 0;
    for (int k = 0; k < VERIFY_CHECKS; k++)
        held += verify_is_chosen(o, (verify_check)k) && results[k].verdict == VERIFY_PASSED;
    case_title(o, c, title, sizeof title);
    printf("%s", title);
    if (o->all) printf(": %zu hold", held);
    putchar('\n');
    for (int k = 0; k < VERIFY_CHECKS; k++)
        if (verify_is_chosen(o, (verify_check)k) && (!o->all || results[k].verdict == VERIFY_FAILED))
            print_row(v, c, &results[k]);
    fflush(stdout);
}

int verdicts_add(verdicts *v, const verify_case *c, const verify_subject *subject, plugin_watch *watch)
{
    const verify_options *o = v->o;
    const int n_tests = verify_chi_square_tests(subject)*(int)v->n_cases;
    const verify_settings how = {o->seed, (int)o->samples, n_tests > 0 ? n_tests : 1};
    verify_result results[VERIFY_CHECKS];
    progress_show_step(v->n_done, v->n_cases, c->text);
    for (int k = 0; k < VERIFY_CHECKS; k++) {
        if (!verify_is_chosen(o, (verify_check)k)) continue;
        if (watch) watch->check = verify_names[k];
        results[k] = verify_run(subject, (verify_check)k, &how);
        v->n_failed += results[k].verdict == VERIFY_FAILED;
    }
    if (watch) watch->check = "the pictures";
    const int status = o->pictures ? pictures_draw(v, c, subject, &how) : 0;
    if (watch) watch->check = NULL;
    progress_end_steps(v->n_cases);
    if (status) return status;
    if (o->json) write_results(v, c, results);
    else print_results(v, c, results);
    v->n_done++;
    return 0;
}

int verdicts_end(verdicts *v)
{
    if (v->o->json) {
        json_put_close(&v->json, ']');
        json_put_integer(&v->json, "failed", v->n_failed);
        json_put_close(&v->json, '}');
        putchar('\n');
        return finish_stdout(v->n_failed ? EXIT_DIFFERS : 0);
    }
    if (!v->o->all) {
        printf("\nallowed:\n");
        for (int k = 0; k < VERIFY_CHECKS; k++)
            if (verify_is_chosen(v->o, (verify_check)k)) printf("  %-18s %s\n", verify_names[k], verify_reasons[k]);
        putchar('\n');
    }
    if (v->n_failed)
        printf("%zu check%s in %zu setting%s of the parameters\n", v->n_failed, v->n_failed == 1 ? " fails" : "s fail",
               v->n_cases, v->n_cases == 1 ? "" : "s");
    else printf("all checks hold\n");
    return finish_stdout(v->n_failed ? EXIT_DIFFERS : 0);
}
