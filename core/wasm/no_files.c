/* no_files.c: what wasi-libc's stdio would import from its host, so that facet.wasm imports nothing.
 *
 * snprintf brings stdio along, and stdio the three calls below for files that the library never opens; each says that
 * there is no such call.  The names are wasi-libc's own for the functions that it imports.
 * SPDX-License-Identifier: MIT */
#include <stdint.h>

enum { WASI_ENOSYS = 52 };

int32_t __imported_wasi_snapshot_preview1_fd_close(int32_t file);
int32_t __imported_wasi_snapshot_preview1_fd_seek(int32_t file, int64_t offset, int32_t whence, int32_t result);
int32_t __imported_wasi_snapshot_preview1_fd_write(int32_t file, int32_t vectors, int32_t n_vectors, int32_t result);

int32_t __imported_wasi_snapshot_preview1_fd_close(int32_t file)
{
    (void)file;
    return WASI_ENOSYS;
}

int32_t __imported_wasi_snapshot_preview1_fd_seek(int32_t file, int64_t offset, int32_t whence, int32_t result)
{
    (void)file;
    (void)offset;
    (void)whence;
    (void)result;
    return WASI_ENOSYS;
}

int32_t __imported_wasi_snapshot_preview1_fd_write(int32_t file, int32_t vectors, int32_t n_vectors, int32_t result)
{
    (void)file;
    (void)vectors;
    (void)n_vectors;
    (void)result;
    return WASI_ENOSYS;
}
