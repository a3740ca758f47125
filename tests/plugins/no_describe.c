/* no_describe.c: a shared library that defines another symbol than facet_plugin_describe.
 * A loader must refuse it and name the symbol that it looks for.  For the tests of the loader.
 * SPDX-License-Identifier: MIT */
#include "facet/facet.h"

FACET_API int facet_plugin_description(void);

int facet_plugin_description(void)
{
    return 1;
}
