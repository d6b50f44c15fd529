/* Frames, interruptions, and what may change between frames. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api_test.h"

/* Stops the frame after `calls_left` substeps; asks the simulation questions on the way. */
typedef struct Stop {
    fontana_simulation* simulation;
    int calls_left;
    double last_fraction;
} Stop;

static int count_down(void* user, double frame_fraction) {
    Stop* stop = user;
    CHECK(frame_fraction > stop->last_fraction && frame_fraction <= 1.0);
    stop->last_fraction = frame_fraction;
    float density[1000];
    const size_t count = fontana_particle_count(stop->simulation);
    CHECK(count < 1000);
    OK(fontana_read_attribute(stop->simulation, "density", density, 4 * count));
    return --stop->calls_left == 0;
}

static void an_interrupted_frame_goes_on(const char* method) {
    fontana_simulation *s = make_fountain_by(method, 2), *untouched = make_fountain_by(method, 1);
    set_number(s, "time.cfl_factor", 0.1); /* more substeps to stop after than dfsph would take */
    set_number(untouched, "time.cfl_factor", 0.1);
    Stop stop = {s, 2, 0.0};
    OK(fontana_set_progress(s, count_down, &stop));
    fontana_frame_report report;
    REFUSED(fontana_step_frame(s, &report), FONTANA_INTERRUPTED, "frame 1");
    CHECK(fontana_frame(s) == 0 && stop.last_fraction > 0.0 && stop.last_fraction < 1.0);
    uint32_t neighbors[1000];
    CHECK(fontana_particle_count(s) < 1000);
    OK(fontana_count_neighbors(s, neighbors, fontana_particle_count(s)));
    stop.calls_left = 1;
    REFUSED(fontana_step_frame(s, &report), FONTANA_INTERRUPTED, "frame 1");
    stop.calls_left = 1000000;
    OK(fontana_step_frame(s, &report));
    CHECK(report.frame == 1 && report.substeps > 3 && stop.last_fraction > 0.999999);
    OK(fontana_set_progress(s, NULL, NULL));
    step_frames(untouched, 1);
    CHECK(state_hash(s) == state_hash(untouched));
    step_frames(s, 2);
    step_frames(untouched, 2);
    CHECK(state_hash(s) == state_hash(untouched));
    fontana_destroy(s);
    fontana_destroy(untouched);
}

static int step_again(void* user, double frame_fraction) {
    (void)frame_fraction;
    BAD(fontana_step_frame(user, NULL), "progress");
    BAD(fontana_load_checkpoint(user, path_of("none")), "progress");
    OK(fontana_set_progress(user, NULL, NULL)); /* once is enough */
    return 0;
}

static void a_frame_within_a_frame_is_refused(void) {
    fontana_simulation *s = make_fountain(1), *untouched = make_fountain(1);
    OK(fontana_set_progress(s, step_again, s));
    OK(fontana_step_frame(s, NULL));
    step_frames(untouched, 1);
    CHECK(state_hash(s) == state_hash(untouched));
    fontana_destroy(s);
    fontana_destroy(untouched);
}

static void the_report_tells_the_frame(void) {
    fontana_simulation* s = make_fountain(1);
    set_number(s, "time.substeps", 7.0);
    fontana_frame_report report;
    OK(fontana_step_frame(s, &report));
    CHECK(report.frame == 1 && report.substeps == 7 && strcmp(report.dt_limit, "fixed") == 0);
    CHECK(fabs(report.time - 1.0 / 240.0) < 1e-12 && fabs(report.dt_max - report.time / 7.0) < 1e-12);
    CHECK(report.particle_count == fontana_particle_count(s) && report.max_speed > 1.9);
    fontana_destroy(s);
}

static void particles_come_between_frames(void) {
    fontana_simulation* s = make_scene(2);
    const float fast[3] = {0.0f, -1.0f, 0.0f}, mass = 0.004f;
    for (int frame = 0; frame < 3; ++frame) {
        add_block(s, 3 + 3 * frame); /* beyond the room that was made at first */
        const float position[3] = {0.0f, 1.0f + (float)frame, 0.0f};
        OK(fontana_add_particles(s, 1, position, fast, &mass));
        step_frames(s, 1);
    }
    const size_t count = fontana_particle_count(s);
    CHECK(count == 27 + 216 + 729 + 3);
    int32_t id[975];
    float masses[975];
    OK(fontana_read_attribute(s, "id", id, 4 * count));
    OK(fontana_read_attribute(s, "mass", masses, 4 * count));
    for (size_t k = 0; k < count; ++k) CHECK(id[k] == (int32_t)k);
    CHECK(masses[27] == mass && masses[27 + 1 + 216] == mass && masses[count - 1] == mass && masses[0] != mass);
    fontana_destroy(s);
}

