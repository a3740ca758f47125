/* leave_at_start.c: a shared library whose constructor ends the process before anything can be asked of it.
 * A loader must report it: status 7 is not its own.  For the tests of the loader.
 * SPDX-License-Identifier: MIT */
#include <unistd.h>

#include "facet/facet.h"

FACET_API int facet_plugin_description(void);

__attribute__((constructor)) static void leave(void)
{
    _exit(7);
}

int facet_plugin_description(void)
{
    return 1;
}
