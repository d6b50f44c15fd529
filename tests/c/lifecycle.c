/* Making, mixing and ending simulations; one thread and several. */
#include <pthread.h>
#include <string.h>

#include "api_test.h"

static void create_and_destroy(void) {
    for (int k = 0; k < 1000; ++k) {
        fontana_simulation* simulation = NULL;
        OK(fontana_create(&simulation));
        if (k % 100 == 0) add_block(simulation, 2);
        fontana_destroy(simulation);
    }
}

static void an_empty_simulation_works(void) {
    fontana_simulation* s = make_scene(2);
    fontana_frame_report report;
    OK(fontana_count_neighbors(s, NULL, 0));
    OK(fontana_read_attribute(s, "position", NULL, 0));
    OK(fontana_step_frame(s, &report));
    CHECK(report.frame == 1 && report.particle_count == 0 && report.kinetic_energy == 0.0);
    OK(fontana_write_bgeo(s, path_of("empty.bgeo")));
    OK(fontana_save_checkpoint(s, path_of("empty.checkpoint"), NULL));
    add_block(s, 2);
    OK(fontana_load_checkpoint(s, path_of("empty.checkpoint")));
    CHECK(fontana_particle_count(s) == 0 && fontana_frame(s) == 1);
    fontana_destroy(s);
}

static void interleaved_simulations_do_not_mix(void) {
    fontana_simulation *a = make_fountain(2), *b = make_scene(1), *a_alone = make_fountain(1), *b_alone = make_scene(2);
    set_number(b, "fluid.viscosity", 5.0);
    set_number(b_alone, "fluid.viscosity", 5.0);
    add_block(b, 5);
    add_block(b_alone, 5);
    for (int frame = 0; frame < 4; ++frame) {
        step_frames(a, 1);
        step_frames(b, 1);
    }
    step_frames(a_alone, 4);
    step_frames(b_alone, 4);
    CHECK(state_hash(a) == state_hash(a_alone));
    CHECK(state_hash(b) == state_hash(b_alone));
    CHECK(state_hash(a) != state_hash(b));
    fontana_destroy(a);
    fontana_destroy(b);
    fontana_destroy(a_alone);
    fontana_destroy(b_alone);
}

/* A returned string lives until the next call on its simulation, whatever others do. */
static void texts_belong_to_their_simulation(void) {
    fontana_simulation *a = make_scene(1), *b = make_scene(1);
    const char *of_a = NULL, *of_b = NULL;
    OK(fontana_set_text(b, "solver.neighbors", "all-pairs"));
    OK(fontana_get_text(a, "solver.neighbors", &of_a));
    OK(fontana_get_text(b, "solver.neighbors", &of_b));
    CHECK(strcmp(of_a, "grid") == 0 && strcmp(of_b, "all-pairs") == 0);
    fontana_destroy(b);
    CHECK(strcmp(of_a, "grid") == 0);
    fontana_destroy(a);
}

void test_lifecycle(void) {
    create_and_destroy();
    an_empty_simulation_works();
    interleaved_simulations_do_not_mix();
    texts_belong_to_their_simulation();
}

enum { thread_count = 3 };
static pthread_barrier_t all_have_failed;

static void* fail_in_own_words(void* number) {
    char name[32];
    snprintf(name, sizeof name, "no.such.name.%d", *(const int*)number);
    CHECK(strcmp(fontana_last_error(), "") == 0);
    fontana_simulation* simulation = make_scene(1);
    BAD(fontana_set_text(simulation, name, "x"), name);
    pthread_barrier_wait(&all_have_failed);
    CHECK(strstr(fontana_last_error(), name));
    fontana_destroy(simulation);
    CHECK(strstr(fontana_last_error(), name));
    return NULL;
}

static void* run_fountain(void* hash) {
    fontana_simulation* simulation = make_fountain_by("dfsph", 3);
    add_block(simulation, 11); /* more than one piece for the threads of the backend */
    step_frames(simulation, 2);
    *(uint64_t*)hash = state_hash(simulation);
    fontana_destroy(simulation);
    return NULL;
}

static void on_all_threads(void* (*work)(void*), void* arguments, size_t argument_bytes) {
    pthread_t threads[thread_count];
    for (int k = 0; k < thread_count; ++k)
        CHECK(pthread_create(&threads[k], NULL, work, (char*)arguments + (size_t)k * argument_bytes) == 0);
    for (int k = 0; k < thread_count; ++k) CHECK(pthread_join(threads[k], NULL) == 0);
}

void test_threads(void) {
    BAD(fontana_check(NULL), "simulation");
    int numbers[thread_count] = {1, 2, 3};
    CHECK(pthread_barrier_init(&all_have_failed, NULL, thread_count) == 0);
    on_all_threads(fail_in_own_words, numbers, sizeof numbers[0]);
    CHECK(strstr(fontana_last_error(), "simulation"));
    pthread_barrier_destroy(&all_have_failed);

    uint64_t hashes[thread_count] = {0}, alone = 0;
    on_all_threads(run_fountain, hashes, sizeof hashes[0]);
    run_fountain(&alone);
    for (int k = 0; k < thread_count; ++k) CHECK(hashes[k] == alone);
}
