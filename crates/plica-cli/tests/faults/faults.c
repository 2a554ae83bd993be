/* A system that fails at its n-th operation on files: loaded before the C library (LD_PRELOAD), so that the program is the one
 * that users have. FAULT_AT is n; FAULT_HOW says what becomes of that operation:
 *   kill  the process is gone before it, as by kill -9;
 *   torn  the process is gone when half of what it writes is written;
 *   full  from then on no file can be made, and none grows. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static atomic_long count;

static void gone(void) {
    kill(getpid(), SIGKILL);
    pause();
}

/* Whether the operation finds no room; does not return where the process is gone. */
static int faulty(int needs_room) {
    const char *at = getenv("FAULT_AT"), *how = getenv("FAULT_HOW");
    if (!at || !how) return 0;
    long number = atomic_fetch_add(&count, 1) + 1, n = atol(at);
    if (!strcmp(how, "full")) return needs_room && number >= n;
    if (number != n) return 0;
    if (!strcmp(how, "torn") && needs_room) return 1;
    gone();
    return 0;
}

static int torn(void) {
    const char *how = getenv("FAULT_HOW");
    return how && !strcmp(how, "torn");
}

/* What is done where there is no room. */
static int no_room(void) {
    if (torn()) gone();
    errno = ENOSPC;
    return -1;
}

ssize_t write(int fd, const void *bytes, size_t length) {
    struct stat about;
    if (fstat(fd, &about) || !S_ISREG(about.st_mode) || !faulty(1)) return NEXT(write)(fd, bytes, length);
    if (torn()) {
        NEXT(write)(fd, bytes, length / 2);
        NEXT(fsync)(fd);
    }
    return no_room();
}

int open64(const char *path, int flags, ...) {
    mode_t mode = 0;
    if (flags & O_CREAT) {
        va_list rest;
        va_start(rest, flags);
        mode = va_arg(rest, mode_t);
        va_end(rest);
        if (faulty(1)) return no_room();
    }
    return NEXT(open64)(path, flags, mode);
}

int mkdir(const char *path, mode_t mode) {
    return faulty(1) ? no_room() : NEXT(mkdir)(path, mode);
}

int rename(const char *from, const char *to) {
    faulty(0);
    return NEXT(rename)(from, to);
}

int unlink(const char *path) {
    faulty(0);
    return NEXT(unlink)(path);
}

int rmdir(const char *path) {
    faulty(0);
    return NEXT(rmdir)(path);
}

int ftruncate64(int fd, off64_t length) {
    faulty(0);
    return NEXT(ftruncate64)(fd, length);
}

int fsync(int fd) {
    faulty(0);
    return NEXT(fsync)(fd);
}

int fdatasync(int fd) {
    faulty(0);
    return NEXT(fdatasync)(fd);
}
