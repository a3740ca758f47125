/* picture_bytes.h: whether two picture files are the same.
 * SPDX-License-Identifier: MIT */
#pragma once

/* Fail the test if the pictures `a` and `b` in the folder differ in a bit of a pixel ... */
void assert_same_pixels(const char *folder, const char *a, const char *b);

/* ... or if the files differ in a byte that is not the time's. */
void assert_same_but_for_time(const char *folder, const char *a, const char *b);
