// Everything a substep's kernels need beside arrays. Passed by value, so the layout must be the same in all languages:
// 4-byte members only.
#ifndef FONTANA_STEP_CONSTANTS_H
#define FONTANA_STEP_CONSTANTS_H

#include "dialect.h"

typedef struct StepConstants {
    float support_radius;             // m, where W becomes zero
    float support_radius_squared;     // m^2
    float rest_density;               // kg/m^3
    float pressure_constant;          // m^2/s^2, k of eq. 2.11
    float minimum_pressure;           // of p, and of u: 0, or -infinity where it may be negative
    float viscosity;                  // Pa s
    float surface_tension;            // N/m
    float poly6_scale;                // 315 / (64 pi H^9)
    float spiky_gradient_scale;       // 45 / (pi H^6)
    float viscosity_laplacian_scale;  // 45 / (pi H^6)
    float poly6_gradient_scale;       // 945 / (32 pi H^9)
    float kernel_scale;               // 1/m^3, of the spline (spline.h)
    float own_value;                  // 1/m^3, W(0) of the kernel that the density is summed with
    float gradient_scale;             // of the spline's gradient over the rest density, m^3/kg times 1/m^4 or 1/m^5
    float inverse_support_radius;     // 1/m
    float inverse_rest_density;       // m^3/kg
    float inverse_dt;                 // 1/s
    float minimum_normal;             // 1/m: below this the colour field's gradient is no surface
    float gravity_x, gravity_y, gravity_z;  // m/s^2
    float wind_x, wind_y, wind_z;           // m/s
    float wind_coupling;                    // 1/s
    float drag;                             // factor on the velocity in each substep
    float dt;                               // s
    float inverse_cell_size;                // 1/m
    uint particle_count;
    uint collider_count;
    // The user's push (push.h): m/s^2 at its centre, m, and 1/m^2, which is 0 where there is no push.
    float push_x, push_y, push_z;
    float push_centre_x, push_centre_y, push_centre_z;
    float inverse_push_radius_squared;
    uint has_force;                              // whether the array of forces is in use
    uint use_grid;                               // 0: all pairs
    uint grid_mask_x, grid_mask_y, grid_mask_z;  // cells along an axis, less one; counts are powers of two
    uint grid_shift_y, grid_shift_z;             // where y and z stand in a cell's key
    uint use_wendland;                           // instead of the cubic spline
    uint list_capacity;                          // words there is room for: packed or shared on all lists, else on each
    uint list_stride;                            // from one word of a list to its next
} StepConstants;

// An implicit surface, as the kernels see it: III.7 of the thesis. Units as in fontana_collider.
typedef struct ColliderConstants {
    float centre_x, centre_y, centre_z;
    float radius;
    float velocity_x, velocity_y, velocity_z;
    float cutoff;     // y up to which a cylinder's wall stands
    float thickness;  // of a wall; infinite: solid
    float elasticity;
    float friction;
    uint type;   // fontana_collider_type
    float side;  // +1 or -1: which side of a plane the fluid is on
    float unused_0, unused_1, unused_2;
} ColliderConstants;

#endif
