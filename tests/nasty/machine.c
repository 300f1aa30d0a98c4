/* A machine that lets a program down, loaded before it:
 *
 *   DISK_FULL_FROM=N   the Nth write to a file, from 0, and all that follow find no space
 *   WRITES_TO=FILE     where to tell how many writes there were, when the program ends
 *   CLOCK_BACK=1       the time of day goes back an hour with each look
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static atomic_long writes;
static atomic_long looks;

static long full_from(void)
{
    const char *text = getenv("DISK_FULL_FROM");
    return text ? atol(text) : -1;
}

/* Whether a write to this descriptor finds no space. */
static int full(int file)
{
    struct stat about;
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode))
        return 0;
    long before = atomic_fetch_add(&writes, 1), from = full_from();
    if (from < 0 || before < from)
        return 0;
    errno = ENOSPC;
    return 1;
}

#define FORWARD(result, name, parameters, arguments, file)                  \
    result name parameters                                                  \
    {                                                                       \
        static result(*original) parameters;                                \
        if (!original)                                                      \
            original = (result(*) parameters)dlsym(RTLD_NEXT, #name);       \
        return full(file) ? -1 : original arguments;                        \
    }

FORWARD(ssize_t, write, (int file, const void *from, size_t size), (file, from, size), file)
FORWARD(ssize_t, writev, (int file, const struct iovec *parts, int count), (file, parts, count), file)
FORWARD(ssize_t, pwrite, (int file, const void *from, size_t size, off_t at), (file, from, size, at), file)
FORWARD(ssize_t, pwrite64, (int file, const void *from, size_t size, off64_t at), (file, from, size, at), file)
FORWARD(ssize_t, copy_file_range, (int in, off64_t *from, int out, off64_t *to, size_t size, unsigned flags),
        (in, from, out, to, size, flags), out)
FORWARD(ssize_t, sendfile, (int out, int in, off_t *from, size_t size), (out, in, from, size), out)
FORWARD(ssize_t, sendfile64, (int out, int in, off64_t *from, size_t size), (out, in, from, size), out)

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static int (*original)(clockid_t, struct timespec *);
    if (!original)
        original = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
    int answer = original(clock, now);
    if (clock == CLOCK_REALTIME && getenv("CLOCK_BACK"))
        now->tv_sec -= 3600 * atomic_fetch_add(&looks, 1);
    return answer;
}

__attribute__((destructor)) static void tell(void)
{
    const char *path = getenv("WRITES_TO");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file)
        return;
    fprintf(file, "%ld", atomic_load(&writes));
    fclose(file);
}
