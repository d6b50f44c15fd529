/* fail_write: makes a chosen file call fail, or end the process, to see that nothing torn is left behind.
 *
 *   gcc -shared -fPIC -o libfail_write.so fail_write.c
 *   FONTANA_FAIL_UNDER=/some/folder FONTANA_FAIL_CALL=any:7:ENOSPC LD_PRELOAD=./libfail_write.so program
 *
 * FONTANA_FAIL_CALL  name:k:effect[,name:k:effect...]
 *     name    open, write, writev, fdatasync, fsync, close, rename, link, or any: each of them
 *     k       the k-th such call under the folder, from 1; 0 is every one
 *     effect  an errno, by name or number: the call does nothing (close does close) and reports it
 *             exit: the process ends there, as if killed, with status 86
 *             short: a write does half of its work and reports so; other calls are left alone
 *             log: nothing but the announcement
 * FONTANA_FAIL_UNDER  only calls on this folder (absolute) and what is in it count.
 *
 * Opening a file for reading, and closing it, does not count: nothing is lost by it. An injected fault is announced on
 * stderr. For Linux with glibc. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

enum { max_rules = 4, status_of_exit = 86 };
enum { no_fault = 0, exit_here = -1, short_write = -2 }; /* otherwise an errno */

/* POSIX has no conversion from dlsym's object pointer to a function pointer but this one. */
#define REAL(name)                        \
    static __typeof__(name)* real_##name; \
    if (!real_##name) *(void**)(&real_##name) = dlsym(RTLD_NEXT, #name)

static const struct {
    const char* name;
    int value;
} errno_names[] = {{"EACCES", EACCES},  {"EDQUOT", EDQUOT}, {"EINTR", EINTR},      {"EIO", EIO},
                   {"ENOSPC", ENOSPC},  {"EPERM", EPERM},   {"EROFS", EROFS},      {"EXDEV", EXDEV},
                   {"exit", exit_here}, {"log", no_fault},  {"short", short_write}};

static int parse_effect(const char* text) {
    for (size_t i = 0; i < sizeof errno_names / sizeof errno_names[0]; ++i) {
        if (strcmp(text, errno_names[i].name) == 0) return errno_names[i].value;
    }
    return atoi(text);
}

static void announce(const char* call, long k, const char* effect) {
    char line[128];
    const int length = snprintf(line, sizeof line, "fail_write: call %ld (%s): %s\n", k, call, effect);
    REAL(write);
    if (length > 0) (void)!real_write(STDERR_FILENO, line, (size_t)length);
}

/* Counts this call in every rule that names it; the effect of the rule that is due, if any. */
static int due_fault(const char* call) {
    static atomic_long counts[max_rules];
    const char* rules = getenv("FONTANA_FAIL_CALL");
    if (!rules) return no_fault;
    char copy[256];
    snprintf(copy, sizeof copy, "%s", rules);
    char* rest = copy;
    int fault = no_fault;
    for (int i = 0; i < max_rules && rest; ++i) {
        char* rule = strsep(&rest, ",");
        const char* name = strsep(&rule, ":");
        const char* number = strsep(&rule, ":");
        if (!number || !rule) {
            fprintf(stderr, "fail_write: FONTANA_FAIL_CALL must be name:k:effect, not '%s'\n", rules);
            _exit(2);
        }
        if (strcmp(name, "any") != 0 && strcmp(name, call) != 0) continue;
        const long count = 1 + atomic_fetch_add(&counts[i], 1);
        const long k = atol(number);
        if (fault != no_fault || (k != 0 && k != count)) continue;
        fault = parse_effect(rule);
        announce(call, count, rule);
        if (fault == exit_here) _exit(status_of_exit);
    }
    return fault;
}

static int is_under(const char* path) {
    const char* folder = getenv("FONTANA_FAIL_UNDER");
    if (!folder) return 0;
    const size_t length = strlen(folder);
    return strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

static int path_is_under(const char* path) {
    if (path[0] == '/') return is_under(path);
    char folder[PATH_MAX], absolute[2 * PATH_MAX];
    if (!getcwd(folder, sizeof folder)) return 0;
    snprintf(absolute, sizeof absolute, "%s/%s", folder, path);
    return is_under(absolute);
}

static int descriptor_is_under(int descriptor) {
    char link_path[64], path[PATH_MAX];
    snprintf(link_path, sizeof link_path, "/proc/self/fd/%d", descriptor);
    const ssize_t length = readlink(link_path, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = '\0';
    return is_under(path);
}

/* The errno to fail with, or 0; short_write is passed on only to those who can do it. */
static int path_fault(const char* call, const char* path) {
    const int fault = path_is_under(path) ? due_fault(call) : no_fault;
    return fault == short_write ? no_fault : fault;
}

static int descriptor_fault(const char* call, int descriptor) {
    return descriptor_is_under(descriptor) ? due_fault(call) : no_fault;
}

static int failed(int fault) {
    errno = fault;
    return -1;
}

static int open_fault(const char* path, int flags) {
    if ((flags & O_ACCMODE) == O_RDONLY && !(flags & O_DIRECTORY)) return no_fault;
    return path_fault("open", path);
}

static mode_t mode_argument(int flags, va_list arguments) {
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
}

int open(const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_argument(flags, arguments);
    va_end(arguments);
    const int fault = open_fault(path, flags);
    if (fault) return failed(fault);
    REAL(open);
    return real_open(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_argument(flags, arguments);
    va_end(arguments);
    const int fault = open_fault(path, flags);
    if (fault) return failed(fault);
    REAL(open64);
    return real_open64(path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
    const int fault = descriptor_fault("write", descriptor);
    REAL(write);
    if (fault == short_write) return real_write(descriptor, data, (bytes + 1) / 2);
    return fault ? failed(fault) : real_write(descriptor, data, bytes);
}

ssize_t writev(int descriptor, const struct iovec* pieces, int count) {
    const int fault = descriptor_fault("writev", descriptor);
    REAL(writev);
    if (fault == short_write) return real_writev(descriptor, pieces, (count + 1) / 2);
    return fault ? failed(fault) : real_writev(descriptor, pieces, count);
}

int fdatasync(int descriptor) {
    const int fault = descriptor_fault("fdatasync", descriptor);
    REAL(fdatasync);
    return fault > 0 ? failed(fault) : real_fdatasync(descriptor);
}

int fsync(int descriptor) {
    const int fault = descriptor_fault("fsync", descriptor);
    REAL(fsync);
    return fault > 0 ? failed(fault) : real_fsync(descriptor);
}

int close(int descriptor) {
    const int flags = fcntl(descriptor, F_GETFL);
    const int writes = flags != -1 && (flags & O_ACCMODE) != O_RDONLY;
    const int fault = writes ? descriptor_fault("close", descriptor) : no_fault;
    REAL(close);
    const int result = real_close(descriptor);
    return fault > 0 ? failed(fault) : result;
}

int rename(const char* from, const char* to) {
    const int fault = path_fault("rename", to);
    REAL(rename);
    return fault ? failed(fault) : real_rename(from, to);
}

int link(const char* from, const char* to) {
    const int fault = path_fault("link", to);
    REAL(link);
    return fault ? failed(fault) : real_link(from, to);
}
