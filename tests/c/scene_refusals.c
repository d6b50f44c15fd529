/* Colliders, emitters, particles and files that cannot be. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api_test.h"

static const double not_finite[] = {NAN, INFINITY, -INFINITY};

/* A valid value at `field` of a struct is replaced by each bad one in turn. */
#define EACH_BAD_COLLIDER(s, collider, field, bad, count)              \
    do {                                                               \
        const fontana_collider valid = collider;                       \
        for (size_t each = 0; each < (count); ++each) {                \
            collider.field = (bad)[each];                              \
            BAD(fontana_add_collider(s, &collider, NULL), "collider"); \
            BAD(fontana_set_collider(s, 0, &collider), "collider");    \
        }                                                              \
        collider = valid;                                              \
    } while (0)

#define EACH_BAD_EMITTER(s, emitter, field, bad, count)             \
    do {                                                            \
        const fontana_emitter valid = emitter;                      \
        for (size_t each = 0; each < (count); ++each) {             \
            emitter.field = (bad)[each];                            \
            BAD(fontana_add_emitter(s, &emitter, NULL), "emitter"); \
        }                                                           \
        emitter = valid;                                            \
    } while (0)

static void refuse_colliders(fontana_simulation* s) {
    fontana_collider sphere;
    fontana_collider_defaults(FONTANA_SPHERE_OUTSIDE, &sphere);
    const double not_above_0[] = {0.0, -1.0, NAN}, not_a_share[] = {-0.1, 1.1, NAN, INFINITY};
    EACH_BAD_COLLIDER(s, sphere, centre[0], not_finite, 3);
    EACH_BAD_COLLIDER(s, sphere, velocity[2], not_finite, 3);
    EACH_BAD_COLLIDER(s, sphere, radius, not_finite, 3);
    EACH_BAD_COLLIDER(s, sphere, radius, not_above_0, 3);
    EACH_BAD_COLLIDER(s, sphere, thickness, not_above_0, 3);
    EACH_BAD_COLLIDER(s, sphere, cutoff, not_finite, 1);
    EACH_BAD_COLLIDER(s, sphere, elasticity, not_a_share, 4);
    EACH_BAD_COLLIDER(s, sphere, friction, not_a_share, 4);
    const fontana_collider_type unknown[] = {(fontana_collider_type)7, (fontana_collider_type)-1};
    EACH_BAD_COLLIDER(s, sphere, type, unknown, 2);
    fontana_collider_defaults((fontana_collider_type)99, &sphere);
    BAD(fontana_add_collider(s, &sphere, NULL), "unknown type");

    CHECK(fontana_collider_count(s) == 1);
    fontana_collider_defaults(FONTANA_PLANE_Y, &sphere);
    double centre[3] = {0.0, 0.0, 0.0};
    for (size_t index = 1; index != 0; index = index == 1 ? SIZE_MAX : 0) {
        BAD(fontana_set_collider(s, index, &sphere), "no collider");
        BAD(fontana_set_collider_keys(s, index, 0, NULL, NULL), "no collider");
        BAD(fontana_collider_centre(s, index, 0.0, centre), "no collider");
    }
}

static void refuse_keys(fontana_simulation* s) {
    const double time[3] = {0.0, 1.0, 2.0}, centre[9] = {0.0};
    OK(fontana_set_collider_keys(s, 0, 3, time, centre));
    OK(fontana_set_collider_keys(s, 0, 0, NULL, NULL));
    BAD(fontana_set_collider_keys(s, 0, SIZE_MAX, time, centre), "keys");
    BAD(fontana_set_collider_keys(s, 0, SIZE_MAX / 24, time, centre), "keys");
    for (size_t k = 0; k < 3; ++k) {
        const double bad_time[3] = {0.0, not_finite[k], 2.0};
        double bad_centre[9] = {0.0};
        bad_centre[8] = not_finite[k];
        BAD(fontana_set_collider_keys(s, 0, 3, bad_time, centre), "finite");
        BAD(fontana_set_collider_keys(s, 0, 3, time, bad_centre), "finite");
    }
    const double equal[2] = {1.0, 1.0}, falling[2] = {1.0, 0.0};
    BAD(fontana_set_collider_keys(s, 0, 2, equal, centre), "ascend");
    BAD(fontana_set_collider_keys(s, 0, 2, falling, centre), "ascend");
    double at[3];
    for (size_t k = 0; k < 3; ++k) BAD(fontana_collider_centre(s, 0, not_finite[k], at), "time");
}

