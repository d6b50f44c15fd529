/* The C interface as a host in C sees it.
 *
 *   api_test GROUP FOLDER    runs one group of tests, which may write to the (empty) folder
 */
#include "api_test.h"

#include <stdlib.h>
#include <string.h>

atomic_int failed_checks;
const char* test_folder;
const char* const methods[method_count] = {"dfsph", "pcisph", "wcsph", "mueller"};

static int is_one_sentence(const char* text) {
    if (!*text) return 0;
    for (; *text; ++text)
        if ((unsigned char)*text < ' ') return 0;
    return 1;
}

void check_status(fontana_status status, fontana_status expected, const char* part, const char* call, const char* file,
                  int line) {
    const char* sentence = fontana_last_error();
    if (status == expected && (status == FONTANA_OK || (is_one_sentence(sentence) && strstr(sentence, part)))) return;
    fprintf(stderr, "%s:%d: %s: status %d where %d was expected, with '%s' in: %s\n", file, line, call, (int)status,
            (int)expected, part, sentence);
    atomic_fetch_add(&failed_checks, 1);
}

const char* path_of(const char* name) {
    static _Thread_local char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", test_folder, name);
    CHECK(length > 0 && (size_t)length < sizeof path);
    return path;
}

void set_number(fontana_simulation* simulation, const char* name, double value) {
    OK(fontana_set_number(simulation, name, &value, 1));
}

fontana_simulation* make_scene(int threads) {
    fontana_simulation* simulation = NULL;
    OK(fontana_create(&simulation));
    OK(fontana_set_text(simulation, "solver.backend", "cpu"));
    set_number(simulation, "solver.threads", threads);
    set_number(simulation, "time.frame_rate", 240.0);
    fontana_collider ground;
    fontana_collider_defaults(FONTANA_PLANE_Y, &ground);
    OK(fontana_add_collider(simulation, &ground, NULL));
    return simulation;
}

void add_block(fontana_simulation* simulation, int side) {
    const size_t count = (size_t)(side * side * side);
    float* position = malloc(3 * count * sizeof(float));
    CHECK(position != NULL);
    if (!position) return;
    for (size_t i = 0; i < count; ++i) {
        const size_t column[3] = {i % (size_t)side, i / (size_t)side % (size_t)side, i / (size_t)(side * side)};
        for (size_t k = 0; k < 3; ++k)
            position[3 * i + k] = 0.02f * ((float)column[k] + 0.1f * (float)((7 * i + 3 * k) % 5));
    }
    OK(fontana_add_particles(simulation, count, position, NULL, NULL));
    free(position);
}

fontana_simulation* make_fountain(int threads) {
    fontana_simulation* simulation = make_scene(threads);
    fontana_emitter jet;
    fontana_emitter_defaults(FONTANA_DISC, &jet);
    jet.centre[1] = 0.1;
    jet.radius = 0.03;
    jet.speed = 2.0;
    jet.jitter = 0.1;
    OK(fontana_add_emitter(simulation, &jet, NULL));
    add_block(simulation, 4);
    return simulation;
}

fontana_simulation* make_fountain_by(const char* method, int threads) {
    fontana_simulation* simulation = make_fountain(threads);
    OK(fontana_set_text(simulation, "fluid.method", method));
    return simulation;
}

void step_frames(fontana_simulation* simulation, int count) {
    for (int frame = 0; frame < count; ++frame) OK(fontana_step_frame(simulation, NULL));
}

uint64_t state_hash(fontana_simulation* simulation) {
    const size_t particle_count = fontana_particle_count(simulation);
    uint64_t hashes[16] = {(uint64_t)fontana_frame(simulation), particle_count};
    const size_t attribute_count = fontana_attribute_count();
    CHECK(attribute_count + 2 <= 16);
    void* values = malloc(12 * particle_count + 1);
    CHECK(values != NULL);
    for (size_t k = 0; values && k < attribute_count; ++k) {
        const char* name = NULL;
        int components = 0;
        OK(fontana_attribute_info(k, &name, NULL, &components));
        const size_t bytes = 4 * particle_count * (size_t)components;
        OK(fontana_read_attribute(simulation, name, values, bytes));
        hashes[2 + k] = fontana_hash(values, bytes);
    }
    free(values);
    return fontana_hash(hashes, sizeof hashes);
}

int main(int argument_count, char** arguments) {
    const struct {
        const char* name;
        void (*run)(void);
    } groups[] = {
        {"tables", test_tables},
        {"simulation_refusals", test_simulation_refusals},
        {"scene_refusals", test_scene_refusals},
        {"file_refusals", test_file_refusals},
        {"lifecycle", test_lifecycle},
        {"threads", test_threads},
        {"stepping", test_stepping},
        {"checkpoints", test_checkpoints},
    };
    for (size_t k = 0; argument_count == 3 && k < sizeof groups / sizeof groups[0]; ++k) {
        if (strcmp(groups[k].name, arguments[1]) != 0) continue;
        test_folder = arguments[2];
        groups[k].run();
        printf("%s: %d failed checks\n", groups[k].name, atomic_load(&failed_checks));
        return failed_checks ? EXIT_FAILURE : EXIT_SUCCESS;
    }
    fprintf(stderr, "api_test: expected the name of a group of tests and a folder\n");
    return 2;
}
