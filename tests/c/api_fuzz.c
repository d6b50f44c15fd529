/* Random sequences of calls, each with arguments that are mostly wrong somewhere: no call may crash, hang, end without
 * a status, fail without a sentence, or find a defect in the library (FONTANA_INTERNAL).
 *
 *   api_fuzz SEED COUNT FOLDER    runs the sequences SEED to SEED + COUNT - 1; a failure prints the one to run alone
 *
 * Two things are kept from the calls: pointers that are neither null nor good, and scenes that are merely large. */
#include <fontana.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { longest_sequence = 64, most_particles = 64, most_substeps = 20, most_threads = 3, handle_count = 3 };

typedef struct Fuzzer {
    uint64_t random;
    fontana_simulation* handles[handle_count]; /* null where destroyed or not yet made */
    char log[2 * longest_sequence][64];
    int log_length;
    const char* folder;
    unsigned long seed;
} Fuzzer;

/* splitmix64 */
static uint64_t random_bits(Fuzzer* f) {
    uint64_t z = (f->random += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static size_t below(Fuzzer* f, size_t bound) { return (size_t)(random_bits(f) % bound); }

#define ONE_OF(f, table) (table)[below(f, sizeof(table) / sizeof(table)[0])]

/* Null now and then. */
#define MAYBE(f, pointer) (below(f, 12) == 0 ? NULL : (pointer))

static double any_number(Fuzzer* f) {
    static const double special[] = {0.0,    -0.0, 1.0,  -1.0,  0.5,  2.0,   3.0,      1e-3,      0.02, 100.0,
                                     1e-320, 1e9,  1e38, 1e300, -1e9, -1e38, INFINITY, -INFINITY, NAN,  4294967296.0};
    if (below(f, 3) != 0) return ONE_OF(f, special);
    return (double)(int64_t)random_bits(f) * 0x1p-62;
}

static float any_float(Fuzzer* f) {
    static const float special[] = {0.0f, -0.0f, 1.0f, 1e-45f, 1e30f, -1e30f, 3e38f, INFINITY, NAN};
    if (below(f, 10) == 0) return ONE_OF(f, special);
    return (float)((double)(int64_t)random_bits(f) * 0x1p-65);
}

static size_t any_size(Fuzzer* f) {
    static const size_t special[] = {
        0, 1, 2, 3, 4, 12, 63, 64, 65, 1000, SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 3, SIZE_MAX / 12};
    return ONE_OF(f, special);
}

static int64_t any_frame(Fuzzer* f) {
    static const int64_t special[] = {0, 1, 2, 10, -1, INT32_MAX, INT64_MAX, INT64_MIN};
    return ONE_OF(f, special);
}

static const char* any_name(Fuzzer* f) {
    static const char* const other[] = {
        "",           "position", "fluid", "fluid.viscosity ", "Fluid.viscosity", "a\nb",
        "%s%n%1000d", "\xff\xfe", "poly6", "solver.backend",   "thesis",          "density"};
    if (below(f, 4) == 0) return ONE_OF(f, other);
    fontana_parameter row;
    fontana_parameter_info(below(f, fontana_parameter_count()), &row);
    return row.name;
}

static const char* any_text(Fuzzer* f) {
    static const char* const texts[] = {"cpu",   "grid",   "all-pairs", "fast",   "strict",   "mueller",
                                        "wcsph", "pcisph", "dfsph",     "jacobi", "wendland", "anderson",
                                        "final", "custom", "thesis",    "",       "mullr",    "a\nb"};
    return ONE_OF(f, texts);
}

static const char* any_path(Fuzzer* f) {
    static _Thread_local char path[4096];
    static const char* const names[] = {"a", "a", "a", "a", "a.previous", "b", "b.bgeo", "missing/file", "", "."};
    snprintf(path, sizeof path, "%s/%s", f->folder, ONE_OF(f, names));
    return path;
}

static void fail(const Fuzzer* f, const char* what) {
    for (int k = 0; k < f->log_length; ++k) fprintf(stderr, "  %s\n", f->log[k]);
    fprintf(stderr, "api_fuzz: %s: %s (run again: api_fuzz %lu 1 FOLDER)\n", what, fontana_last_error(), f->seed);
    exit(EXIT_FAILURE);
}

static void expect_status(Fuzzer* f, const char* call, fontana_status status) {
    if (f->log_length < 2 * longest_sequence)
        snprintf(f->log[f->log_length++], sizeof f->log[0], "%s: %d", call, (int)status);
    if (status == FONTANA_OK) return;
    if ((int)status < 0 || status >= FONTANA_INTERNAL) fail(f, "a defect, or no status");
    const char* text = fontana_last_error();
    if (!*text) fail(f, "an error without a sentence");
    for (; *text; ++text)
        if ((unsigned char)*text < ' ') fail(f, "a sentence of several lines");
}
#define CALL(f, call, ...) expect_status(f, #call, fontana_##call(__VA_ARGS__))

/* Null now and then. */
static fontana_simulation* any_handle(Fuzzer* f) {
    fontana_simulation* handle = NULL;
    for (int attempt = 0; !handle && attempt < 3; ++attempt) handle = f->handles[below(f, handle_count)];
    return handle;
}

/* ---- the calls ------------------------------------------------------------------------------------------------ */

static void create(Fuzzer* f) {
    const size_t k = below(f, handle_count);
    fontana_destroy(f->handles[k]);
    f->handles[k] = NULL;
    CALL(f, create, &f->handles[k]);
    const double threads = (double)(1 + below(f, most_threads)), substeps = most_substeps, frame_rate = 400.0;
    CALL(f, set_text, f->handles[k], "solver.backend", "cpu");
    CALL(f, set_number, f->handles[k], "solver.threads", &threads, 1);
    CALL(f, set_number, f->handles[k], "time.max_substeps", &substeps, 1);
    CALL(f, set_number, f->handles[k], "time.frame_rate", &frame_rate, 1);
}

static void destroy(Fuzzer* f) {
    const size_t k = below(f, handle_count);
    fontana_destroy(f->handles[k]);
    f->handles[k] = NULL;
}

/* A number of particles, substeps, iterations or threads that is allowed, but takes for ever or all of the machine. */
static int is_merely_large(const char* name, double value) {
    if (strcmp(name, "fluid.particle_spacing") == 0) return value > 0.0 && value < 0.01;
    if (strcmp(name, "time.simulation_scale") == 0) return value > 1.0 && value < 1e5;
    if (strcmp(name, "solver.max_iterations") == 0) return value > most_substeps;
    if (strcmp(name, "time.substeps") == 0 || strcmp(name, "time.max_substeps") == 0) return value > most_substeps;
    return strcmp(name, "solver.threads") == 0 && (value > most_threads || value == 0.0);
}

static void set_number(Fuzzer* f) {
    const char* name = any_name(f);
    const double values[3] = {any_number(f), any_number(f), any_number(f)};
    if (is_merely_large(name, values[0])) return;
    static const size_t counts[] = {1, 1, 1, 3, 3, 0, 2, SIZE_MAX};
    CALL(f, set_number, any_handle(f), MAYBE(f, name), MAYBE(f, values), ONE_OF(f, counts));
}

/* A method and another word: most pairs of names and words fit nowhere. */
static void set_text(Fuzzer* f) {
    static const char* const methods[] = {"mueller", "wcsph", "pcisph", "dfsph"};
    const char *name = any_name(f), *text = any_text(f), *method = ONE_OF(f, methods);
    CALL(f, set_text, any_handle(f), "fluid.method", method);
    CALL(f, set_text, any_handle(f), MAYBE(f, name), MAYBE(f, text));
}

static void read_parameters(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    fontana_parameter row;
    double values[3];
    const char* text = NULL;
    fontana_derived derived;
    CALL(f, parameter_info, any_size(f), MAYBE(f, &row));
    CALL(f, get_number, s, MAYBE(f, any_name(f)), MAYBE(f, values), 1 + 2 * below(f, 2));
    CALL(f, get_text, s, MAYBE(f, any_name(f)), MAYBE(f, &text));
    CALL(f, derive, s, MAYBE(f, &derived));
    CALL(f, check, s);
}

static void apply_preset(Fuzzer* f) { CALL(f, apply_preset, any_handle(f), MAYBE(f, any_text(f))); }

static void fill_point(Fuzzer* f, double* point) {
    for (int k = 0; k < 3; ++k) point[k] = any_number(f);
}

static void change_colliders(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    fontana_collider collider;
    fontana_collider_defaults((fontana_collider_type)below(f, 9), &collider);
    if (below(f, 2)) fill_point(f, collider.centre);
    if (below(f, 2)) fill_point(f, collider.velocity);
    if (below(f, 2)) collider.radius = any_number(f);
    if (below(f, 3) == 0) collider.thickness = any_number(f);
    if (below(f, 3) == 0) collider.cutoff = any_number(f);
    if (below(f, 3) == 0) collider.elasticity = any_number(f);
    collider.flip = (int)below(f, 3) - 1;
    size_t index = 0;
    if (below(f, 2))
        CALL(f, add_collider, s, MAYBE(f, &collider), MAYBE(f, &index));
    else
        CALL(f, set_collider, s, below(f, 4), MAYBE(f, &collider));
}

static void change_keys(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    double time[4], centre[12], at[3];
    for (int k = 0; k < 4; ++k) {
        time[k] = below(f, 4) ? 0.01 * k : any_number(f);
        fill_point(f, centre + 3 * k);
    }
    const size_t index = below(f, 4), count = below(f, 5);
    CALL(f, set_collider_keys, s, index, count, MAYBE(f, time), MAYBE(f, centre));
    CALL(f, collider_centre, s, below(f, 4), any_number(f), MAYBE(f, at));
}

static void add_particles(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    float position[3 * 16], velocity[3 * 16], mass[16];
    for (int k = 0; k < 3 * 16; ++k) {
        position[k] = any_float(f);
        velocity[k] = any_float(f);
    }
    for (int k = 0; k < 16; ++k) mass[k] = below(f, 4) ? 0.008f : any_float(f);
    size_t count = any_size(f);
    /* Sizes beyond all ids are refused before the arrays are looked at; others must be true. */
    if (count < UINT32_MAX && (count > 16 || fontana_particle_count(s) + count > most_particles)) count = below(f, 4);
    CALL(f, add_particles, s, count, MAYBE(f, position), MAYBE(f, velocity), MAYBE(f, mass));
}

static void add_emitter(Fuzzer* f) {
    fontana_emitter emitter;
    fontana_emitter_defaults((fontana_emitter_type)below(f, 4), &emitter);
    emitter.radius = 0.03;
    emitter.size[0] = emitter.size[1] = emitter.size[2] = 0.05;
    if (below(f, 4) == 0) fill_point(f, emitter.centre);
    if (below(f, 4) == 0) fill_point(f, emitter.size);
    if (below(f, 4) == 0) fill_point(f, emitter.direction);
    if (below(f, 4) == 0) fill_point(f, emitter.velocity);
    if (below(f, 4) == 0) emitter.radius = any_number(f);
    if (below(f, 4) == 0) emitter.speed = any_number(f);
    if (below(f, 4) == 0) emitter.rate = any_number(f);
    if (below(f, 4) == 0) emitter.jitter = any_number(f);
    if (below(f, 4) == 0) emitter.first_frame = (int)random_bits(f);
    if (below(f, 4) == 0) emitter.last_frame = (int)random_bits(f);
    size_t index = 0;
    CALL(f, add_emitter, any_handle(f), MAYBE(f, &emitter), MAYBE(f, &index));
}

static void set_force(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    float force[3 * most_particles];
    for (int k = 0; k < 3 * most_particles; ++k) force[k] = any_float(f);
    const size_t particle_count = fontana_particle_count(s);
    const size_t count = particle_count <= most_particles && below(f, 2) ? particle_count : any_size(f);
    if (count == particle_count && count > most_particles) return;
    CALL(f, set_force, s, count, MAYBE(f, force));
}

static void read_attributes(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    const size_t count = fontana_particle_count(s);
    uint32_t* room = malloc(12 * count + 12);
    if (!room) return;
    const char* name = any_name(f);
    int components = 3;
    if (below(f, 4)) CALL(f, attribute_info, below(f, fontana_attribute_count()), &name, NULL, &components);
    const size_t right = 4 * count * (size_t)components, wrong = any_size(f);
    CALL(f, read_attribute, s, MAYBE(f, name), MAYBE(f, room), below(f, 4) || wrong <= 12 ? right : wrong);
    CALL(f, count_neighbors, s, MAYBE(f, room), below(f, 4) ? count : count + 1);
    free(room);
}

static void estimate(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    fontana_time_step_limits limits;
    uint64_t count = 0;
    CALL(f, estimate_limits, s, any_number(f), any_number(f), MAYBE(f, &limits));
    CALL(f, estimate_memory, s, any_size(f), MAYBE(f, &count));
    CALL(f, emitted_by, s, any_frame(f), MAYBE(f, &count));
    double value = 0.0;
    static const char* const kernels[] = {"poly6", "spiky", "viscosity", "cubic"};
    static const char* const quantities[] = {"value", "gradient", "laplacian", "curl"};
    const char *kernel = ONE_OF(f, kernels), *quantity = ONE_OF(f, quantities);
    CALL(f, smoothing_kernel, MAYBE(f, kernel), MAYBE(f, quantity), any_number(f), any_number(f), MAYBE(f, &value));
}

static int stop_sometimes(void* user, double frame_fraction) {
    (void)frame_fraction;
    return below(user, 4) == 0;
}

static void step(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    uint64_t due = 0;
    if (s && fontana_emitted_by(s, fontana_frame(s) + 1, &due) == FONTANA_OK && due > most_particles) return;
    fontana_frame_report report;
    CALL(f, set_progress, s, below(f, 2) ? stop_sometimes : NULL, f);
    CALL(f, step_frame, s, MAYBE(f, &report));
}

static void files(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    int64_t frame = 0;
    uint64_t count = 0;
    char tag[8];
    switch (below(f, 5)) {
        case 0:
            CALL(f, save_checkpoint, s, MAYBE(f, any_path(f)), MAYBE(f, any_text(f)));
            break;
        case 1:
            CALL(f, load_checkpoint, s, MAYBE(f, any_path(f)));
            break;
        case 2:
            CALL(f, checkpoint_info, MAYBE(f, any_path(f)), MAYBE(f, &frame), &count, MAYBE(f, tag), below(f, 9));
            break;
        case 3:
            CALL(f, write_bgeo, s, MAYBE(f, any_path(f)));
            break;
        default:
            CALL(f, publish_file, MAYBE(f, any_path(f)), MAYBE(f, "FONTANA"), below(f, 9), &count);
            break;
    }
}

static void device(Fuzzer* f) {
    fontana_simulation* s = any_handle(f);
    fontana_device in_use, chosen;
    const fontana_kernel_profile* rows = NULL;
    size_t count = 0;
    double speed;
    CALL(f, choose_device, MAYBE(f, any_text(f)), MAYBE(f, &chosen));
    CALL(f, device_in_use, s, MAYBE(f, &in_use));
    CALL(f, read_profile, s, MAYBE(f, &rows), MAYBE(f, &count));
    CALL(f, measure_copy, s, below(f, 99), MAYBE(f, &speed));
}

/* What earlier sequences left would make this one another. */
static void remove_files(const Fuzzer* f) {
    static const char* const names[] = {"a",          "b",      "a.previous",     "a.previous.previous",
                                        "b.previous", "b.bgeo", "b.bgeo.previous"};
    char path[4096];
    for (size_t k = 0; k < sizeof names / sizeof names[0]; ++k) {
        snprintf(path, sizeof path, "%s/%s", f->folder, names[k]);
        remove(path);
    }
}

static void run_sequence(Fuzzer* f) {
    remove_files(f);
    static void (*const calls[])(Fuzzer*) = {
        create,      create,        destroy,       set_number,
        set_number,  set_number,    set_text,      read_parameters,
        step,        step,          step,          files,
        files,       device,        estimate,      read_attributes,
        change_keys, add_particles, add_particles, change_colliders,
        set_force,   add_emitter,   apply_preset,
    };
    create(f);
    const size_t length = 1 + below(f, longest_sequence);
    for (size_t k = 0; k < length; ++k) ONE_OF(f, calls)(f);
    for (int k = 0; k < handle_count; ++k) {
        fontana_destroy(f->handles[k]);
        f->handles[k] = NULL;
    }
}

int main(int argument_count, char** arguments) {
    if (argument_count != 4) {
        fprintf(stderr, "api_fuzz: expected a seed, a count and a folder\n");
        return 2;
    }
    const unsigned long first = strtoul(arguments[1], NULL, 10), count = strtoul(arguments[2], NULL, 10);
    for (unsigned long seed = first; seed < first + count; ++seed) {
        Fuzzer fuzzer = {.random = seed, .folder = arguments[3], .seed = seed};
        run_sequence(&fuzzer);
    }
    printf("%lu sequences\n", count);
    return EXIT_SUCCESS;
}