static void refuse_emitters(fontana_simulation* s) {
    fontana_emitter block, disc;
    fontana_emitter_defaults(FONTANA_BLOCK, &block);
    fontana_emitter_defaults(FONTANA_DISC, &disc);
    const double not_above_0[] = {0.0, -1.0, NAN, INFINITY}, negative[] = {-1.0, NAN, INFINITY};
    const double not_a_jitter[] = {-0.1, 0.6, NAN, INFINITY};
    const int not_a_frame[] = {0, -1, INT32_MIN};
    const fontana_emitter_type unknown[] = {(fontana_emitter_type)3, (fontana_emitter_type)-1};
    EACH_BAD_EMITTER(s, block, centre[1], not_finite, 3);
    EACH_BAD_EMITTER(s, block, velocity[0], not_finite, 3);
    EACH_BAD_EMITTER(s, block, size[2], not_above_0, 4);
    EACH_BAD_EMITTER(s, block, jitter, not_a_jitter, 4);
    EACH_BAD_EMITTER(s, block, first_frame, not_a_frame, 3);
    EACH_BAD_EMITTER(s, block, last_frame, not_a_frame, 3);
    EACH_BAD_EMITTER(s, block, type, unknown, 2);
    EACH_BAD_EMITTER(s, disc, radius, not_above_0, 4);
    EACH_BAD_EMITTER(s, disc, speed, not_above_0, 4);
    EACH_BAD_EMITTER(s, disc, rate, negative, 3);
    EACH_BAD_EMITTER(s, disc, direction[0], not_finite, 3);
    disc.direction[1] = 0.0;
    BAD(fontana_add_emitter(s, &disc, NULL), "direction");
}

/* More particles than ids can count are refused before any memory is asked for. */
static void refuse_floods(void) {
    const int64_t frames[] = {INT64_MIN, -1, 0, 1, INT64_MAX};
    for (int type = FONTANA_BLOCK; type <= FONTANA_DISC; ++type) {
        fontana_simulation* s = make_scene(1);
        fontana_emitter flood;
        fontana_emitter_defaults((fontana_emitter_type)type, &flood);
        flood.radius = flood.size[0] = flood.size[1] = flood.size[2] = 1e6;
        OK(fontana_add_emitter(s, &flood, NULL));
        uint64_t count = 1;
        OK(fontana_emitted_by(s, 0, &count));
        CHECK(count == 0);
        for (size_t k = 0; k < 5; ++k)
            if (frames[k] > 0) BAD(fontana_emitted_by(s, frames[k], &count), "particles");
        BAD(fontana_step_frame(s, NULL), "particles");
        CHECK(fontana_frame(s) == 0 && fontana_particle_count(s) == 0);
        fontana_destroy(s);
    }
    fontana_simulation* s = make_scene(1);
    fontana_emitter torrent;
    fontana_emitter_defaults(FONTANA_DISC, &torrent);
    torrent.radius = 0.05;
    torrent.speed = 1e11;
    OK(fontana_add_emitter(s, &torrent, NULL));
    set_number(s, "time.substeps", 2.0); /* it floods after the first */
    uint64_t count = 0;
    BAD(fontana_emitted_by(s, INT64_MAX, &count), "particles");
    BAD(fontana_step_frame(s, NULL), "particles");
    CHECK(fontana_particle_count(s) < 100);
    fontana_destroy(s);
}

/* So are more than the device can hold: an operating system may promise memory that it does not have. */
static void refuse_more_than_fits(void) {
    fontana_simulation* s = make_scene(1);
    fontana_device device;
    OK(fontana_device_in_use(s, &device));
    const double count = (double)device.memory_bytes / 100.0; /* a particle takes more than 100 bytes */
    if (count == 0.0 || count > 1e9) {
        printf("the device is too large to be overfilled\n");
    } else {
        fontana_emitter flood;
        fontana_emitter_defaults(FONTANA_BLOCK, &flood);
        flood.size[0] = 0.02 * count;
        flood.size[1] = flood.size[2] = 0.02;
        OK(fontana_add_emitter(s, &flood, NULL));
        REFUSED(fontana_step_frame(s, NULL), FONTANA_OUT_OF_MEMORY, "MiB");
    }
    fontana_destroy(s);
}

static void refuse_particles(fontana_simulation* s) {
    const float origin[3] = {0.0f, 0.5f, 0.0f};
    const float not_finite_float[] = {NAN, INFINITY, -INFINITY}, not_a_mass[] = {0.0f, -1.0f, NAN, INFINITY};
    const size_t before = fontana_particle_count(s);
    for (size_t k = 0; k < 3; ++k) {
        const float bad[3] = {0.0f, 0.0f, not_finite_float[k]};
        BAD(fontana_add_particles(s, 1, bad, NULL, NULL), "position");
        BAD(fontana_add_particles(s, 1, origin, bad, NULL), "velocity");
    }
    for (size_t k = 0; k < 4; ++k) BAD(fontana_add_particles(s, 1, origin, NULL, &not_a_mass[k]), "mass");
    const size_t absurd[] = {SIZE_MAX, SIZE_MAX / 3, SIZE_MAX / 12 + 1, SIZE_MAX / 2, (size_t)UINT32_MAX + 1};
    for (size_t k = 0; k < 5; ++k) {
        BAD(fontana_add_particles(s, absurd[k], origin, NULL, NULL), "particles");
        BAD(fontana_set_force(s, absurd[k], origin), "particles");
    }
    OK(fontana_add_particles(s, 0, NULL, NULL, NULL));
    CHECK(fontana_particle_count(s) == before);
    float* force = calloc(3 * before, sizeof(float));
    CHECK(force != NULL);
    if (!force) return;
    BAD(fontana_set_force(s, before - 1, force), "particles");
    force[3 * before - 1] = NAN;
    BAD(fontana_set_force(s, before, force), "force");
    free(force);
    OK(fontana_set_force(s, before, NULL));
    /* Finite in the scene, but not in metres. */
    set_number(s, "time.simulation_scale", 1e6);
    const float far[3] = {1e38f, 0.0f, 0.0f};
    BAD(fontana_add_particles(s, 1, far, NULL, NULL), "position");
    set_number(s, "time.simulation_scale", 1.0);
}

