/* fontana.h: the C interface of Fontana, an SPH fluid solver.
 *
 * This is the only header a host (plugin, binding, program) includes, and the only symbols the library exports.
 *
 * Rules of the border:
 *  - Plain C types cross it. No exception does: a call returns a status, and fontana_last_error() has the sentence.
 *  - Strings are UTF-8. Returned strings belong to the library and live until the next call on that simulation
 *    (or, for tables such as parameters, for ever).
 *  - The library installs no signal handler, never aborts, and keeps no global state but the last error of a thread.
 *  - A simulation may be used by one thread at a time; different simulations by different threads.
 *
 * Units are SI: metres, seconds, kilograms, newtons, pascals. Y points up.
 */
#ifndef FONTANA_H
#define FONTANA_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define FONTANA_API __declspec(dllexport)
#else
#define FONTANA_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Raised when a struct or a function below changes its meaning. The file of the library carries it, libfontana.so.N, so
 * that the loader gives no program a library of another one. */
#define FONTANA_ABI_VERSION 3

typedef enum fontana_status {
    FONTANA_OK = 0,
    FONTANA_BAD_INPUT = 1,          /* a value, name, array or file that cannot be used */
    FONTANA_OUT_OF_MEMORY = 2,      /* host or device */
    FONTANA_UNSTABLE = 3,           /* NaN, or more substeps than allowed: the run cannot continue as it is */
    FONTANA_INTERRUPTED = 4,        /* the progress callback asked to stop; stepping again continues */
    FONTANA_DEVICE_UNAVAILABLE = 5, /* no such backend or device here, or its program did not build */
    FONTANA_DEVICE_LOST = 6,        /* the device failed in mid-run: only a checkpoint helps */
    FONTANA_IO_ERROR = 7,           /* a file could not be written or read */
    FONTANA_INTERNAL = 8            /* a defect in Fontana */
} fontana_status;

typedef struct fontana_simulation fontana_simulation;

FONTANA_API const char* fontana_version(void);
FONTANA_API int fontana_abi_version(void);
/* What the last failing call on this thread said; "" if none failed. */
FONTANA_API const char* fontana_last_error(void);

/* ---- life ------------------------------------------------------------------------------------------------- */

/* A simulation with default parameters and no particles. No device is touched before the first step. */
FONTANA_API fontana_status fontana_create(fontana_simulation** out);
FONTANA_API void fontana_destroy(fontana_simulation* simulation);

/* ---- parameters: one table for every host (scene/parameters.def) -------------------------------------------- */

typedef enum fontana_type {
    FONTANA_FLOAT = 0,
    FONTANA_INT = 1,
    FONTANA_BOOL = 2,
    FONTANA_VECTOR = 3, /* three floats */
    FONTANA_CHOICE = 4  /* one word out of `choices` */
} fontana_type;

typedef struct fontana_parameter {
    const char* name;  /* "fluid.viscosity" */
    const char* label; /* "Viscosity" */
    const char* group; /* "fluid" */
    fontana_type type;
    const char* unit;         /* SI unit as text, "" if none: "Pa*s" */
    double default_value[3];  /* numbers and vectors; bool as 0 or 1 */
    const char* default_text; /* choices only, else "" */
    double minimum, maximum;  /* inclusive; infinities where open */
    const char* choices;      /* "grid|all-pairs", "" if not a choice */
    const char* doc;
} fontana_parameter;

FONTANA_API size_t fontana_parameter_count(void);
FONTANA_API fontana_status fontana_parameter_info(size_t index, fontana_parameter* out);
/* `count` is 1, or 3 for a vector. */
FONTANA_API fontana_status fontana_set_number(fontana_simulation*, const char* name, const double* values,
                                              size_t count);
FONTANA_API fontana_status fontana_get_number(fontana_simulation*, const char* name, double* values, size_t count);
FONTANA_API fontana_status fontana_set_text(fontana_simulation*, const char* name, const char* text);
FONTANA_API fontana_status fontana_get_text(fontana_simulation*, const char* name, const char** text);
/* "thesis": the thesis's method and the defaults of its Houdini node. */
FONTANA_API fontana_status fontana_apply_preset(fontana_simulation*, const char* preset);

