// The grid that Fontana uses (kernels/cells.h, backends/cpu/radix_sort.h), on one thread, with the arrays of
// solver/particles.h that a density pass touches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "backends/cpu/radix_sort.h"
#include "kernels/density.h"
#include "kernels/reorder.h"

namespace fontana {

class SortedGrid {
 public:
    SortedGrid(const std::vector<float4>& fluid, const StepConstants& constants)
        : constants_(constants),
          position_(fluid),
          velocity_(fluid.size()),
          sorted_position_(fluid.size()),
          sorted_velocity_(fluid.size()),
          packed_position_(fluid.size()),
          packed_velocity_(fluid.size()),
          acceleration_(fluid.size()),
          id_(fluid.size()),
          sorted_id_(fluid.size()),
          key_(fluid.size()),
          order_(fluid.size()),
          density_(fluid.size()),
          pressure_(fluid.size()) {
        for (std::size_t i = 0; i < fluid.size(); ++i) id_[i] = static_cast<std::uint32_t>(i);
        constants_.particle_count = static_cast<uint>(fluid.size());
        fit();
    }

    void build() {
        const auto count = static_cast<uint>(position_.size());
        for (uint i = 0; i < count; ++i) assign_cells(i, constants_, position_.data(), key_.data());
        sorter_.sort(pool_, key_.data(), count, cell_start_.size() - 1, order_.data(), cell_start_.data(),
                     reinterpret_cast<RadixSort::Item*>(sorted_position_.data()));
        for (uint i = 0; i < count; ++i)
            gather_state(i, count, order_.data(), position_.data(), velocity_.data(), id_.data(),
                         sorted_position_.data(), sorted_velocity_.data(), sorted_id_.data());
    }

    void sum_density() {
        for (uint i = 0; i < constants_.particle_count; ++i)
            ::density(i, constants_, sorted_position_.data(), sorted_velocity_.data(), cell_start_.data(),
                      density_.data(), packed_position_.data(), packed_velocity_.data(), pressure_.data());
    }

    // Where cells start, key and order, and the second copy of what is reordered, in which the sort has its two lists.
    std::size_t grid_bytes() const { return cell_start_.size() * 4 + position_.size() * (4 + 4 + (16 + 16 + 4)); }
    // Position and velocity as they are and packed, acceleration, density, pressure, id.
    std::size_t particle_bytes() const { return position_.size() * (5 * 16 + 3 * 4); }

    std::vector<float> density() const {
        std::vector<float> values(density_.size());
        for (std::size_t i = 0; i < density_.size(); ++i) values[sorted_id_[i]] = density_[i];
        return values;
    }

 private:
    // The box of cells that coordinates wrap around, as Neighborhood::fit makes it.
    void fit() {
        float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f};
        for (const float4& x : position_) {
            const float along[3] = {x.x, x.y, x.z};
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], along[axis]);
                high[axis] = std::max(high[axis], along[axis]);
            }
        }
        uint bits[3] = {2u, 2u, 2u};
        for (int axis = 0; axis < 3; ++axis)
            while (static_cast<float>(1u << bits[axis]) <
                   (high[axis] - low[axis]) * constants_.inverse_cell_size + 2.0f)
                ++bits[axis];
        constants_.grid_mask_x = (1u << bits[0]) - 1u;
        constants_.grid_mask_y = (1u << bits[1]) - 1u;
        constants_.grid_mask_z = (1u << bits[2]) - 1u;
        constants_.grid_shift_y = bits[0];
        constants_.grid_shift_z = bits[0] + bits[1];
        cell_start_.resize((std::size_t{1} << (bits[0] + bits[1] + bits[2])) + 1);
    }

    StepConstants constants_;
    ThreadPool pool_{1};
    RadixSort sorter_;
    std::vector<float4> position_, velocity_, sorted_position_, sorted_velocity_, packed_position_, packed_velocity_;
    std::vector<float4> acceleration_;
    std::vector<std::uint32_t> id_, sorted_id_, key_, order_, cell_start_;
    std::vector<float> density_, pressure_;
};

}  // namespace fontana
