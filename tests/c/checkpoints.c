/* Checkpoints through the C interface; what is in the file is tests/io's concern. */
#include <stdlib.h>
#include <string.h>

#include "api_test.h"

static const char state_path[] = "state.checkpoint";

/* A fountain some frames old, with forces; the checkpoint is left in the folder. */
static fontana_simulation* saved_fountain(const char* method) {
    fontana_simulation* s = make_fountain_by(method, 2);
    float force[192] = {0.0f};
    force[3] = 0.01f;
    OK(fontana_set_force(s, 64, force));
    step_frames(s, 3);
    OK(fontana_save_checkpoint(s, path_of(state_path), "fountain"));
    return s;
}

static void a_run_continues_bit_for_bit(const char* method) {
    fontana_simulation *s = saved_fountain(method), *resumed = make_fountain_by(method, 3);
    int64_t frame = 0;
    uint64_t particle_count = 0;
    char tag[16];
    OK(fontana_checkpoint_info(path_of(state_path), &frame, &particle_count, tag, sizeof tag));
    CHECK(frame == 3 && particle_count == fontana_particle_count(s) && strcmp(tag, "fountain") == 0);

    step_frames(resumed, 1); /* whatever it did before does not matter */
    OK(fontana_load_checkpoint(resumed, path_of(state_path)));
    CHECK(fontana_frame(resumed) == 3 && state_hash(resumed) == state_hash(s));
    step_frames(s, 3);
    step_frames(resumed, 3);
    CHECK(fontana_particle_count(s) > particle_count && state_hash(resumed) == state_hash(s));
    fontana_destroy(s);
    fontana_destroy(resumed);
}

/* The file, or NULL; the caller frees it. */
static unsigned char* read_file(const char* path, size_t* bytes) {
    FILE* file = fopen(path, "rb");
    CHECK(file != NULL);
    if (!file) return NULL;
    unsigned char* content = malloc(1 << 20);
    *bytes = content ? fread(content, 1, 1 << 20, file) : 0;
    CHECK(content && *bytes < 1 << 20);
    fclose(file);
    return content;
}

/* Not by the library: plain stdio, so that nothing is kept or checked on the way. */
static void write_file(const char* path, const unsigned char* content, size_t bytes) {
    FILE* file = fopen(path, "wb");
    CHECK(file && fwrite(content, 1, bytes, file) == bytes && fclose(file) == 0);
}

static void damage_changes_nothing(void) {
    fontana_simulation *s = saved_fountain("mueller"), *twin = make_fountain_by("mueller", 1);
    OK(fontana_load_checkpoint(twin, path_of(state_path)));
    const uint64_t before = state_hash(s);
    size_t bytes = 0;
    unsigned char* content = read_file(path_of(state_path), &bytes);
    if (!content) return;
    for (size_t k = 0; k < bytes; k += 1 + bytes / 200) {
        content[k] ^= 0x40;
        write_file(path_of("damaged.checkpoint"), content, bytes);
        content[k] ^= 0x40;
        BAD(fontana_load_checkpoint(s, path_of("damaged.checkpoint")), "damaged.checkpoint");
        write_file(path_of("damaged.checkpoint"), content, k);
        BAD(fontana_load_checkpoint(s, path_of("damaged.checkpoint")), "damaged.checkpoint");
        BAD(fontana_checkpoint_info(path_of("damaged.checkpoint"), NULL, NULL, NULL, 0), "damaged.checkpoint");
    }
    free(content);
    CHECK(state_hash(s) == before);
    step_frames(s, 2);
    step_frames(twin, 2);
    CHECK(state_hash(s) == state_hash(twin));
    fontana_destroy(s);
    fontana_destroy(twin);
}

/* A state in memory is a checkpoint without a file: it may be taken and put back any number of times. */
static void a_state_in_memory_continues(const char* method) {
    fontana_simulation* s = saved_fountain(method);
    const void* data = NULL;
    size_t bytes = 0;
    OK(fontana_save_state(s, &data, &bytes));
    void* kept = malloc(bytes);
    CHECK(kept != NULL);
    if (!kept) return;
    memcpy(kept, data, bytes);
    const uint64_t then = state_hash(s);
    step_frames(s, 3);
    const uint64_t later = state_hash(s);
    for (int k = 0; k < 2; ++k) {
        OK(fontana_load_state(s, kept, bytes));
        CHECK(fontana_frame(s) == 3 && state_hash(s) == then);
        step_frames(s, 3);
        CHECK(state_hash(s) == later);
    }
    free(kept);
    fontana_destroy(s);
}

