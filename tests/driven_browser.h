/* driven_browser.h: Chromium without a window, driven by its DevTools protocol over two pipes.
 *
 * Expressions are JavaScript without double quotes and backslashes.  A function that cannot do its work ends the test.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <sys/types.h>

typedef struct driven_browser {
    pid_t pid;
    int to, from; /* commands, answers */
    unsigned n_sent;
    char session[80]; /* the page's name in the protocol; empty: commands are for the browser */
} driven_browser;

/* Starts the program `chromium` with its files below `folder`, and opens a page of 1000 x 700 pixels. */
driven_browser browser_start(const char *chromium, const char *folder, const char *url);
void browser_stop(driven_browser *b);

/* What the page is told of the user's preference between light and dark. */
void browser_prefer(driven_browser *b, bool is_dark);

/* The value of an expression as text; the caller frees. */
char *browser_value(driven_browser *b, const char *expression);
/* Waits until an expression is true. */
void browser_wait(driven_browser *b, const char *expression);
/* Presses and releases the left button in the middle of the element with this id. */
void browser_click(driven_browser *b, const char *id);
/* Writes what is seen of the page as PNG. */
void browser_screenshot(driven_browser *b, const char *path);
