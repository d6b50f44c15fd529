#include "solver/neighborhood.h"

#include <algorithm>
#include <cmath>

#include "solver/diagnostics.h"

namespace fontana {
namespace {

// A block of fluid has one cell for eight particles. The box may have this many cells a particle, for air and spray.
constexpr std::size_t k_cells_per_particle = 4;
constexpr std::size_t k_least_cells = 4096;

std::uint32_t bits_for(double cells) {
    std::uint32_t bits = GridShape::least_bits;
    while (bits < GridShape::most_bits && static_cast<double>(std::uint64_t{1} << bits) < cells) ++bits;
    return bits;
}

std::size_t most_cells(std::size_t particle_count) {
    return std::max(k_least_cells, k_cells_per_particle * particle_count);
}

}  // namespace

bool GridShape::is_possible(std::size_t particle_count) const {
    for (const std::uint32_t bits : {bits_x, bits_y, bits_z})
        if (bits < least_bits || bits > most_bits) return false;
    return bits_x + bits_y + bits_z < 32 && cell_count() <= most_cells(particle_count);
}

void Neighborhood::fit(Particles& particles, const StepConstants& constants) {
    if (particles.count() == 0) return;
    const Bounds bounds = measure_bounds(backend_, particles, constants);
    const double per_metre = static_cast<double>(constants.inverse_cell_size);
    // One cell more than the extent touches, and one empty on the side, so that a compact fluid does not meet itself.
    std::uint32_t bits[3];
    for (int k = 0; k < 3; ++k) bits[k] = bits_for(std::ceil((bounds.high[k] - bounds.low[k]) * per_metre) + 2.0);
    const std::size_t most = most_cells(particles.count());
    for (;;) {
        std::uint32_t& longest = *std::max_element(bits, bits + 3);
        const std::uint32_t sum = bits[0] + bits[1] + bits[2];
        if (longest == GridShape::least_bits || (std::uint64_t{1} << sum) <= most) break;
        --longest;
    }
    shape_ = {bits[0], bits[1], bits[2]};
}

void Neighborhood::reserve(std::size_t particle_capacity, std::size_t cell_count) {
    if (!key_ || key_->bytes() < particle_capacity * 4) {
        order_ = backend_.allocate("order", particle_capacity * 4);
        key_ = backend_.allocate("cell key", particle_capacity * 4);
    }
    if (!cell_start_ || cell_start_->bytes() < (cell_count + 1) * 4)
        cell_start_ = backend_.allocate("cell start", (cell_count + 1) * 4);
}

void Neighborhood::update(Particles& particles, StepConstants& constants) {
    const std::size_t cell_count = constants.use_grid ? shape_.cell_count() : 1;
    reserve(particles.capacity(), cell_count);
    constants.particle_count = static_cast<std::uint32_t>(particles.count());
    constants.grid_mask_x = (1u << shape_.bits_x) - 1u;
    constants.grid_mask_y = (1u << shape_.bits_y) - 1u;
    constants.grid_mask_z = (1u << shape_.bits_z) - 1u;
    constants.grid_shift_y = shape_.bits_x;
    constants.grid_shift_z = shape_.bits_x + shape_.bits_y;
    if (!constants.use_grid) return;
    backend_.launch(Kernel::assign_cells, particles.count(), {constants, particles.position(), *key_});
    backend_.sort(*key_, particles.count(), cell_count, *order_, *cell_start_, particles.spare_vectors());
    particles.reorder(*order_);
}

std::uint64_t Neighborhood::bytes(std::uint64_t particle_count) {
    return particle_count * (4 + 4) + 4 * std::max<std::uint64_t>(k_least_cells, k_cells_per_particle * particle_count);
}

}  // namespace fontana
