// Emitters: particles on a lattice at the spacing, once (block, sphere) or layer by layer (disc).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fontana.h"
#include "scene/parameters.h"

namespace fontana {

// Positions and velocities, three floats a particle, in metres and metres a second of the scene.
struct EmittedParticles {
    std::vector<float> position, velocity;
};

class Emitter {
 public:
    // index makes the jitter of two emitters differ. Throws BAD_INPUT on sizes, rates or frames out of range.
    Emitter(const fontana_emitter& settings, std::uint32_t index);

    // How many batches (a block, a sphere, a layer of a disc) are due before `time`, or by `time` if inclusive.
    std::uint64_t due_count(double time, bool inclusive, double spacing, double frame_duration) const;
    std::uint64_t particles_per_batch(double spacing) const;
    // Appends batch number `batch` as it stands at `time`.
    void emit(std::uint64_t batch, double time, double spacing, double frame_duration, EmittedParticles& out) const;
    // Throws BAD_INPUT if the rate would pack a disc's layers closer than the spacing.
    void check(double spacing) const;

    static fontana_emitter defaults(fontana_emitter_type type);

 private:
    using Lattice = std::array<long, 3>;  // points along x, y, z

    Lattice lattice(double spacing) const;
    template <typename Visit>
    void for_each_point(double spacing, const Visit& visit) const;
    Vector turned(const Vector& point) const;
    double batch_interval(double spacing) const;
    double first_time(double frame_duration) const;

    fontana_emitter settings_;
    std::uint32_t index_;
    Vector direction_{}, side_{}, up_{};  // of a disc
};

}  // namespace fontana
