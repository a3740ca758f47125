/* interruption.h: signals to a render: those that ask it to end, and the one by which a library gives up.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* From here on SIGINT, SIGTERM and SIGHUP ask for an end, and a second of them ends the program at once; SIGHUP only
 * where it is not ignored, as under nohup.  SIGABRT ends the program with a line and EXIT_WORLD. */
void catch_signals(void);

/* An end has been asked for. */
bool is_interrupted(void);

#ifdef __cplusplus
}
#endif