static void refuse_rooms(fontana_simulation* s) {
    const size_t count = fontana_particle_count(s);
    float* room = malloc(12 * count + 4);
    CHECK(room != NULL);
    if (!room) return;
    const size_t wrong[] = {0, 4, 12 * count - 4, 12 * count + 4, SIZE_MAX};
    for (size_t k = 0; k < 5; ++k) BAD(fontana_read_attribute(s, "position", room, wrong[k]), "bytes");
    BAD(fontana_read_attribute(s, "density", room, 12 * count), "bytes");
    BAD(fontana_read_attribute(s, "positon", room, 12 * count), "'position'");
    BAD(fontana_read_attribute(s, "", room, 12 * count), "no attribute");
    uint32_t* neighbors = (uint32_t*)(void*)room;
    BAD(fontana_count_neighbors(s, neighbors, count - 1), "as many");
    BAD(fontana_count_neighbors(s, neighbors, SIZE_MAX), "as many");
    OK(fontana_count_neighbors(s, neighbors, count));
    free(room);
}

void test_scene_refusals(void) {
    fontana_simulation* s = make_scene(1);
    refuse_colliders(s);
    refuse_keys(s);
    refuse_emitters(s);
    add_block(s, 4);
    refuse_particles(s);
    refuse_rooms(s);
    fontana_simulation* untouched = make_scene(1);
    add_block(untouched, 4);
    step_frames(s, 2);
    step_frames(untouched, 2);
    CHECK(state_hash(s) == state_hash(untouched));
    fontana_destroy(untouched);
    fontana_destroy(s);
    refuse_floods();
    refuse_more_than_fits();
}

void test_file_refusals(void) {
    fontana_simulation* s = make_fountain(1);
    BAD(fontana_write_bgeo(s, NULL), "path must not be null");
    BAD(fontana_save_checkpoint(s, NULL, "tag"), "path must not be null");
    BAD(fontana_load_checkpoint(s, NULL), "path must not be null");
    BAD(fontana_checkpoint_info(NULL, NULL, NULL, NULL, 0), "path must not be null");
    BAD(fontana_publish_file(NULL, "x", 1, NULL), "path must not be null");
    BAD(fontana_publish_file(path_of("file"), NULL, 1, NULL), "data must not be null");
    CHECK(fontana_hash(NULL, 0) == fontana_hash("", 0) && fontana_hash(NULL, 1) == fontana_hash("", 0));
    const char* nowhere[] = {"", "/", path_of("no/such/folder/file")};
    for (size_t k = 0; k < 3; ++k) {
        REFUSED(fontana_write_bgeo(s, nowhere[k]), FONTANA_IO_ERROR, nowhere[k]);
        REFUSED(fontana_save_checkpoint(s, nowhere[k], ""), FONTANA_IO_ERROR, nowhere[k]);
        REFUSED(fontana_publish_file(nowhere[k], "x", 1, NULL), FONTANA_IO_ERROR, nowhere[k]);
        REFUSED(fontana_load_checkpoint(s, nowhere[k]), FONTANA_IO_ERROR, nowhere[k]);
        REFUSED(fontana_checkpoint_info(nowhere[k], NULL, NULL, NULL, 0), FONTANA_IO_ERROR, nowhere[k]);
    }
    char* long_tag = malloc(((size_t)1 << 20) + 2);
    CHECK(long_tag != NULL);
    if (long_tag) {
        memset(long_tag, 't', ((size_t)1 << 20) + 1);
        long_tag[((size_t)1 << 20) + 1] = '\0';
        BAD(fontana_save_checkpoint(s, path_of("tag.checkpoint"), long_tag), "tag");
    }
    free(long_tag);

    OK(fontana_save_checkpoint(s, path_of("tag.checkpoint"), "four"));
    char tag[5];
    for (size_t room = 0; room < 5; ++room)
        BAD(fontana_checkpoint_info(path_of("tag.checkpoint"), NULL, NULL, tag, room), "5 bytes");
    OK(fontana_checkpoint_info(path_of("tag.checkpoint"), NULL, NULL, tag, 5));
    CHECK(strcmp(tag, "four") == 0);
    OK(fontana_checkpoint_info(path_of("tag.checkpoint"), NULL, NULL, NULL, 0));

    uint64_t hash = 0;
    OK(fontana_publish_file(path_of("file"), "content", 7, &hash));
    CHECK(hash == fontana_hash("content", 7));
    OK(fontana_publish_file(path_of("file"), NULL, 0, NULL));
    fontana_destroy(s);
}
