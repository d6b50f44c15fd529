// A collider of the scene: its surface, and how its centre moves.
#pragma once

#include <vector>

#include "fontana.h"
#include "kernels/step_constants.h"
#include "scene/parameters.h"

namespace fontana {

class Collider {
 public:
    // Far more than an animation has; a larger count is a mistake.
    static constexpr std::size_t most_keys = std::size_t{1} << 24;

    explicit Collider(const fontana_collider& surface) { set_surface(surface); }

    // Throws BAD_INPUT on a radius, elasticity or friction out of range.
    void set_surface(const fontana_collider& surface);
    // Empty: the centre moves by the surface's velocity.
    void set_keys(std::vector<double> time, std::vector<Vector> centre);

    const fontana_collider& surface() const { return surface_; }
    bool enabled() const { return surface_.enabled != 0; }
    bool moves() const;
    Vector centre_at(double time) const;
    double speed_at(double time) const;
    // The surface at the end of a substep of `dt` that ends at `time`; `scale` metres are one unit of the scene.
    ColliderConstants constants_at(double time, double dt, double scale) const;

    static fontana_collider defaults(fontana_collider_type type);

 private:
    std::size_t next_key(double time) const;

    fontana_collider surface_{};
    std::vector<double> key_time_;
    std::vector<Vector> key_centre_;
};

}  // namespace fontana
