/* Loaded with LD_PRELOAD: makes file operations in one folder fail, write short or kill the process, as selected by a test.
 *
 * FAULT_UNDER  only paths that start with this prefix are affected
 * FAULT_KIND   enospc, eio, short, kill, or none (only count operations)
 * FAULT_FIRST  number of the first faulty operation, from 1
 * FAULT_COUNT  number of faulty operations
 * FAULT_LOG    file to which every operation is appended as a line: its number, name and path, and "fault" if one was injected
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static long operations;

enum fault { NONE, FAIL_ENOSPC, FAIL_EIO, SHORT };

/* Returns the fault for one operation; kills the process if that is the fault. */
static enum fault decide(const char *name, const char *path, int writes) {
    const char *under = getenv("FAULT_UNDER"), *kind = getenv("FAULT_KIND"), *log = getenv("FAULT_LOG");
    if (!under || !kind || !path || strncmp(path, under, strlen(under)) != 0) return NONE;
    long first = getenv("FAULT_FIRST") ? atol(getenv("FAULT_FIRST")) : 0, count = getenv("FAULT_COUNT") ? atol(getenv("FAULT_COUNT")) : 1;
    enum fault fault = NONE;
    pthread_mutex_lock(&lock);
    long number = ++operations;
    int hit = number >= first && number < first + count && strcmp(kind, "none") != 0;
    if (hit && strcmp(kind, "enospc") == 0 && writes) fault = FAIL_ENOSPC;
    else if (hit && strcmp(kind, "eio") == 0) fault = FAIL_EIO;
    else if (hit && strcmp(kind, "short") == 0 && writes == 2) fault = SHORT;
    int killed = hit && strcmp(kind, "kill") == 0;
    if (log) {
        char line[4400];
        int length = snprintf(line, sizeof line, "%ld %s %s%s\n", number, name, path, fault != NONE || killed ? " fault" : "");
        long fd = syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0600);
        if (fd >= 0) {
            syscall(SYS_write, fd, line, length);
            syscall(SYS_close, fd);
        }
    }
    pthread_mutex_unlock(&lock);
    if (killed) syscall(SYS_kill, getpid(), SIGKILL);
    if (fault == FAIL_ENOSPC) errno = ENOSPC;
    if (fault == FAIL_EIO) errno = EIO;
    return fault;
}

static enum fault decide_fd(const char *name, int fd, int writes) {
    char link[64], path[4200];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) return NONE;
    path[length] = 0;
    return decide(name, path, writes);
}

#define NEXT(name) static __typeof__(name) *next; if (!next) next = dlsym(RTLD_NEXT, #name)
static int fails(enum fault fault) { return fault == FAIL_ENOSPC || fault == FAIL_EIO; }

ssize_t write(int fd, const void *bytes, size_t count) {
    NEXT(write);
    enum fault fault = decide_fd("write", fd, 2);
    if (fails(fault)) return -1;
    return next(fd, bytes, fault == SHORT && count > 1 ? count / 2 : count);
}
ssize_t pwrite64(int fd, const void *bytes, size_t count, off64_t at) {
    NEXT(pwrite64);
    enum fault fault = decide_fd("pwrite", fd, 2);
    if (fails(fault)) return -1;
    return next(fd, bytes, fault == SHORT && count > 1 ? count / 2 : count, at);
}
ssize_t pwrite(int fd, const void *bytes, size_t count, off_t at) { return pwrite64(fd, bytes, count, at); }

static int opened(const char *path, int flags, mode_t mode, int folder) {
    if ((flags & O_ACCMODE) != O_RDONLY || flags & O_CREAT) {
        if (fails(decide("open", path, flags & O_CREAT ? 1 : 0))) return -1;
    }
    return (int)syscall(SYS_openat, folder, path, flags, mode);
}
static mode_t mode_of(int flags, va_list list) { return flags & (O_CREAT | O_TMPFILE) ? va_arg(list, mode_t) : 0; }
int open64(const char *path, int flags, ...) {
    va_list list; va_start(list, flags); mode_t mode = mode_of(flags, list); va_end(list);
    return opened(path, flags | O_LARGEFILE, mode, AT_FDCWD);
}
int open(const char *path, int flags, ...) {
    va_list list; va_start(list, flags); mode_t mode = mode_of(flags, list); va_end(list);
    return opened(path, flags, mode, AT_FDCWD);
}
int rename(const char *from, const char *to) { NEXT(rename); return fails(decide("rename", to, 1)) ? -1 : next(from, to); }
int unlink(const char *path) { NEXT(unlink); return fails(decide("unlink", path, 0)) ? -1 : next(path); }
int rmdir(const char *path) { NEXT(rmdir); return fails(decide("rmdir", path, 0)) ? -1 : next(path); }
int mkdir(const char *path, mode_t mode) { NEXT(mkdir); return fails(decide("mkdir", path, 1)) ? -1 : next(path, mode); }
int fsync(int fd) { NEXT(fsync); return fails(decide_fd("fsync", fd, 0)) ? -1 : next(fd); }
int fdatasync(int fd) { NEXT(fdatasync); return fails(decide_fd("fdatasync", fd, 0)) ? -1 : next(fd); }
int ftruncate64(int fd, off64_t length) { NEXT(ftruncate64); return fails(decide_fd("ftruncate", fd, 0)) ? -1 : next(fd, length); }
int ftruncate(int fd, off_t length) { return ftruncate64(fd, length); }
