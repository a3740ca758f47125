/* watch_page.h: watch_page.html as the build embeds it (tools/embed.cmake).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

extern const unsigned char watch_page[];
extern const size_t watch_page_size;

#ifdef __cplusplus
}
#endif