/* Values the solver derives from the parameters, for hosts to echo. */
typedef struct fontana_derived {
    double support_radius;      /* m */
    double particle_mass;       /* kg */
    double kinematic_viscosity; /* m^2/s */
    double speed_of_sound;      /* m/s, sqrt of the pressure constant; 0 for a method that does not use it */
    double frame_duration;      /* s */
    double self_density;        /* kg/m^3: what one particle alone contributes to its own density */
    double particle_radius;     /* m of the scene, half the distance at rest: Houdini's pscale */
} fontana_derived;
FONTANA_API fontana_status fontana_derive(fontana_simulation*, fontana_derived* out);

/* ---- colliders: implicit surfaces (thesis III.7) ------------------------------------------------------------ */

typedef enum fontana_collider_type { /* numbers of the thesis's node */
                                     FONTANA_PLANE_X = 0,
                                     FONTANA_PLANE_Y = 1,
                                     FONTANA_PLANE_Z = 2,
                                     FONTANA_SPHERE_INSIDE = 3,
                                     FONTANA_SPHERE_OUTSIDE = 4,
                                     FONTANA_CYLINDER_INSIDE = 5,
                                     FONTANA_CYLINDER_OUTSIDE = 6
} fontana_collider_type;

typedef struct fontana_collider {
    fontana_collider_type type;
    int enabled;
    int flip;           /* planes: 0 keeps the fluid on the positive side, 1 on the negative */
    double centre[3];   /* m */
    double radius;      /* m */
    double cutoff;      /* m, height (y) up to which a cylinder's wall stands; INFINITY: for ever */
    double thickness;   /* m, of a cylinder's or sphere's wall; INFINITY: solid */
    double elasticity;  /* kept share of the normal velocity, 0 to 1 */
    double friction;    /* lost share of the tangential velocity at a hit, 0 to 1 */
    double velocity[3]; /* m/s, of the centre, where there are no keys */
} fontana_collider;

/* A plane through the origin, elasticity and friction at their defaults. */
FONTANA_API void fontana_collider_defaults(fontana_collider_type type, fontana_collider* out);
FONTANA_API fontana_status fontana_add_collider(fontana_simulation*, const fontana_collider*, size_t* index);
FONTANA_API fontana_status fontana_set_collider(fontana_simulation*, size_t index, const fontana_collider*);
/* Keys of the centre: `count` times (s, ascending) and 3*count coordinates; linear between, still outside. */
FONTANA_API fontana_status fontana_set_collider_keys(fontana_simulation*, size_t index, size_t count,
                                                     const double* time, const double* centre);
FONTANA_API size_t fontana_collider_count(const fontana_simulation*);
/* Where collider `index` is at `time` (s): x, y, z in metres. */
FONTANA_API fontana_status fontana_collider_centre(fontana_simulation*, size_t index, double time, double centre[3]);

/* ---- particles ---------------------------------------------------------------------------------------------- */

/* position: 3*count floats; velocity: 3*count or NULL (at rest); mass: count or NULL (the derived particle mass).
 * May be called between frames at any time. Ids are given in order of arrival. */
FONTANA_API fontana_status fontana_add_particles(fontana_simulation*, size_t count, const float* position,
                                                 const float* velocity, const float* mass);
/* A force in newtons on each particle (3 floats a particle, in order of id), held until set again; NULL clears. */
FONTANA_API fontana_status fontana_set_force(fontana_simulation*, size_t count, const float* force);
FONTANA_API size_t fontana_particle_count(const fontana_simulation*);

typedef enum fontana_emitter_type {
    FONTANA_BLOCK = 0,  /* `size` around `centre`, filled on a lattice, once, at first_frame */
    FONTANA_SPHERE = 1, /* `radius` around `centre`, filled likewise, once */
    FONTANA_DISC = 2    /* a jet: a disc of `radius`, normal `direction`, from first_frame to last_frame */
} fontana_emitter_type;

