/* run_program.c: child processes and their files.
 * SPDX-License-Identifier: MIT */
#include "tests/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void give_up(const char *what)
{
    perror(what);
    abort();
}

char *make_folder(void)
{
    const char *base = getenv("TMPDIR");
    char path[1024];
    snprintf(path, sizeof path, "%s/facet-test-XXXXXX", base && *base ? base : "/tmp");
    if (!mkdtemp(path)) give_up(path);
    return strdup(path);
}

void remove_folder(char *folder)
{
    const char *const argv[] = {"/bin/rm", "-rf", folder, NULL};
    wait_for_program(start_program(folder, NULL, "/dev/null", argv));
    free(folder);
}

static const char *join(const char *folder, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", folder, name);
    return path;
}

const char *in_folder(const char *folder, const char *name)
{
    static char paths[4][1200];
    static int next;
    return join(folder, name, paths[next++ & 3], sizeof paths[0]);
}

void write_text(const char *path, const char *text)
{
    FILE *stream = fopen(path, "w");
    if (!stream || fputs(text, stream) < 0 || fclose(stream)) give_up(path);
}

char *read_bytes(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    if (!stream) return NULL;
    fseek(stream, 0, SEEK_END);
    const long length = ftell(stream);
    rewind(stream);
    char *bytes = malloc((size_t)length + 1);
    if (!bytes || fread(bytes, 1, (size_t)length, stream) != (size_t)length) give_up(path);
    fclose(stream);
    bytes[length] = 0;
    if (size) *size = (size_t)length;
    return bytes;
}

/* In the child: the file as one of the standard streams. */
static void redirect(const char *path, int flags, int stream)
{
    const int file = open(path, flags, 0600);
    if (file < 0 || dup2(file, stream) < 0) _exit(127);
}

pid_t start_program(const char *folder, const char *input, const char *out, const char *const *argv)
{
    const pid_t pid = fork();
    if (pid < 0) give_up("fork");
    if (pid > 0) return pid;
    redirect(input ? input : "/dev/null", O_RDONLY, STDIN_FILENO);
    char path[1200];
    redirect(out ? out : join(folder, "stdout", path, sizeof path), O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
    redirect(join(folder, "stderr", path, sizeof path), O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
    signal(SIGHUP, SIG_DFL); /* whatever started the tests may ignore these */
    signal(SIGINT, SIG_DFL);
    if (chdir(folder) != 0) _exit(127);
    execv(argv[0], (char *const *)argv);
    _exit(127);
}

int wait_for_program(pid_t pid)
{
    int status;
    if (waitpid(pid, &status, 0) != pid) give_up("waitpid");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

program_run run_program(const char *folder, const char *input, const char *out, const char *const *argv)
{
    program_run run;
    char path[1200];
    run.status = wait_for_program(start_program(folder, input, out, argv));
    run.out = read_bytes(join(folder, "stdout", path, sizeof path), NULL);
    run.err = read_bytes(join(folder, "stderr", path, sizeof path), NULL);
    return run;
}

void program_run_free(program_run *run)
{
    free(run->out);
    free(run->err);
}
