#include "scene/collider.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "util/c_enum.h"
#include "util/error.h"

namespace fontana {
namespace {

void require(bool condition, const char* sentence) {
    if (!condition) fail(FONTANA_BAD_INPUT, std::string("collider: ") + sentence);
}

bool is_finite(const double* values) {
    return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

}  // namespace

fontana_collider Collider::defaults(fontana_collider_type type) {
    fontana_collider surface{};
    surface.type = type;
    surface.enabled = 1;
    surface.radius = 1.0;
    surface.cutoff = std::numeric_limits<double>::infinity();
    surface.thickness = std::numeric_limits<double>::infinity();
    surface.elasticity = 0.1;
    surface.friction = 0.05;
    return surface;
}

void Collider::set_surface(const fontana_collider& surface) {
    const int type = number_of(surface.type);
    require(type >= FONTANA_PLANE_X && type <= FONTANA_CYLINDER_OUTSIDE,
            "unknown type; expected 0 (plane X) to 6 (cylinder outside)");
    require(is_finite(surface.centre) && is_finite(surface.velocity), "centre and velocity must be finite");
    require(surface.type <= FONTANA_PLANE_Z || (surface.radius > 0.0 && std::isfinite(surface.radius)),
            "the radius must be above 0 and finite");
    require(surface.thickness > 0.0, "the thickness must be above 0; infinite is solid");
    require(!std::isnan(surface.cutoff), "the cutoff is not a number");
    require(surface.elasticity >= 0.0 && surface.elasticity <= 1.0, "the elasticity must be 0 to 1");
    require(surface.friction >= 0.0 && surface.friction <= 1.0, "the friction must be 0 to 1");
    surface_ = surface;
}

void Collider::set_keys(std::vector<double> time, std::vector<Vector> centre) {
    for (std::size_t k = 0; k < time.size(); ++k) {
        require(std::isfinite(time[k]) && is_finite(centre[k].data()), "keys must be finite");
        require(k == 0 || time[k] > time[k - 1], "the times of the keys must ascend");
    }
    key_time_ = std::move(time);
    key_centre_ = std::move(centre);
}

bool Collider::moves() const {
    if (!key_time_.empty()) return key_time_.size() > 1;
    return surface_.velocity[0] != 0.0 || surface_.velocity[1] != 0.0 || surface_.velocity[2] != 0.0;
}

double Collider::speed_at(double time) const {
    Vector v = {surface_.velocity[0], surface_.velocity[1], surface_.velocity[2]};
    if (!key_time_.empty()) {
        const std::size_t next = next_key(time);
        if (next == 0 || next == key_time_.size()) return 0.0;
        for (std::size_t k = 0; k < 3; ++k)
            v[k] = (key_centre_[next][k] - key_centre_[next - 1][k]) / (key_time_[next] - key_time_[next - 1]);
    }
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// The first key after `time`, or the number of keys.
std::size_t Collider::next_key(double time) const {
    return static_cast<std::size_t>(std::upper_bound(key_time_.begin(), key_time_.end(), time) - key_time_.begin());
}

Vector Collider::centre_at(double time) const {
    if (key_time_.empty()) {
        const double* c = surface_.centre;
        const double* v = surface_.velocity;
        return {c[0] + time * v[0], c[1] + time * v[1], c[2] + time * v[2]};
    }
    const std::size_t next = next_key(time);
    if (next == 0) return key_centre_.front();
    if (next == key_time_.size()) return key_centre_.back();
    const double t = (time - key_time_[next - 1]) / (key_time_[next] - key_time_[next - 1]);
    Vector centre;
    for (std::size_t k = 0; k < 3; ++k)
        centre[k] = key_centre_[next - 1][k] + t * (key_centre_[next][k] - key_centre_[next - 1][k]);
    return centre;
}

ColliderConstants Collider::constants_at(double time, double dt, double scale) const {
    const Vector centre = centre_at(time), before = centre_at(time - dt);
    const double to_velocity = dt > 0.0 ? scale / dt : 0.0;
    ColliderConstants c{};
    c.centre_x = static_cast<float>(scale * centre[0]);
    c.centre_y = static_cast<float>(scale * centre[1]);
    c.centre_z = static_cast<float>(scale * centre[2]);
    c.velocity_x = static_cast<float>(to_velocity * (centre[0] - before[0]));
    c.velocity_y = static_cast<float>(to_velocity * (centre[1] - before[1]));
    c.velocity_z = static_cast<float>(to_velocity * (centre[2] - before[2]));
    c.radius = static_cast<float>(scale * surface_.radius);
    c.cutoff = static_cast<float>(scale * surface_.cutoff);
    c.thickness = static_cast<float>(scale * surface_.thickness);
    c.elasticity = static_cast<float>(surface_.elasticity);
    c.friction = static_cast<float>(surface_.friction);
    c.type = static_cast<std::uint32_t>(surface_.type);
    c.side = surface_.flip ? -1.0f : 1.0f;
    return c;
}

}  // namespace fontana
