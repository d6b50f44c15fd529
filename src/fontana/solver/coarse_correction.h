// The coarse levels of the pressure solve on the device (kernels/coarse.h).
#pragma once

#include <memory>
#include <vector>

#include "backends/backend.h"
#include "kernels/coarse.h"
#include "solver/operators.h"

namespace fontana {

class CoarseCorrection {
 public:
    explicit CoarseCorrection(Backend& backend) : backend_(backend) {}

    // Memory for all levels of the substep's grid.
    void reserve(Substep& substep);
    // Builds the matrices of all levels for the particles that have pressure `u` or are called on for some by its
    // residual. `products` is written to, and done with on return.
    void prepare(Substep& substep, Operators& operators, Buffer& residual, Buffer& u, Buffer& products);
    // One V-cycle for the residual; correction() then has the result on the finest level.
    void solve(Substep& substep, Buffer& residual, Buffer& u);

    const CoarseLevel& finest() const { return levels_.front().shape; }
    // By particle: 0 where none of it is for.
    Buffer& weight() { return *weight_; }
    Buffer& correction() { return *levels_.front().z; }

    // Of `products`, and of all else.
    static std::uint64_t product_bytes(std::uint64_t particle_count);
    static std::uint64_t bytes(std::uint64_t particle_count);

 private:
    struct Level {
        CoarseLevel shape;
        std::unique_ptr<Buffer> matrix, b, guess, z;
    };

    Backend& backend_;
    std::vector<Level> levels_;  // finest first
    std::unique_ptr<Buffer> weight_;
};

}  // namespace fontana
