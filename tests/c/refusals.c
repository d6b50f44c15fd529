/* What no call takes: null pointers, unknown names, wrong counts, numbers that are none, sizes beyond reason. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api_test.h"

static const double not_finite[] = {NAN, INFINITY, -INFINITY};

void test_tables(void) {
    CHECK(strlen(fontana_version()) > 0);
    CHECK(fontana_abi_version() == FONTANA_ABI_VERSION);
    CHECK(strcmp(fontana_last_error(), "") == 0);

    fontana_parameter row;
    CHECK(fontana_parameter_count() > 0);
    for (size_t k = 0; k < fontana_parameter_count(); ++k) {
        OK(fontana_parameter_info(k, &row));
        CHECK(strlen(row.name) > 0 && strlen(row.label) > 0 && strlen(row.doc) > 0 && row.minimum <= row.maximum);
    }
    BAD(fontana_parameter_info(0, NULL), "out must not be null");
    BAD(fontana_parameter_info(fontana_parameter_count(), &row), "no parameter");
    BAD(fontana_parameter_info(SIZE_MAX, &row), "no parameter");

    CHECK(fontana_attribute_count() > 0);
    for (size_t k = 0; k < fontana_attribute_count(); ++k) OK(fontana_attribute_info(k, NULL, NULL, NULL));
    BAD(fontana_attribute_info(fontana_attribute_count(), NULL, NULL, NULL), "no attribute");
    BAD(fontana_attribute_info(SIZE_MAX, NULL, NULL, NULL), "no attribute");

    const fontana_device* devices = NULL;
    size_t count = 0;
    OK(fontana_list_devices(&devices, &count));
    for (size_t k = 0; k < count; ++k) {
        CHECK(devices[k].available || strlen(devices[k].reason) > 0);
        CHECK(!devices[k].available || strstr(devices[k].neighbors, "grid"));
    }
    CHECK(count > 0);
    fontana_device chosen;
    OK(fontana_choose_device("cpu", &chosen));
    CHECK(chosen.available && strcmp(chosen.backend, "cpu") == 0);
    BAD(fontana_choose_device("gpu", &chosen), "no backend 'gpu': expected auto, cpu, cuda or opencl");
    BAD(fontana_choose_device(NULL, &chosen), "backend must not be null");
    BAD(fontana_choose_device("auto", NULL), "out must not be null");
    BAD(fontana_list_devices(NULL, &count), "devices must not be null");
    BAD(fontana_list_devices(&devices, NULL), "count must not be null");

    double value = 0.0;
    OK(fontana_smoothing_kernel("poly6", "value", 0.01, 0.04, &value));
    BAD(fontana_smoothing_kernel(NULL, "value", 0.01, 0.04, &value), "kernel must not be null");
    BAD(fontana_smoothing_kernel("poly6", NULL, 0.01, 0.04, &value), "quantity must not be null");
    BAD(fontana_smoothing_kernel("poly6", "value", 0.01, 0.04, NULL), "out must not be null");
    BAD(fontana_smoothing_kernel("poly7", "value", 0.01, 0.04, &value), "poly7");
    BAD(fontana_smoothing_kernel("poly6", "curl", 0.01, 0.04, &value), "curl");
    BAD(fontana_smoothing_kernel("poly6", "value", -0.01, 0.04, &value), "r must be");
    BAD(fontana_smoothing_kernel("poly6", "value", 0.01, 0.0, &value), "support radius");
    for (size_t k = 0; k < 3; ++k) {
        BAD(fontana_smoothing_kernel("poly6", "value", not_finite[k], 0.04, &value), "r must be");
        BAD(fontana_smoothing_kernel("poly6", "value", 0.01, not_finite[k], &value), "support radius");
    }
}

static void refuse_null_simulation(void) {
    const double number = 1.0;
    double numbers[3];
    const char* text = NULL;
    uint64_t big = 0;
    size_t size = 0;
    const float point[3] = {0.0f, 0.0f, 0.0f};
    fontana_collider collider;
    fontana_emitter emitter;
    fontana_derived derived;
    fontana_device device;
    fontana_time_step_limits limits;
    const fontana_kernel_profile* rows = NULL;
    fontana_collider_defaults(FONTANA_PLANE_Y, &collider);
    fontana_emitter_defaults(FONTANA_BLOCK, &emitter);
    static const char part[] = "the simulation must not be null";

    BAD(fontana_set_number(NULL, "fluid.viscosity", &number, 1), part);
    BAD(fontana_get_number(NULL, "fluid.viscosity", numbers, 1), part);
    BAD(fontana_set_text(NULL, "solver.backend", "cpu"), part);
    BAD(fontana_get_text(NULL, "solver.backend", &text), part);
    BAD(fontana_apply_preset(NULL, "thesis"), part);
    BAD(fontana_derive(NULL, &derived), part);
    BAD(fontana_add_collider(NULL, &collider, &size), part);
    BAD(fontana_set_collider(NULL, 0, &collider), part);
    BAD(fontana_set_collider_keys(NULL, 0, 1, &number, numbers), part);
    BAD(fontana_collider_centre(NULL, 0, 0.0, numbers), part);
    BAD(fontana_add_particles(NULL, 1, point, NULL, NULL), part);
    BAD(fontana_set_force(NULL, 1, point), part);
    BAD(fontana_add_emitter(NULL, &emitter, &size), part);
    BAD(fontana_emitted_by(NULL, 1, &big), part);
    BAD(fontana_read_attribute(NULL, "position", numbers, 12), part);
    BAD(fontana_set_progress(NULL, NULL, NULL), part);
    BAD(fontana_step_frame(NULL, NULL), part);
    BAD(fontana_estimate_limits(NULL, 1.0, 1.0, &limits), part);
    BAD(fontana_estimate_memory(NULL, 1, &big), part);
    BAD(fontana_check(NULL), part);
    BAD(fontana_device_in_use(NULL, &device), part);
    BAD(fontana_read_profile(NULL, &rows, &size), part);
    BAD(fontana_measure_copy(NULL, 16, numbers), part);
    BAD(fontana_write_bgeo(NULL, "x.bgeo"), part);
    BAD(fontana_save_checkpoint(NULL, "x.checkpoint", NULL), part);
    BAD(fontana_load_checkpoint(NULL, "x.checkpoint"), part);
    BAD(fontana_count_neighbors(NULL, NULL, 0), part);
    CHECK(fontana_collider_count(NULL) == 0 && fontana_particle_count(NULL) == 0 && fontana_frame(NULL) == 0);
    fontana_destroy(NULL);
}

static void refuse_null_arguments(fontana_simulation* s) {
    const double number = 1.0;
    double numbers[3];
    size_t size = 0;
    const fontana_kernel_profile* rows = NULL;
    BAD(fontana_create(NULL), "out must not be null");
    BAD(fontana_set_number(s, NULL, &number, 1), "name must not be null");
    BAD(fontana_set_number(s, "fluid.viscosity", NULL, 1), "values must not be null");
    BAD(fontana_get_number(s, NULL, numbers, 1), "name must not be null");
    BAD(fontana_get_number(s, "fluid.viscosity", NULL, 1), "values must not be null");
    BAD(fontana_set_text(s, NULL, "cpu"), "name must not be null");
    BAD(fontana_set_text(s, "solver.backend", NULL), "text must not be null");
    BAD(fontana_get_text(s, "solver.backend", NULL), "text must not be null");
    BAD(fontana_apply_preset(s, NULL), "preset must not be null");
    BAD(fontana_derive(s, NULL), "out must not be null");
    BAD(fontana_add_collider(s, NULL, &size), "collider must not be null");
    BAD(fontana_set_collider(s, 0, NULL), "collider must not be null");
    BAD(fontana_set_collider_keys(s, 0, 1, NULL, numbers), "time must not be null");
    BAD(fontana_set_collider_keys(s, 0, 1, &number, NULL), "centre must not be null");
    BAD(fontana_collider_centre(s, 0, 0.0, NULL), "centre must not be null");
    BAD(fontana_add_particles(s, 1, NULL, NULL, NULL), "position must not be null");
    BAD(fontana_add_emitter(s, NULL, &size), "emitter must not be null");
    BAD(fontana_emitted_by(s, 1, NULL), "count must not be null");
    BAD(fontana_read_attribute(s, NULL, numbers, 12), "name must not be null");
    BAD(fontana_read_attribute(s, "position", NULL, 12 * fontana_particle_count(s)), "out must not be null");
    BAD(fontana_estimate_limits(s, 1.0, 1.0, NULL), "out must not be null");
    BAD(fontana_estimate_memory(s, 1, NULL), "bytes must not be null");
    BAD(fontana_device_in_use(s, NULL), "out must not be null");
    BAD(fontana_read_profile(s, NULL, &size), "rows must not be null");
    BAD(fontana_read_profile(s, &rows, NULL), "count must not be null");
    BAD(fontana_measure_copy(s, 16, NULL), "bytes_per_second must not be null");
    BAD(fontana_measure_copy(s, 15, numbers), "16 bytes to 64 GiB, not with 15");
    BAD(fontana_count_neighbors(s, NULL, fontana_particle_count(s)), "out must not be null");
    fontana_collider_defaults(FONTANA_PLANE_Y, NULL);
    fontana_emitter_defaults(FONTANA_BLOCK, NULL);
}

static void refuse_names_and_texts(fontana_simulation* s) {
    double numbers[4] = {1.0, 1.0, 1.0, 1.0};
    const char* text = NULL;
    BAD(fontana_set_number(s, "fluid.viscosty", numbers, 1), "fluid.viscosity");
    BAD(fontana_get_number(s, "", numbers, 1), "no parameter ''");
    BAD(fontana_set_text(s, "solver.backnd", "cpu"), "solver.backend");
    BAD(fontana_get_text(s, "solver.backnd", &text), "solver.backend");
    BAD(fontana_set_text(s, "solver.neighbors", "gird"), "grid");
    BAD(fontana_set_text(s, "solver.backend", ""), "expected one of");
    BAD(fontana_set_text(s, "fluid.viscosity", "2"), "expected a number");
    BAD(fontana_get_text(s, "fluid.viscosity", &text), "number");
    BAD(fontana_set_number(s, "solver.backend", numbers, 1), "not a number");
    BAD(fontana_get_number(s, "solver.backend", numbers, 1), "not a number");
    BAD(fontana_apply_preset(s, "thesys"), "thesis");
    /* The caller's text is quoted, but the sentence stays one line of UTF-8. */
    BAD(fontana_set_number(s, "two\nlines\t\x1b[31m", numbers, 1), "two");
    BAD(fontana_set_text(s, "solver.backend", "c\xffpu\xc3"), "expected one of");
    CHECK(!strchr(fontana_last_error(), '\xff'));
    char* endless = malloc(1000001);
    CHECK(endless != NULL);
    if (!endless) return;
    memset(endless, 'x', 1000000);
    endless[1000000] = '\0';
    BAD(fontana_set_text(s, "solver.backend", endless), "expected one of");
    BAD(fontana_read_attribute(s, endless, numbers, 12), "no attribute");
    CHECK(strlen(fontana_last_error()) < 10000);
    free(endless);
}