typedef struct fontana_emitter {
    fontana_emitter_type type;
    double centre[3];            /* m */
    double size[3];              /* m, block */
    double radius;               /* m, sphere and disc */
    double direction[3];         /* disc; need not be normalised */
    double speed;                /* m/s, disc: along `direction` */
    double velocity[3];          /* m/s, block and sphere */
    double rate;                 /* particles a second, disc; 0: as many as keep the rest density */
    double jitter;               /* random shift of each particle, in spacings, 0 to 0.5 */
    int first_frame, last_frame; /* inclusive; frame 1 is the first one simulated; INT32_MAX: never stops */
} fontana_emitter;

FONTANA_API void fontana_emitter_defaults(fontana_emitter_type type, fontana_emitter* out);
FONTANA_API fontana_status fontana_add_emitter(fontana_simulation*, const fontana_emitter*, size_t* index);
/* How many particles the emitters will have made when frame `frame` is finished; those added by hand excluded. */
FONTANA_API fontana_status fontana_emitted_by(fontana_simulation*, int64_t frame, uint64_t* count);

/* Attributes, all in order of id: position, velocity, acceleration (m/s^2), force (3 floats); density, pressure, mass
 * (1 float); id (1 int32). */
FONTANA_API size_t fontana_attribute_count(void);
FONTANA_API fontana_status fontana_attribute_info(size_t index, const char** name, fontana_type* type, int* components);
/* Writes particle_count * components values of 4 bytes to `out`; `bytes` is the room there. */
FONTANA_API fontana_status fontana_read_attribute(fontana_simulation*, const char* name, void* out, size_t bytes);

/* ---- stepping ----------------------------------------------------------------------------------------------- */

typedef struct fontana_frame_report {
    int64_t frame; /* frames finished so far: 1 after the first */
    double time;   /* s */
    uint64_t particle_count;
    uint32_t substeps;         /* in this frame */
    uint32_t iterations;       /* of the pressure solves of all its substeps; 0 where the method has none */
    uint32_t unconverged;      /* substeps whose solve gave up at solver.max_iterations */
    double dt_min, dt_max;     /* s */
    const char* dt_limit;      /* what held the smallest dt: "fixed", "frame", "advection", "acoustic", ... */
    double density_error_mean; /* of max(0, density / rest - 1): mean over particles and substeps */
    double density_error_max;  /* the largest of any particle in any substep */
    double max_speed;          /* m/s */
    double kinetic_energy;     /* J */
    double centre_of_mass[3];  /* m */
    double seconds;            /* wall time of this frame */
} fontana_frame_report;

/* Called after each substep with the finished share of the frame; non-zero stops with FONTANA_INTERRUPTED. */
typedef int (*fontana_progress)(void* user, double frame_fraction);
FONTANA_API fontana_status fontana_set_progress(fontana_simulation*, fontana_progress callback, void* user);

FONTANA_API fontana_status fontana_step_frame(fontana_simulation*, fontana_frame_report* out);
FONTANA_API int64_t fontana_frame(const fontana_simulation*);

/* The largest stable dt by limit for the present state and parameters, s; INFINITY where it does not apply. */
typedef struct fontana_time_step_limits {
    double advection, acceleration, acoustic, viscosity, surface_tension, convergence;
} fontana_time_step_limits;
FONTANA_API fontana_status fontana_estimate_limits(fontana_simulation*, double speed, double acceleration,
                                                   fontana_time_step_limits* out);
/* Bytes on the device, which is opened, for so many particles with the present parameters. */
FONTANA_API fontana_status fontana_estimate_memory(fontana_simulation*, uint64_t particle_count, uint64_t* bytes);
/* FONTANA_BAD_INPUT with a sentence if the present parameters cannot be integrated stably. */
FONTANA_API fontana_status fontana_check(fontana_simulation*);

/* ---- devices ------------------------------------------------------------------------------------------------ */