static void a_damaged_state_changes_nothing(void) {
    fontana_simulation* s = saved_fountain("mueller");
    const uint64_t before = state_hash(s);
    const void* data = NULL;
    size_t bytes = 0;
    OK(fontana_save_state(s, &data, &bytes));
    unsigned char* copy = malloc(bytes);
    CHECK(copy != NULL);
    if (!copy) return;
    memcpy(copy, data, bytes);
    for (size_t k = 0; k < bytes; k += 1 + bytes / 200) {
        copy[k] ^= 0x40;
        BAD(fontana_load_state(s, copy, bytes), "the state in memory");
        copy[k] ^= 0x40;
        BAD(fontana_load_state(s, copy, k), "the state in memory");
    }
    for (size_t k = bytes - 16; k < bytes; ++k) { /* the footer */
        copy[k] ^= 0x01;
        BAD(fontana_load_state(s, copy, bytes), "the state in memory");
        copy[k] ^= 0x01;
    }
    BAD(fontana_load_state(s, NULL, 0), "the state in memory");
    BAD(fontana_load_state(s, NULL, bytes), "data");
    BAD(fontana_save_state(s, NULL, &bytes), "data");
    BAD(fontana_save_state(s, &data, NULL), "bytes");
    free(copy);
    CHECK(state_hash(s) == before);
    fontana_destroy(s);
}

/* Back to the beginning, and from there to another scene. */
static void a_state_without_particles(void) {
    fontana_simulation *s = make_scene(1), *twin = make_scene(1);
    const void* data = NULL;
    size_t bytes = 0;
    OK(fontana_save_state(s, &data, &bytes));
    OK(fontana_load_state(s, data, bytes));
    add_block(s, 4);
    step_frames(s, 2);
    OK(fontana_load_state(s, data, bytes));
    CHECK(fontana_particle_count(s) == 0 && fontana_frame(s) == 0);
    OK(fontana_load_state(twin, data, bytes)); /* which has no buffers yet */
    add_block(s, 3);
    add_block(twin, 3);
    step_frames(s, 2);
    step_frames(twin, 2);
    CHECK(fontana_particle_count(s) == 27 && state_hash(s) == state_hash(twin));
    fontana_destroy(s);
    fontana_destroy(twin);
}

static void another_scene_is_refused(void) {
    fontana_destroy(saved_fountain("mueller"));
    fontana_simulation* s = make_scene(1); /* without the emitter */
    add_block(s, 3);
    step_frames(s, 1);
    const uint64_t before = state_hash(s);
    BAD(fontana_load_checkpoint(s, path_of(state_path)), "emitters");
    CHECK(fontana_frame(s) == 1 && state_hash(s) == before);
    step_frames(s, 1);
    fontana_destroy(s);
}

static void there_are_two_generations(void) {
    char previous[4096];
    snprintf(previous, sizeof previous, "%s.previous", path_of(state_path));
    fontana_simulation* s = saved_fountain("mueller");
    step_frames(s, 1);
    OK(fontana_save_checkpoint(s, path_of(state_path), NULL));
    int64_t newest = 0, older = 0;
    char tag[16] = "x";
    OK(fontana_checkpoint_info(path_of(state_path), &newest, NULL, tag, sizeof tag));
    CHECK(newest == 4 && strcmp(tag, "") == 0);
    OK(fontana_checkpoint_info(previous, &older, NULL, tag, sizeof tag));
    CHECK(older == 3 && strcmp(tag, "fountain") == 0);
    fontana_destroy(s);
}

void test_checkpoints(void) {
    for (int k = 0; k < method_count; ++k) {
        a_run_continues_bit_for_bit(methods[k]);
        a_state_in_memory_continues(methods[k]);
    }
    a_damaged_state_changes_nothing();
    a_state_without_particles();
    damage_changes_nothing();
    another_scene_is_refused();
    there_are_two_generations();
}