static void refuse_numbers(fontana_simulation* s) {
    double numbers[4] = {1.0, 1.0, 1.0, 1.0};
    const size_t wrong_for_one[] = {0, 2, 3, SIZE_MAX}, wrong_for_three[] = {0, 1, 2, 4, SIZE_MAX};
    for (size_t k = 0; k < 4; ++k) {
        BAD(fontana_set_number(s, "fluid.viscosity", numbers, wrong_for_one[k]), "one number");
        BAD(fontana_get_number(s, "fluid.viscosity", numbers, wrong_for_one[k]), "one number");
    }
    for (size_t k = 0; k < 5; ++k) {
        BAD(fontana_set_number(s, "forces.gravity", numbers, wrong_for_three[k]), "three numbers");
        BAD(fontana_get_number(s, "forces.gravity", numbers, wrong_for_three[k]), "three numbers");
    }
    for (size_t k = 0; k < 3; ++k) {
        numbers[2] = not_finite[k];
        BAD(fontana_set_number(s, "fluid.viscosity", &not_finite[k], 1), "finite");
        BAD(fontana_set_number(s, "time.substeps", &not_finite[k], 1), "finite");
        BAD(fontana_set_number(s, "solver.profile", &not_finite[k], 1), "finite");
        BAD(fontana_set_number(s, "forces.gravity", numbers, 3), "finite");
    }
    const double half = 0.5, huge = 1e300, below = -1.0;
    BAD(fontana_set_number(s, "time.substeps", &half, 1), "whole number");
    BAD(fontana_set_number(s, "solver.profile", &half, 1), "solver.profile");
    BAD(fontana_set_number(s, "time.substeps", &huge, 1), "out of range");
    BAD(fontana_set_number(s, "fluid.particle_mass", &below, 1), "out of range");
    OK(fontana_get_number(s, "forces.gravity", numbers, 3));
    CHECK(numbers[1] == -9.81);

    fontana_time_step_limits limits;
    uint64_t bytes = 0;
    for (size_t k = 0; k < 3; ++k) {
        BAD(fontana_estimate_limits(s, not_finite[k], 1.0, &limits), "speed");
        BAD(fontana_estimate_limits(s, 1.0, not_finite[k], &limits), "acceleration");
    }
    BAD(fontana_estimate_limits(s, -1.0, 1.0, &limits), "speed");
    OK(fontana_estimate_memory(s, 1000, &bytes));
    CHECK(bytes > 100000);
    BAD(fontana_estimate_memory(s, UINT64_MAX, &bytes), "particles");
    BAD(fontana_estimate_memory(s, UINT64_MAX / 200, &bytes), "particles");
}

/* Neither may take for ever: the sum over a lattice stops where it is an integral. */
static void derive_with_extreme_radii(void) {
    fontana_simulation* s = make_scene(1);
    fontana_derived derived;
    set_number(s, "fluid.particle_spacing", 1e-4);
    set_number(s, "fluid.support_radius", 1e3);
    OK(fontana_derive(s, &derived));
    CHECK(fabs(derived.particle_mass / (1000.0 * 1e-12) - 1.0) < 1e-3);
    set_number(s, "fluid.particle_spacing", 1e3);
    set_number(s, "fluid.support_radius", 1e-3);
    OK(fontana_derive(s, &derived));
    CHECK(derived.particle_mass > 0.0);
    fontana_destroy(s);
}

void test_simulation_refusals(void) {
    refuse_null_simulation();
    fontana_simulation* s = make_fountain(1);
    refuse_null_arguments(s);
    refuse_names_and_texts(s);
    refuse_numbers(s);
    fontana_simulation* untouched = make_fountain(1);
    step_frames(s, 2);
    step_frames(untouched, 2);
    CHECK(state_hash(s) == state_hash(untouched));
    fontana_destroy(untouched);
    fontana_destroy(s);
    derive_with_extreme_radii();
}