typedef struct fontana_device {
    const char* backend; /* "cpu", "cuda", "opencl" */
    const char* name;    /* the device's own */
    const char* driver;  /* vendor and version */
    uint64_t memory_bytes;
    uint32_t compute_units;
    int is_gpu;
    int available;
    const char* reason;    /* why not, where not available; and what to do about it */
    const char* neighbors; /* the words of solver.neighbors that it has, "grid|all-pairs" */
} fontana_device;

/* Asks every backend anew; the list stays valid until the next call on this thread. */
FONTANA_API fontana_status fontana_list_devices(const fontana_device** devices, size_t* count);
/* The one in the list that solver.backend=`backend` takes with solver.device=0, "auto" too; it may be one that is not
 * available. Starts nothing. Its strings live until the next call on this thread. */
FONTANA_API fontana_status fontana_choose_device(const char* backend, fontana_device* out);
/* Starts the device if none runs yet. */
FONTANA_API fontana_status fontana_device_in_use(fontana_simulation*, fontana_device* out);

typedef struct fontana_kernel_profile {
    const char* name;
    uint64_t launches;
    double seconds;
    uint64_t elements; /* particles (or values of a sort) that the launches went through, summed over them */
    /* What they must move and compute at the least, summed: elements times what kernels/kernel_list.def states for the
     * grid and 30 neighbours out of 216 candidates. 0 where nothing is stated, as for a sort. */
    double bytes, flops;
} fontana_kernel_profile;
/* Time by launch since the simulation began, largest first; needs solver.profile. */
FONTANA_API fontana_status fontana_read_profile(fontana_simulation*, const fontana_kernel_profile** rows,
                                                size_t* count);

/* How fast the device in use copies `bytes` (at least 16) from one array to another by a kernel, counting what it reads
 * and what it writes: the best of five, in bytes a second. Needs room for both. Its launches count in the profile. */
FONTANA_API fontana_status fontana_measure_copy(fontana_simulation*, size_t bytes, double* bytes_per_second);

/* ---- files: each appears under its name only when it is complete and on disk ---------------------------------- */

/* Classic .bgeo: P v id density pressure pscale mass. */
FONTANA_API fontana_status fontana_write_bgeo(fontana_simulation*, const char* path);
/* Everything needed to continue bit for bit; `tag` is text of the host's (a scene digest), given back on load. */
FONTANA_API fontana_status fontana_save_checkpoint(fontana_simulation*, const char* path, const char* tag);
/* Verifies the whole file before anything changes. Parameters, colliders and emitters stay those of the simulation. */
FONTANA_API fontana_status fontana_load_checkpoint(fontana_simulation*, const char* path);
FONTANA_API fontana_status fontana_checkpoint_info(const char* path, int64_t* frame, uint64_t* particle_count,
                                                   char* tag, size_t tag_room);
/* The same in memory, for a host that goes back in time; not the bytes of a file. `*data` belongs to the simulation
 * until its next save. */
FONTANA_API fontana_status fontana_save_state(fontana_simulation*, const void** data, size_t* bytes);
FONTANA_API fontana_status fontana_load_state(fontana_simulation*, const void* data, size_t bytes);
/* For the files a host writes itself: same guarantee. `hash` (may be NULL) gets the content's 64-bit hash. */
FONTANA_API fontana_status fontana_publish_file(const char* path, const void* data, size_t bytes, uint64_t* hash);
FONTANA_API uint64_t fontana_hash(const void* data, size_t bytes);

/* ---- the device functions themselves, for tests and teaching -------------------------------------------------- */

/* kernel: "poly6", "spiky", "viscosity"; quantity: "value", "gradient" (dW/dr), "laplacian". */
FONTANA_API fontana_status fontana_smoothing_kernel(const char* kernel, const char* quantity, double r,
                                                    double support_radius, double* out);
/* How many neighbours (itself excluded) each particle finds by the present scheme, in order of id. */
FONTANA_API fontana_status fontana_count_neighbors(fontana_simulation*, uint32_t* out, size_t count);

#ifdef __cplusplus
}
#endif
#endif
