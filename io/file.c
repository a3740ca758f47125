/* file.c: whole files in, and atomic files out (file.h).  POSIX.
 *
 * Messages leave out the path: the caller has it, and puts it before the place and the text.
 * SPDX-License-Identifier: MIT */
#include "io/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

/* Names "PATH.tmp-PID-N" tried before giving up; more than one only if a killed run left its own. */
#define TEMPORARY_TRIES 1000

static facet_status system_error(facet_error *why, const char *action, int code)
{
    switch (code) {
    case ENOSPC:
        return facet_error_set(why, FACET_IO, "", "%s: no space left on the device; free some, or write elsewhere",
                               action);
    case EDQUOT:
        return facet_error_set(why, FACET_IO, "", "%s: no space left in the disk quota; free some, or write elsewhere",
                               action);
    default: return facet_error_set(why, FACET_IO, "", "%s: %s", action, strerror(code));
    }
}

/* ---- Reading ----------------------------------------------------------------------------------- */

/* Checks that the open file is a regular one, and tells its size. */
static facet_status check_readable(int descriptor, uint64_t *size, facet_error *why)
{
    struct stat info;
    if (fstat(descriptor, &info) != 0) {
        return system_error(why, "cannot look at the file", errno);
    }
    if (S_ISDIR(info.st_mode)) {
        return facet_error_set(why, FACET_IO, "", "is a directory, not a regular file");
    }
    if (!S_ISREG(info.st_mode)) {
        return facet_error_set(why, FACET_IO, "", "is not a regular file; devices and pipes are not read");
    }
    *size = (uint64_t)info.st_size;
    return FACET_OK;
}

static facet_status open_readable(const char *path, int *descriptor, uint64_t *size, facet_error *why)
{
    /* O_NONBLOCK: opening a pipe without a writer would wait for ever. */
    *descriptor = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (*descriptor < 0) {
        return system_error(why, "cannot open", errno);
    }
    const facet_status status = check_readable(*descriptor, size, why);
    if (status != FACET_OK) {
        close(*descriptor);
    }
    return status;
}

facet_status file_open(const char *path, FILE **stream, uint64_t *size, facet_error *why)
{
    int descriptor;
    const facet_status status = open_readable(path, &descriptor, size, why);
    if (status != FACET_OK) {
        return status;
    }
    *stream = fdopen(descriptor, "rb");
    if (!*stream) {
        close(descriptor);
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory to read a file");
    }
    return FACET_OK;
}

static facet_status read_all(int descriptor, unsigned char *bytes, size_t size, facet_error *why)
{
    size_t done = 0;
    while (done < size) {
        const ssize_t n = read(descriptor, bytes + done, size - done);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n < 0) {
            return system_error(why, "cannot read", errno);
        }
        if (n == 0) {
            return facet_error_set(why, FACET_IO, "", "became shorter while it was read: %zu of %zu bytes", done, size);
        }
        done += (size_t)n;
    }
    return FACET_OK;
}

facet_status file_read(const char *path, unsigned char **bytes, size_t *size, facet_error *why)
{
    return file_read_within(path, FILE_SIZE_CAP, bytes, size, why);
}

facet_status file_read_within(const char *path, size_t most, unsigned char **bytes, size_t *size, facet_error *why)
{
    if (!path || !bytes || !size) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "file_read needs a path and two results");
    }
    int descriptor;
    uint64_t length = 0;
    facet_status status = open_readable(path, &descriptor, &length, why);
    if (status != FACET_OK) {
        return status;
    }
    unsigned char *buffer = NULL;
    const size_t n = (size_t)length;
    if (length > most) {
        status = facet_error_set(why, FACET_UNSUPPORTED, "", "has %llu bytes; files of up to %zu bytes are read",
                                 (unsigned long long)length, most);
    } else {
        buffer = malloc(n + 1);
        status = buffer ? read_all(descriptor, buffer, n, why)
                        : facet_error_set(why, FACET_NO_MEMORY, "", "no memory for its %zu bytes", n);
    }
    close(descriptor);
    if (status != FACET_OK) {
        free(buffer);
        return status;
    }
    buffer[n] = 0;
    *bytes = buffer;
    *size = n;
    return FACET_OK;
}

facet_status file_resolve(const char *folder, const char *path, char **resolved, bool *is_inside, facet_error *why)
{
    char *real = realpath(path, NULL);
    if (!real) {
        return errno == ENOMEM ? facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a path")
                               : system_error(why, "cannot open", errno);
    }
    char *root = realpath(*folder ? folder : ".", NULL);
    if (!root) {
        free(real);
        return system_error(why, "cannot look at the folder", errno);
    }
    const size_t length = strcmp(root, "/") == 0 ? 0 : strlen(root);
    *is_inside = strncmp(real, root, length) == 0 && (real[length] == '/' || !real[length]);
    *resolved = real;
    free(root);
    return FACET_OK;
}

/* ---- Writing ----------------------------------------------------------------------------------- */

/* Devices, pipes and what hides behind /dev and /proc are written in place: there is nothing to rename
 * onto, and renaming onto /dev/stdout would replace the device's own name.  /dev/shm holds files like any other. */
