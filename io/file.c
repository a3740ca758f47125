/* file.c: whole files in, and atomic files out (file.h).  POSIX.
 *
 * Messages leave out the path: the caller has it, and puts it before the place and the text.
 * SPDX-License-Identifier: MIT */
#include "io/file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

enum {
    /* Names "PATH.tmp-PID-N" tried before giving up; more than one only if a killed run left its own. */
    TEMPORARY_TRIES = 1000,
    SUFFIX_ROOM = 24, /* for ".tmp-PID-N" */
    MOST_LINKS = 40   /* that are followed, as the system does */
};

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

bool file_begins_with(const char *path, const char *magic)
{
    char bytes[16];
    FILE *stream;
    uint64_t size;
    facet_error why;
    const size_t n = strlen(magic);
    if (n > sizeof bytes || file_open(path, &stream, &size, &why) != FACET_OK) {
        return false;
    }
    const bool is_equal = fread(bytes, 1, n, stream) == n && memcmp(bytes, magic, n) == 0;
    fclose(stream);
    return is_equal;
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

/* ---- Names ------------------------------------------------------------------------------------- */

/* Whether the name is of what hides behind /dev and /proc.  /dev/shm holds files like any other. */
static bool is_special(const char *path)
{
    const bool is_device = strncmp(path, "/dev/", 5) == 0 && strncmp(path, "/dev/shm/", 9) != 0;
    return is_device || strncmp(path, "/proc/", 6) == 0;
}

/* The last part of a path, and the length of what stands before it, its slash too. */
static const char *base_of(const char *path, size_t *folder_length)
{
    const char *slash = strrchr(path, '/');
    *folder_length = slash ? (size_t)(slash - path) + 1 : 0;
    return path + *folder_length;
}

/* The folder that a path lies in; the caller frees.  NULL and errno without memory. */
static char *folder_of(const char *path)
{
    size_t length;
    base_of(path, &length);
    return length ? strndup(path, length) : strdup(".");
}

/* Where `path` leads if it is a symbolic link; unlike realpath's, its end need not exist.  The caller frees; NULL and
 * errno on failure. */
static char *follow_links(const char *path)
{
    char *name = strdup(path);
    for (int i = 0; name && !is_special(name); i++) {
        char target[PATH_MAX];
        size_t folder_length;
        const ssize_t n = readlink(name, target, sizeof target);
        if (n < 0) {
            break; /* not a link, or nothing */
        }
        if (i == MOST_LINKS || (size_t)n == sizeof target) {
            free(name);
            errno = i == MOST_LINKS ? ELOOP : ENAMETOOLONG;
            return NULL;
        }
        base_of(name, &folder_length);
        const size_t kept = target[0] == '/' ? 0 : folder_length;
        char *next = malloc(kept + (size_t)n + 1);
        if (next) {
            memcpy(next, name, kept);
            memcpy(next + kept, target, (size_t)n);
            next[kept + (size_t)n] = 0;
        }
        free(name);
        name = next;
    }
    return name;
}

/* How many bytes of the last part of a path its temporary begins with: all, but for a name that leaves no room. */
static size_t stem_length(const char *folder, const char *base)
{
    const long limit = pathconf(folder, _PC_NAME_MAX);
    const size_t most = (limit > 2*SUFFIX_ROOM && limit < NAME_MAX ? (size_t)limit : NAME_MAX) - SUFFIX_ROOM;
    size_t n = strlen(base);
    if (n > most) {
        for (n = most; n > 0 && ((unsigned char)base[n] & 0xc0) == 0x80;) {
            n--; /* not within a character of UTF-8, which some file systems insist on */
        }
    }
    return n;
}

bool file_is_same(const char *a, const char *b)
{
    struct stat info_a, info_b;
    const bool has_a = stat(a, &info_a) == 0, has_b = stat(b, &info_b) == 0;
    if (has_a || has_b) {
        return has_a && has_b && info_a.st_dev == info_b.st_dev && info_a.st_ino == info_b.st_ino;
    }
    char *end_a = follow_links(a), *end_b = follow_links(b);
    char *folder_a = end_a ? folder_of(end_a) : NULL, *folder_b = end_b ? folder_of(end_b) : NULL;
    size_t length_a, length_b;
    const bool is_same = folder_a && folder_b && stat(folder_a, &info_a) == 0 && stat(folder_b, &info_b) == 0 &&
                         info_a.st_dev == info_b.st_dev && info_a.st_ino == info_b.st_ino &&
                         strcmp(base_of(end_a, &length_a), base_of(end_b, &length_b)) == 0;
    free(folder_b);
    free(folder_a);
    free(end_b);
    free(end_a);
    return is_same;
}

/* ---- Writing ----------------------------------------------------------------------------------- */

/* Devices, pipes and what hides behind /dev and /proc are written in place: there is nothing to rename
 * onto, and renaming onto /dev/stdout would replace the device's own name. */
static bool is_written_in_place(const char *path, bool exists, mode_t mode)
{
    return (exists && !S_ISREG(mode)) || is_special(path);
}

/* Opens a new file beside the target; its name is *temporary, owned by the caller.  -1 and errno on failure. */
static int open_temporary(const char *path, char **temporary)
{
    const size_t capacity = strlen(path) + 64;
    char *name = malloc(capacity), *folder = folder_of(path);
    if (!name || !folder) {
        free(folder);
        free(name);
        errno = ENOMEM;
        return -1;
    }
    size_t kept;
    const char *base = base_of(path, &kept);
    kept += stem_length(folder, base);
    free(folder);
    int descriptor = -1;
    errno = EEXIST;
    for (int i = 0; i < TEMPORARY_TRIES && descriptor < 0 && errno == EEXIST; i++) {
        snprintf(name, capacity, "%.*s.tmp-%ld-%d", (int)kept, path, (long)getpid(), i);
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
    if (!exists && errno != ENOENT) { /* such as a name that is too long for the file that the temporary becomes */
        return system_error(why, "cannot create", errno);
    }
    if (exists && S_ISDIR(info.st_mode)) {
        return facet_error_set(why, FACET_IO, "", "is a directory; name a file to write");
    }
    file_writer w = {.path = follow_links(path)};
    if (!w.path) {
        return system_error(why, "cannot create", errno);
    }
    const int descriptor = is_written_in_place(w.path, exists, info.st_mode)
                               ? open(w.path, O_WRONLY | O_NOCTTY | O_CLOEXEC)
                               : open_temporary(w.path, &w.temporary);
    if (descriptor < 0) {
        const int code = errno;
        file_writer_discard(&w);
        return system_error(why, "cannot create", code);
    }
    w.stream = fdopen(descriptor, "wb");
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
    char *folder = folder_of(path);
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

/* Whether the end of a name is ".tmp-PID-N" of a process that is gone.  One with the number of this process is of an
 * earlier one that had it, too, as in containers, where the first process is always number 1. */
static bool is_leftover(const char *suffix)
{
    if (strncmp(suffix, ".tmp-", 5) != 0 || !isdigit((unsigned char)suffix[5])) {
        return false;
    }
    char *end;
    errno = 0;
    const long process = strtol(suffix + 5, &end, 10);
    const bool is_ours = *end == '-' && end[1] && !end[1 + strspn(end + 1, "0123456789")];
    if (!is_ours || errno || process < 1 || process > INT_MAX) {
        return false;
    }
    return process == getpid() || (kill((pid_t)process, 0) != 0 && errno == ESRCH);
}

void file_remove_leftovers(const char *path)
{
    char *target = follow_links(path), *folder = target ? folder_of(target) : NULL;
    DIR *entries = folder ? opendir(folder) : NULL;
    size_t folder_length;
    const char *base = target ? base_of(target, &folder_length) : NULL;
    const size_t length = entries ? stem_length(folder, base) : 0;
    for (const struct dirent *entry; entries && (entry = readdir(entries)) != NULL;) {
        if (strncmp(entry->d_name, base, length) == 0 && is_leftover(entry->d_name + length)) {
            unlinkat(dirfd(entries), entry->d_name, 0);
        }
    }
    if (entries) {
        closedir(entries);
    }
    free(folder);
    free(target);
}
