/* file.h: whole files in, and atomic files out.
 *
 * Reading checks sizes before taking memory and refuses what is not a regular file.  Writing goes to a
 * temporary name beside the target, is fsynced, and is renamed only when complete, so that no reader
 * ever sees half a file and a failure leaves the old one untouched.  Of a symbolic link the target is
 * replaced, and the link stays.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Files above this many bytes are refused, with FACET_UNSUPPORTED [byte]. */
#define FILE_SIZE_CAP ((size_t)2 << 30)

/* What reading a scene or a picture may take in memory, if nothing else is asked for [byte]. */
#define FILE_MEMORY_DEFAULT ((size_t)8 << 30)

/* The whole file, with one 0 byte after its end that *size does not count.  The caller frees *bytes. */
facet_status file_read(const char *path, unsigned char **bytes, size_t *size, facet_error *why);

/* The same, of at most `most` bytes in place of FILE_SIZE_CAP. */
facet_status file_read_within(const char *path, size_t most, unsigned char **bytes, size_t *size, facet_error *why);

/* Where `path` leads to once its symbolic links are followed: *resolved, without links, is the caller's to free, and
 * *is_inside tells whether that lies in or below the folder ("" is the working directory).  FACET_IO if it does not
 * exist. */
facet_status file_resolve(const char *folder, const char *path, char **resolved, bool *is_inside, facet_error *why);

/* A regular file of any size to read from; the caller closes *stream. */
facet_status file_open(const char *path, FILE **stream, uint64_t *size, facet_error *why);

/* Whether it is a regular file that can be read and begins with `magic`, of at most 16 bytes. */
bool file_begins_with(const char *path, const char *magic);

/* Whether two names are of one file, once symbolic links are followed: by its device and number, or where there is no
 * file yet by its folder's and the last part of the name. */
bool file_is_same(const char *a, const char *b);

/* A file being written.  Write to `stream`, then commit (rename over `path`) or discard (remove). */
typedef struct file_writer {
    FILE *stream;
    char *path;
    char *temporary;
} file_writer;

facet_status file_writer_open(file_writer *writer, const char *path, facet_error *why);
/* Flushes, checks every earlier write, fsyncs, closes and renames.  On failure the temporary is removed. */
facet_status file_writer_commit(file_writer *writer, facet_error *why);
void file_writer_discard(file_writer *writer);

/* Removes what writers of `path` that were killed have left beside it: files NAME.tmp-PID-N, of no process of this
 * machine, or of this one, which must not be writing `path` yet. */
void file_remove_leftovers(const char *path);

#ifdef __cplusplus
}
#endif