static void forces_follow_their_particles(void) {
    fontana_simulation* s = make_scene(2);
    add_block(s, 3);
    float force[81] = {0.0f}, felt[84];
    force[1] = 5.0f;
    OK(fontana_set_force(s, 27, force));
    const float late[3] = {1.0f, 1.0f, 1.0f};
    OK(fontana_add_particles(s, 1, late, NULL, NULL)); /* without a force until it is set again */
    step_frames(s, 2);
    OK(fontana_read_attribute(s, "force", felt, sizeof felt));
    CHECK(memcmp(felt, force, sizeof force) == 0 && felt[81] == 0.0f && felt[82] == 0.0f && felt[83] == 0.0f);
    OK(fontana_set_force(s, 0, NULL));
    OK(fontana_read_attribute(s, "force", felt, sizeof felt));
    CHECK(felt[1] == 0.0f);
    fontana_destroy(s);
}

static double largest_difference(fontana_simulation* a, fontana_simulation* b) {
    float of_a[192], of_b[192];
    double largest = 0.0;
    OK(fontana_read_attribute(a, "position", of_a, sizeof of_a));
    OK(fontana_read_attribute(b, "position", of_b, sizeof of_b));
    for (int k = 0; k < 192; ++k) largest = fmax(largest, fabs((double)of_a[k] - (double)of_b[k]));
    return largest;
}

static void the_scheme_changes_between_frames(void) {
    fontana_simulation *s = make_scene(2), *untouched = make_scene(1);
    OK(fontana_set_text(s, "fluid.method", "mueller")); /* a solve would end within its tolerance, not closer */
    OK(fontana_set_text(untouched, "fluid.method", "mueller"));
    add_block(s, 4);
    add_block(untouched, 4);
    const char* scheme[] = {"all-pairs", "grid", "all-pairs", "grid"};
    for (int frame = 0; frame < 4; ++frame) {
        OK(fontana_set_text(s, "solver.neighbors", scheme[frame]));
        step_frames(s, 1);
    }
    step_frames(untouched, 4);
    CHECK(largest_difference(s, untouched) < 1e-5); /* the sums have other orders */
    fontana_destroy(s);
    fontana_destroy(untouched);
}

/* So does the backend, with everything it holds: here to another number of threads and back. */
static void the_backend_changes_between_frames(const char* method) {
    fontana_simulation *s = make_fountain_by(method, 1), *untouched = make_fountain_by(method, 1);
    float force[192] = {0.0f};
    force[0] = 0.1f;
    OK(fontana_set_force(s, 64, force));
    OK(fontana_set_force(untouched, 64, force));
    for (int frame = 0; frame < 4; ++frame) {
        set_number(s, "solver.threads", 1.0 + frame);
        step_frames(s, 1);
    }
    step_frames(untouched, 4);
    CHECK(state_hash(s) == state_hash(untouched));
    fontana_destroy(s);
    fontana_destroy(untouched);
}

static void an_unstable_frame_is_not_finished(void) {
    fontana_simulation* s = make_scene(2);
    const float position[6] = {0.0f, 1.0f, 0.0f, 0.0f, 1.0f, 1.0f}, velocity[6] = {3e38f, 3e38f, -3e38f};
    OK(fontana_add_particles(s, 2, position, velocity, NULL));
    REFUSED(fontana_step_frame(s, NULL), FONTANA_UNSTABLE, "");
    set_number(s, "time.substeps", 2.0);
    REFUSED(fontana_step_frame(s, NULL), FONTANA_UNSTABLE, "");
    REFUSED(fontana_step_frame(s, NULL), FONTANA_UNSTABLE, "");
    CHECK(fontana_frame(s) == 0);
    uint32_t neighbors[2];
    OK(fontana_count_neighbors(s, neighbors, 2));
    fontana_destroy(s);
}

/* Leaves memory that holds no numbers where the next call's stack will lie. */
static void stain_the_stack(void) {
    volatile float stain[16384];
    for (int k = 0; k < 16384; ++k) stain[k] = NAN;
    CHECK(isnan(stain[16383]));
}

/* A loop over vectors of particles must not let through what its last vector was never given. Density by eq. 2.8 weighs
 * every lane, so it shows: 0 times what is no number is none. */
static void what_lay_on_the_stack_is_in_no_sum(void) {
    fontana_simulation* s = make_scene(1);
    OK(fontana_set_text(s, "fluid.method", "mueller"));
    add_block(s, 6);
    for (int frame = 0; frame < 3; ++frame) {
        stain_the_stack();
        OK(fontana_step_frame(s, NULL));
    }
    fontana_destroy(s);
}

void test_stepping(void) {
    for (int k = 0; k < method_count; ++k) {
        an_interrupted_frame_goes_on(methods[k]);
        the_backend_changes_between_frames(methods[k]);
    }
    a_frame_within_a_frame_is_refused();
    the_report_tells_the_frame();
    particles_come_between_frames();
    forces_follow_their_particles();
    the_scheme_changes_between_frames();
    an_unstable_frame_is_not_finished();
    what_lay_on_the_stack_is_in_no_sum();
}
