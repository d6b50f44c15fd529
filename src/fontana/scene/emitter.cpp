#include "scene/emitter.h"

#include <algorithm>
#include <cmath>

#include "util/c_enum.h"
#include "util/error.h"

namespace fontana {
namespace {

// More than this is a slip of units, not a scene.
constexpr double k_most_particles = 2.0e9;
constexpr char k_too_many[] = "more than 2e9 particles; are the units and the particle spacing right?";

void require(bool condition, const std::string& sentence) {
    if (!condition) fail(FONTANA_BAD_INPUT, "emitter: " + sentence);
}

bool is_finite(const double* values) {
    return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector normalised(const Vector& a) {
    const double length = std::hypot(a[0], a[1], a[2]);
    return {a[0] / length, a[1] / length, a[2] / length};
}

// Uniform in [-1, 1), the same for the same (emitter, particle, axis) for ever: splitmix64.
double random_shift(std::uint64_t emitter, std::uint64_t particle, std::uint64_t axis) {
    std::uint64_t z = (emitter << 56) + particle * 3 + axis + 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

bool is_within(double radius, const Vector& p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= radius * radius; }

}  // namespace

fontana_emitter Emitter::defaults(fontana_emitter_type type) {
    fontana_emitter settings{};
    settings.type = type;
    settings.size[0] = settings.size[1] = settings.size[2] = 1.0;
    settings.radius = 0.5;
    settings.direction[1] = 1.0;
    settings.speed = 1.0;
    settings.first_frame = 1;
    settings.last_frame = INT32_MAX;
    return settings;
}

Emitter::Emitter(const fontana_emitter& settings, std::uint32_t index) : settings_(settings), index_(index) {
    const int type = number_of(settings.type);
    require(type >= FONTANA_BLOCK && type <= FONTANA_DISC, "unknown type; expected 0 (block), 1 (sphere) or 2 (disc)");
    require(is_finite(settings.centre) && is_finite(settings.velocity), "centre and velocity must be finite");
    require(settings.type != FONTANA_BLOCK || (is_finite(settings.size) && settings.size[0] > 0.0 &&
                                               settings.size[1] > 0.0 && settings.size[2] > 0.0),
            "the size must be above 0 along each axis");
    require(settings.type == FONTANA_BLOCK || (std::isfinite(settings.radius) && settings.radius > 0.0),
            "the radius must be above 0");
    require(settings.jitter >= 0.0 && settings.jitter <= 0.5, "the jitter must be 0 to 0.5 spacings");
    require(settings.first_frame >= 1, "frames start at 1");
    require(settings.last_frame >= settings.first_frame, "the last frame must not come before the first");
    if (settings.type != FONTANA_DISC) return;
    require(std::isfinite(settings.speed) && settings.speed > 0.0, "the speed must be above 0");
    require(std::isfinite(settings.rate) && settings.rate >= 0.0, "the rate must not be negative");
    const Vector d = {settings.direction[0], settings.direction[1], settings.direction[2]};
    require(is_finite(d.data()) && (d[0] != 0.0 || d[1] != 0.0 || d[2] != 0.0), "the direction must not be zero");
    direction_ = normalised(d);
    const Vector helper = std::abs(direction_[1]) < 0.9 ? Vector{0.0, 1.0, 0.0} : Vector{1.0, 0.0, 0.0};
    side_ = normalised(cross(helper, direction_));
    up_ = cross(direction_, side_);
}

Emitter::Lattice Emitter::lattice(double spacing) const {
    const double r = settings_.radius, flat = settings_.type == FONTANA_DISC ? 0.0 : 2.0 * r;
    const bool is_block = settings_.type == FONTANA_BLOCK;
    const double* size = settings_.size;
    const Vector extent = is_block ? Vector{size[0], size[1], size[2]} : Vector{2.0 * r, flat, 2.0 * r};
    Lattice lattice;
    double total = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = std::max(1.0, std::round(extent[k] / spacing));
        total *= along;
        require(total <= k_most_particles, k_too_many);
        lattice[k] = static_cast<long>(along);
    }
    return lattice;
}

// Calls visit(point) for each point of the batch before it is turned and moved into place, x fastest.
template <typename Visit>
void Emitter::for_each_point(double spacing, const Visit& visit) const {
    const Lattice n = lattice(spacing);
    const auto coordinate = [&](long i, long along) {
        return (static_cast<double>(i) - 0.5 * static_cast<double>(along - 1)) * spacing;
    };
    bool is_empty = true;
    for (long z = 0; z < n[2]; ++z)
        for (long y = 0; y < n[1]; ++y)
            for (long x = 0; x < n[0]; ++x) {
                const Vector point = {coordinate(x, n[0]), coordinate(y, n[1]), coordinate(z, n[2])};
                if (settings_.type != FONTANA_BLOCK && !is_within(settings_.radius, point)) continue;
                visit(point);
                is_empty = false;
            }
    if (is_empty) visit(Vector{0.0, 0.0, 0.0});  // smaller than the spacing: one particle
}

Vector Emitter::turned(const Vector& point) const {
    if (settings_.type != FONTANA_DISC) return point;
    Vector turned;
    for (std::size_t k = 0; k < 3; ++k) turned[k] = point[0] * side_[k] + point[2] * up_[k];
    return turned;
}

std::uint64_t Emitter::particles_per_batch(double spacing) const {
    const Lattice n = lattice(spacing);
    if (settings_.type == FONTANA_BLOCK) return static_cast<std::uint64_t>(n[0] * n[1] * n[2]);
    std::uint64_t count = 0;
    for_each_point(spacing, [&](const Vector&) { ++count; });
    return count;
}

double Emitter::batch_interval(double spacing) const {
    if (settings_.rate > 0.0) return static_cast<double>(particles_per_batch(spacing)) / settings_.rate;
    return spacing / settings_.speed;
}

double Emitter::first_time(double frame_duration) const { return (settings_.first_frame - 1) * frame_duration; }

std::uint64_t Emitter::due_count(double time, bool inclusive, double spacing, double frame_duration) const {
    const double begin = first_time(frame_duration);
    if (inclusive ? time < begin : time <= begin) return 0;
    if (settings_.type != FONTANA_DISC) return 1;
    const double end = settings_.last_frame == INT32_MAX ? time : std::min(time, settings_.last_frame * frame_duration);
    const double interval = batch_interval(spacing);
    const double layers = std::floor((end - begin) / interval);
    require(layers <= k_most_particles, k_too_many);
    const bool on_the_dot = begin + layers * interval >= end && !(inclusive && end == time);
    return static_cast<std::uint64_t>(layers) + (on_the_dot ? 0 : 1);
}

void Emitter::emit(std::uint64_t batch, double time, double spacing, double frame_duration,
                   EmittedParticles& out) const {
    Vector velocity = {settings_.velocity[0], settings_.velocity[1], settings_.velocity[2]};
    double flown = 0.0;
    if (settings_.type == FONTANA_DISC) {
        const double due = first_time(frame_duration) + static_cast<double>(batch) * batch_interval(spacing);
        flown = settings_.speed * std::max(0.0, time - due);
        for (std::size_t k = 0; k < 3; ++k) velocity[k] = settings_.speed * direction_[k];
    }
    const std::uint64_t count = particles_per_batch(spacing);
    std::uint64_t particle = batch * count;
    out.position.reserve(out.position.size() + 3 * count);
    out.velocity.reserve(out.velocity.size() + 3 * count);
    for_each_point(spacing, [&](const Vector& lattice_point) {
        const Vector point = turned(lattice_point);
        for (std::size_t k = 0; k < 3; ++k) {
            const double shift = settings_.jitter * spacing * random_shift(index_, particle, k);
            out.position.push_back(static_cast<float>(settings_.centre[k] + point[k] + flown * direction_[k] + shift));
            out.velocity.push_back(static_cast<float>(velocity[k]));
        }
        ++particle;
    });
}

void Emitter::check(double spacing) const {
    if (settings_.type != FONTANA_DISC || settings_.rate == 0.0) return;
    const double most = static_cast<double>(particles_per_batch(spacing)) * settings_.speed / spacing;
    require(settings_.rate <= 1.01 * most, "a rate of " + std::to_string(settings_.rate) +
                                               " particles a second packs the jet; at this speed and spacing at most " +
                                               std::to_string(most));
}

}  // namespace fontana
