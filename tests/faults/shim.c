/* Calls of the system that fail on request, preloaded before the program that is tested.

   FAULT_KIND    files: calls that change files in FAULT_FOLDER; heap: allocations of FAULT_LEAST bytes and more
   FAULT_AT      the call that fails, from 1; 0 for none
   FAULT_MODE    once: that call; from: that one and all later ones; exit: at that call the process calls exit(-1), as a library may;
                 terminate: the call is made, and SIGTERM comes after it, with time for whoever waits for that (files)
   FAULT_ERRNO   what it fails with (files)
   FAULT_COUNT   a file to which the number of calls is written when the process ends
*/
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static atomic_long n_calls;
static long at, least;
static int from, exits, terminates, error = EIO, kind;
static char folder[4096];
enum { NOTHING, FILES, HEAP };

__attribute__((constructor)) static void start(void) {
    const char *text = getenv("FAULT_KIND");
    if (!text) return;
    if ((getenv("FAULT_FOLDER"))) strncpy(folder, getenv("FAULT_FOLDER"), sizeof folder - 1);
    at = getenv("FAULT_AT") ? atol(getenv("FAULT_AT")) : 0;
    least = getenv("FAULT_LEAST") ? atol(getenv("FAULT_LEAST")) : 1;
    from = getenv("FAULT_MODE") && !strcmp(getenv("FAULT_MODE"), "from");
    exits = getenv("FAULT_MODE") && !strcmp(getenv("FAULT_MODE"), "exit");
    terminates = getenv("FAULT_MODE") && !strcmp(getenv("FAULT_MODE"), "terminate");
    if (getenv("FAULT_ERRNO")) error = atoi(getenv("FAULT_ERRNO"));
    kind = !strcmp(text, "heap") ? HEAP : FILES;
}

__attribute__((destructor)) static void end(void) {
    const char *path = getenv("FAULT_COUNT");
    kind = NOTHING;
    if (!path) return;
    char text[32];
    int length = snprintf(text, sizeof text, "%ld\n", (long)n_calls);
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file >= 0) {
        if (write(file, text, length) < 0) { }
        close(file);
    }
}

static int fails(void) {
    long call = ++n_calls;
    if (exits && call == at) exit(-1);
    return at && !exits && !terminates && (from ? call >= at : call == at);
}

/* ---- files ---- */

static int inside(const char *path) { return kind == FILES && folder[0] && !strncmp(path, folder, strlen(folder)); }

static int inside_fd(int fd) {
    char link[64], path[4096];
    if (kind != FILES) return 0;
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length <= 0) return 0;
    path[length] = 0;
    return inside(path);
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
/* A call that fails or not, with a signal after it or not. */
#define CALL(is_counted, call) { \
    int counted = (is_counted); \
    if (counted && fails()) { errno = error; return -1; } \
    __typeof__(call) done = (call); \
    if (counted && terminates && n_calls == at) { kill(getpid(), SIGTERM); usleep(50000); } \
    return done; \
}

int rename(const char *a, const char *b) CALL(inside(b), NEXT(rename)(a, b))
int link(const char *a, const char *b) CALL(inside(b), NEXT(link)(a, b))
int linkat(int x, const char *a, int y, const char *b, int f) CALL(inside(b), NEXT(linkat)(x, a, y, b, f))
int unlink(const char *a) CALL(inside(a), NEXT(unlink)(a))
int fsync(int fd) CALL(inside_fd(fd), NEXT(fsync)(fd))
ssize_t write(int fd, const void *b, size_t n) CALL(inside_fd(fd), NEXT(write)(fd, b, n))
int open64(const char *path, int flags, ...) {
    int changes = (flags & (O_CREAT | O_WRONLY | O_RDWR)) != 0;
    va_list rest;
    va_start(rest, flags);
    mode_t mode = va_arg(rest, int);
    va_end(rest);
    CALL(changes && inside(path), ((int (*)(const char *, int, ...))dlsym(RTLD_NEXT, "open64"))(path, flags, mode))
}

/* ---- heap ---- */

static int refused(size_t size) { return kind == HEAP && (long)size >= least && fails(); }

void *malloc(size_t n) { if (refused(n)) { errno = ENOMEM; return NULL; } return __libc_malloc(n); }
void *calloc(size_t m, size_t n) { if (refused(m * n)) { errno = ENOMEM; return NULL; } return __libc_calloc(m, n); }
void *realloc(void *p, size_t n) { if (refused(n)) { errno = ENOMEM; return NULL; } return __libc_realloc(p, n); }
int posix_memalign(void **p, size_t a, size_t n) {
    if (refused(n)) return ENOMEM;
    *p = __libc_memalign(a, n);
    return *p ? 0 : ENOMEM;
}
void *aligned_alloc(size_t a, size_t n) { if (refused(n)) { errno = ENOMEM; return NULL; } return __libc_memalign(a, n); }
