/* A host that loads the library, uses it and lets go of it, a hundred times in one process.
 *
 *   unload_test LIBRARY
 *
 * Each round uses it on a thread that ends before: what a library keeps for a thread, here the last error, holds the
 * library in memory as long. */
#include <dirent.h>
#include <dlfcn.h>
#include <fontana.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { round_count = 100 };

static void fail(const char* what) {
    fprintf(stderr, "unload_test: %s\n", what);
    exit(EXIT_FAILURE);
}

/* POSIX has no conversion from dlsym's object pointer to a function pointer but this one. */
#define FIND(function)                                           \
    __typeof__(&fontana_##function) function;                    \
    *(void**)(&function) = dlsym(library, "fontana_" #function); \
    if (!function) fail("fontana_" #function " is missing")

static int thread_count(void) {
    DIR* tasks = opendir("/proc/self/task");
    if (!tasks) return 0; /* not Linux: not counted */
    int count = 0;
    for (const struct dirent* entry; (entry = readdir(tasks)) != NULL;) count += entry->d_name[0] != '.';
    closedir(tasks);
    return count;
}

static void* use(void* library) {
    FIND(create);
    FIND(destroy);
    FIND(set_text);
    FIND(set_number);
    FIND(add_emitter);
    FIND(emitter_defaults);
    FIND(step_frame);
    FIND(last_error);

    const int threads_before = thread_count();
    const double threads = 3.0, frame_rate = 1000.0;
    fontana_simulation* simulation = NULL;
    fontana_emitter block;
    emitter_defaults(FONTANA_BLOCK, &block);
    block.size[0] = block.size[1] = block.size[2] = 0.2; /* enough particles for more than one thread */
    if (create(&simulation) || set_text(simulation, "solver.backend", "cpu") ||
        set_number(simulation, "solver.threads", &threads, 1) ||
        set_number(simulation, "time.frame_rate", &frame_rate, 1) || add_emitter(simulation, &block, NULL) ||
        step_frame(simulation, NULL))
        fail(last_error());
    if (set_text(simulation, "no.such.name", "") != FONTANA_BAD_INPUT) fail("a wrong name was accepted");
    destroy(simulation);
    /* A thread that was joined may stay in the system's list for a moment. */
    for (int wait = 0; thread_count() > threads_before; ++wait) {
        if (wait == 1000) fail("threads outlive their simulation");
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    }
    return NULL;
}

int main(int argument_count, char** arguments) {
    if (argument_count != 2) fail("expected the path of the library");
    for (int round = 0; round < round_count; ++round) {
        void* library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
        if (!library) fail(dlerror());
        pthread_t thread;
        if (pthread_create(&thread, NULL, use, library)) fail("cannot start a thread");
        pthread_join(thread, NULL);
        if (dlclose(library)) fail(dlerror());
        if (dlopen(arguments[1], RTLD_NOW | RTLD_NOLOAD)) fail("the library is still in memory");
    }
    printf("loaded and unloaded %d times\n", round_count);
    return EXIT_SUCCESS;
}