static bool is_written_in_place(const char *path, bool exists, mode_t mode)
{
    const bool is_device = strncmp(path, "/dev/", 5) == 0 && strncmp(path, "/dev/shm/", 9) != 0;
    return (exists && !S_ISREG(mode)) || is_device || strncmp(path, "/proc/", 6) == 0;
}

/* Opens a new file beside the target; its name is *temporary, owned by the caller.  -1 and errno on failure. */
static int open_temporary(const char *path, char **temporary)
{
    const size_t capacity = strlen(path) + 64;
    char *name = malloc(capacity);
    if (!name) {
        errno = ENOMEM;
        return -1;
    }
    int descriptor = -1;
    errno = EEXIST;
    for (int i = 0; i < TEMPORARY_TRIES && descriptor < 0 && errno == EEXIST; i++) {
        snprintf(name, capacity, "%s.tmp-%ld-%d", path, (long)getpid(), i);
        descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (descriptor < 0) {
        const int code = errno;
        free(name);
        errno = code;
        return -1;
    }
    *temporary = name;
    return descriptor;
}

facet_status file_writer_open(file_writer *writer, const char *path, facet_error *why)
{
    if (!writer || !path || !*path) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "a file to write needs a name");
    }
    struct stat info = {0};
    const bool exists = stat(path, &info) == 0;
    if (exists && S_ISDIR(info.st_mode)) {
        return facet_error_set(why, FACET_IO, "", "is a directory; name a file to write");
    }
    file_writer w = {0};
    const int descriptor = is_written_in_place(path, exists, info.st_mode) ? open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC)
                                                                           : open_temporary(path, &w.temporary);
    if (descriptor < 0) {
        return system_error(why, "cannot create", errno);
    }
    w.path = strdup(path);
    w.stream = w.path ? fdopen(descriptor, "wb") : NULL;
    if (!w.stream) {
        close(descriptor);
        file_writer_discard(&w);
        return facet_error_set(why, FACET_NO_MEMORY, "", "no memory to write a file");
    }
    *writer = w;
    return FACET_OK;
}

/* Makes the rename itself survive a power cut.  0, or an errno. */
static int sync_directory(const char *path)
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    char *folder = slash ? strndup(path, length) : strdup(".");
    if (!folder) {
        return ENOMEM;
    }
    const int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    free(folder);
    if (descriptor < 0) {
        return 0; /* a folder that may be written but not read: nothing more can be done */
    }
    const int code = fsync(descriptor) == 0 ? 0 : errno;
    close(descriptor);
    return code == EINVAL || code == EROFS || code == ENOTSUP ? 0 : code; /* file systems that cannot */
}

/* Flushes and fsyncs.  0, or an errno. */
static int flush(FILE *stream, bool is_in_place)
{
    if (ferror(stream)) {
        /* An earlier write failed, and the stream does not tell why: the system is asked once more, with
         * one byte for a file that is about to be given up. */
        return write(fileno(stream), "", 1) < 0 ? errno : EIO;
    }
    if (fflush(stream) != 0) {
        return errno;
    }
    if (fsync(fileno(stream)) != 0 && !(is_in_place && (errno == EINVAL || errno == ENOTSUP || errno == EROFS))) {
        return errno;
    }
    return 0;
}

facet_status file_writer_commit(file_writer *writer, facet_error *why)
{
    if (!writer || !writer->stream) {
        return facet_error_set(why, FACET_BAD_ARGUMENT, "", "no file is being written");
    }
    int code = flush(writer->stream, !writer->temporary);
    FILE *stream = writer->stream;
    writer->stream = NULL;
    if (fclose(stream) != 0 && code == 0) {
        code = errno;
    }
    if (code != 0) {
        file_writer_discard(writer);
        return system_error(why, "cannot write", code);
    }
    if (writer->temporary) {
        if (rename(writer->temporary, writer->path) != 0) {
            code = errno;
            file_writer_discard(writer);
            return system_error(why, "cannot rename the finished file", code);
        }
        free(writer->temporary);
        writer->temporary = NULL;
        code = sync_directory(writer->path);
    }
    file_writer_discard(writer);
    return code == 0 ? FACET_OK : system_error(why, "written, but its folder cannot be synced", code);
}

void file_writer_discard(file_writer *writer)
{
    if (!writer) {
        return;
    }
    if (writer->stream) {
        fclose(writer->stream);
    }
    if (writer->temporary) {
        unlink(writer->temporary);
    }
    free(writer->temporary);
    free(writer->path);
    *writer = (file_writer){0};
}

void file_remove_leftovers(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    DIR *entries = folder ? opendir(folder) : NULL;
    const char *name = slash ? slash + 1 : path;
    const size_t length = strlen(name);
    for (const struct dirent *entry; entries && (entry = readdir(entries)) != NULL;) {
        const char *rest = entry->d_name + length;
        if (strncmp(entry->d_name, name, length) == 0 && strncmp(rest, ".tmp-", 5) == 0) {
            unlinkat(dirfd(entries), entry->d_name, 0);
        }
    }
    if (entries) {
        closedir(entries);
    }
    free(folder);
}
