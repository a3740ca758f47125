/* interruption.c: signals to a render.
 * SPDX-License-Identifier: MIT */
#include "cli/interruption.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "cli/report.h"

static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
enum { N_SIGNALS = sizeof signals/sizeof *signals };

/* The one thing that a signal can reach. */
static volatile sig_atomic_t has_signal;

static void interrupt(int signal_number)
{
    has_signal = signal_number != 0;
    for (size_t i = 0; i < N_SIGNALS; i++) signal(signals[i], SIG_DFL);
}

/* Embree's threads abort where they get no memory.  Only what is safe in a signal handler. */
static void explain_abort(int signal_number)
{
    static const char text[] = "facet: error: the ray tracer gave up, most often for want of memory; checkpoints and "
                               "pictures already written are whole\n";
    (void)signal_number;
    (void)!write(STDERR_FILENO, text, sizeof text - 1);
    _exit(EXIT_WORLD);
}

void catch_signals(void)
{
    const struct sigaction action = {.sa_handler = interrupt, .sa_flags = SA_RESTART};
    struct sigaction before;
    for (size_t i = 0; i < N_SIGNALS; i++) {
        const bool is_ignored = sigaction(signals[i], NULL, &before) == 0 && before.sa_handler == SIG_IGN;
        if (!(signals[i] == SIGHUP && is_ignored)) sigaction(signals[i], &action, NULL);
    }
    signal(SIGABRT, explain_abort);
}

bool is_interrupted(void)
{
    return has_signal;
}
