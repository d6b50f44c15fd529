// A hand in the fluid: an acceleration that is largest at a centre and fades towards a radius around it. The thesis
// names it the user interaction force (II.1.1.6) and leaves its form open.
#ifndef FONTANA_PUSH_H
#define FONTANA_PUSH_H

#include "step_constants.h"

// (1 - r^2 / R^2)^2 within the radius R, 0 outside: smooth at the rim, so that nothing tears there, and without a root.
// Its integral over space is 32 pi / 105 R^3.
FN float push_share(const StepConstants c, float4 position) {
    const float dx = position.x - c.push_centre_x;
    const float dy = position.y - c.push_centre_y;
    const float dz = position.z - c.push_centre_z;
    const float s = max_f(0.0f, 1.0f - (dx * dx + dy * dy + dz * dz) * c.inverse_push_radius_squared);
    return s * s;
}

#endif
