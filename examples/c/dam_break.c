/* A dam break through the C interface: a block of fluid falls apart in a tank with a floor and four walls.
 *
 *   dam_break [FOLDER]    writes dam_break.0001.bgeo and so on to FOLDER, by default the present one
 */
#include <fontana.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { frame_count = 12 };

/* Ends the program with the library's sentence unless a call succeeded. */
static void require_ok(fontana_status status) {
    if (status == FONTANA_OK) return;
    fprintf(stderr, "dam_break: %s\n", fontana_last_error());
    exit(EXIT_FAILURE);
}

static void set_number(fontana_simulation* simulation, const char* name, double value) {
    require_ok(fontana_set_number(simulation, name, &value, 1));
}

static void add_plane(fontana_simulation* simulation, fontana_collider_type type, double where, int flip) {
    fontana_collider plane;
    fontana_collider_defaults(type, &plane);
    plane.centre[type - FONTANA_PLANE_X] = where;
    plane.flip = flip;
    require_ok(fontana_add_collider(simulation, &plane, NULL));
}

/* A tank of 1.2 m x 0.4 m, open at the top, and a block of water standing at its left wall. */
static void build_scene(fontana_simulation* simulation) {
    set_number(simulation, "fluid.particle_spacing", 0.04);
    set_number(simulation, "fluid.viscosity", 2.0);
    require_ok(fontana_set_text(simulation, "solver.neighbors", "grid"));

    add_plane(simulation, FONTANA_PLANE_Y, 0.0, 0); /* floor */
    add_plane(simulation, FONTANA_PLANE_X, 0.0, 0);
    add_plane(simulation, FONTANA_PLANE_X, 1.2, 1);
    add_plane(simulation, FONTANA_PLANE_Z, 0.0, 0);
    add_plane(simulation, FONTANA_PLANE_Z, 0.4, 1);

    fontana_emitter block;
    fontana_emitter_defaults(FONTANA_BLOCK, &block);
    const double centre[3] = {0.2, 0.3, 0.2}, size[3] = {0.4, 0.6, 0.4};
    memcpy(block.centre, centre, sizeof centre);
    memcpy(block.size, size, sizeof size);
    require_ok(fontana_add_emitter(simulation, &block, NULL));
}

/* A wrong name is no crash and no silence: the library says what it does not know and what is nearest. */
static void show_an_error(fontana_simulation* simulation) {
    const double value = 2.0;
    if (fontana_set_number(simulation, "fluid.viscosty", &value, 1) != FONTANA_BAD_INPUT) {
        fprintf(stderr, "dam_break: the misspelt parameter was accepted\n");
        exit(EXIT_FAILURE);
    }
    printf("A misspelt parameter: %s\n", fontana_last_error());
}

static void step_and_write(fontana_simulation* simulation, const char* folder) {
    fontana_frame_report report;
    require_ok(fontana_step_frame(simulation, &report));
    printf("frame %2d: %u particles, %u substeps (limit: %s), density error %.2f %%, %.2f m/s at most\n",
           (int)report.frame, (unsigned)report.particle_count, (unsigned)report.substeps, report.dt_limit,
           100.0 * report.density_error_mean, report.max_speed);
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/dam_break.%04d.bgeo", folder, (int)report.frame);
    if (length < 0 || (size_t)length >= sizeof path) {
        fprintf(stderr, "dam_break: the name of the folder is too long\n");
        exit(EXIT_FAILURE);
    }
    require_ok(fontana_write_bgeo(simulation, path));
}

/* Attributes are read by name, in order of id. */
static void print_front(fontana_simulation* simulation) {
    const size_t particle_count = fontana_particle_count(simulation);
    const size_t bytes = 3 * particle_count * sizeof(float);
    float* position = malloc(bytes);
    if (!position || particle_count == 0) {
        fprintf(stderr, "dam_break: there are no particles, or no memory for them\n");
        exit(EXIT_FAILURE);
    }
    require_ok(fontana_read_attribute(simulation, "position", position, bytes));
    size_t foremost = 0;
    for (size_t i = 1; i < particle_count; ++i) {
        if (position[3 * i] > position[3 * foremost]) foremost = i;
    }
    printf("The front is particle %u at x = %.3f m, y = %.3f m.\n", (unsigned)foremost, position[3 * foremost],
           position[3 * foremost + 1]);
    free(position);
}

int main(int argument_count, char** arguments) {
    const char* folder = argument_count > 1 ? arguments[1] : ".";
    printf("Fontana %s\n", fontana_version());
    fontana_simulation* simulation = NULL;
    require_ok(fontana_create(&simulation));
    build_scene(simulation);
    show_an_error(simulation);

    fontana_device device;
    require_ok(fontana_device_in_use(simulation, &device));
    printf("Running on %s (%s)\n", device.name, device.backend);
    for (int frame = 0; frame < frame_count; ++frame) step_and_write(simulation, folder);
    print_front(simulation);
    fontana_destroy(simulation);
    return EXIT_SUCCESS;
}
