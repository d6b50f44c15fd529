// Who is near whom: the sorted grid of cells (thesis III.4 and III.6), or nothing at all for all pairs.
#pragma once

#include <memory>

#include "backends/backend.h"
#include "kernels/step_constants.h"
#include "solver/particles.h"

namespace fontana {

// The box of cells that coordinates wrap around (kernels/cells.h): counts along the axes as powers of two.
struct GridShape {
    std::uint32_t bits_x = 2, bits_y = 2, bits_z = 2;
    // 4 cells at the least, so that the 3 neighbours of a cell along an axis differ.
    static constexpr std::uint32_t least_bits = 2, most_bits = 20;
    // Whether fit() could have made it for so many particles: for one that comes from a file.
    bool is_possible(std::size_t particle_count) const;
    std::size_t cell_count() const { return std::size_t{1} << (bits_x + bits_y + bits_z); }
};

class Neighborhood {
 public:
    explicit Neighborhood(Backend& backend) : backend_(backend) {}

    // Fits the box to the particles: as wide as they reach, but never more cells than a few a particle.
    void fit(Particles& particles, const StepConstants& constants);
    const GridShape& shape() const { return shape_; }
    void set_shape(const GridShape& shape) { shape_ = shape; }

    // Puts the grid into `constants`, sorts the particles by cell and finds where each cell starts.
    void update(Particles& particles, StepConstants& constants);
    Buffer& cell_start() { return *cell_start_; }

    // What the next sort will need again; free for use until then. 4 bytes a particle each.
    Buffer& spare_words() { return *key_; }
    Buffer& more_spare_words() { return *order_; }

    static std::uint64_t bytes(std::uint64_t particle_count);

 private:
    void reserve(std::size_t particle_capacity, std::size_t cell_count);

    Backend& backend_;
    GridShape shape_;
    std::unique_ptr<Buffer> key_, order_, cell_start_;
};

}  // namespace fontana
