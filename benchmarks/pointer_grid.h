// The grid of the thesis's first derivation (III.4, Fig. 4): cells allocated beforehand, each with room for a fixed
// number of pointers to particle structures, which stay where they are in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/smoothing.h"
#include "kernels/step_constants.h"

namespace fontana {

struct Particle {
    float position[3], velocity[3], acceleration[3];
    float mass, density, pressure;
    std::uint32_t id;
};

class PointerGrid {
 public:
    struct Overflow {
        std::size_t cells = 0, particles = 0;
    };

    // Room for every cell of a vessel of width x height x depth metres, whether there is fluid in it or not.
    PointerGrid(const std::vector<float4>& fluid, const StepConstants& constants, float width, float height,
                float depth, std::size_t capacity)
        : constants_(constants), capacity_(capacity), particles_(fluid.size()) {
        for (std::size_t i = 0; i < fluid.size(); ++i) {
            const float4 x = fluid[i];
            particles_[i] = {{x.x, x.y, x.z}, {}, {}, x.w, 0.0f, 0.0f, static_cast<std::uint32_t>(i)};
        }
        const std::size_t cells = cells_along(width) * cells_along(height) * cells_along(depth);
        fill_.resize(cells);
        slots_.resize(cells * capacity);
    }

    // Cells between the outermost particles, emptied and filled anew; what finds no place is counted.
    void build() {
        overflow_ = {};
        measure_bounds();
        std::fill_n(fill_.begin(), cell_count(), 0u);
        for (Particle& particle : particles_) {
            const std::size_t cell = index_of(cell_of(particle));
            const std::size_t place = fill_[cell]++;
            if (place < capacity_) slots_[cell * capacity_ + place] = &particle;
            if (place == capacity_) ++overflow_.cells;
            if (place >= capacity_) ++overflow_.particles;
        }
    }

    void sum_density() {
        const float support_squared = constants_.support_radius_squared;
        for (Particle& particle : particles_) {
            float sum = 0.0f;
            for_each_candidate(cell_of(particle), [&](const Particle& other) {
                const float dx = particle.position[0] - other.position[0];
                const float dy = particle.position[1] - other.position[1];
                const float dz = particle.position[2] - other.position[2];
                const float r_squared = dx * dx + dy * dy + dz * dz;
                if (r_squared < support_squared) sum += other.mass * poly6(r_squared, support_squared);
            });
            particle.density = constants_.poly6_scale * sum;
        }
    }

    const Overflow& overflow() const { return overflow_; }
    std::size_t fullest_cell() const { return *std::max_element(fill_.begin(), fill_.end()); }
    std::size_t grid_bytes() const { return fill_.size() * sizeof fill_[0] + slots_.size() * sizeof slots_[0]; }
    std::size_t particle_bytes() const { return particles_.size() * sizeof(Particle); }

    std::vector<float> density() const {
        std::vector<float> values(particles_.size());
        for (const Particle& particle : particles_) values[particle.id] = particle.density;
        return values;
    }

 private:
    struct Cell {
        std::size_t x, y, z;
    };

    // One more than fit: fluid need not begin where a cell does.
    std::size_t cells_along(float length) const { return whole_cells(length) + 2; }
    std::size_t whole_cells(float length) const {
        return static_cast<std::size_t>(length * constants_.inverse_cell_size);
    }
    std::size_t cell_count() const { return counts_.x * counts_.y * counts_.z; }
    std::size_t index_of(Cell cell) const { return (cell.z * counts_.y + cell.y) * counts_.x + cell.x; }

    Cell cell_of(const Particle& particle) const {
        const auto along = [&](int axis) { return whole_cells(particle.position[axis] - low_[axis]); };
        return {along(0), along(1), along(2)};
    }

    void measure_bounds() {
        float high[3];
        for (int axis = 0; axis < 3; ++axis) low_[axis] = high[axis] = particles_[0].position[axis];
        for (const Particle& particle : particles_)
            for (int axis = 0; axis < 3; ++axis) {
                low_[axis] = std::min(low_[axis], particle.position[axis]);
                high[axis] = std::max(high[axis], particle.position[axis]);
            }
        const auto count = [&](int axis) { return whole_cells(high[axis] - low_[axis]) + 1; };
        counts_ = {count(0), count(1), count(2)};
    }

    template <typename Visit>
    void for_each_candidate(Cell cell, const Visit& visit) const {
        for (std::size_t z = first(cell.z); z <= last(cell.z, counts_.z); ++z)
            for (std::size_t y = first(cell.y); y <= last(cell.y, counts_.y); ++y)
                for (std::size_t x = first(cell.x); x <= last(cell.x, counts_.x); ++x) {
                    const std::size_t here = index_of({x, y, z});
                    for (std::size_t k = 0; k < fill_[here]; ++k) visit(*slots_[here * capacity_ + k]);
                }
    }
    static std::size_t first(std::size_t cell) { return cell == 0 ? 0 : cell - 1; }
    static std::size_t last(std::size_t cell, std::size_t count) { return std::min(cell + 1, count - 1); }

    StepConstants constants_;
    std::size_t capacity_;
    std::vector<Particle> particles_;
    float low_[3] = {};
    Cell counts_ = {};
    Overflow overflow_;
    std::vector<std::uint32_t> fill_;
    std::vector<Particle*> slots_;
};

}  // namespace fontana
