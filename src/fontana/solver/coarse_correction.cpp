#include "solver/coarse_correction.h"

#include <algorithm>

namespace fontana {
namespace {

struct Bits {
    std::uint32_t x, y, z;
};

bool operator==(const Bits& a, const Bits& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Half as many cells along each axis, but never fewer than two: with one a cell would be its own neighbour.
Bits merged(const Bits& bits) {
    return {std::max(1u, bits.x - 1u), std::max(1u, bits.y - 1u), std::max(1u, bits.z - 1u)};
}

CoarseLevel level_of(const Bits& bits) {
    return {(1u << bits.x) - 1u, (1u << bits.y) - 1u, (1u << bits.z) - 1u, bits.x, bits.x + bits.y};
}

bool is_same(const CoarseLevel& a, const CoarseLevel& b) {
    return a.mask_x == b.mask_x && a.mask_y == b.mask_y && a.mask_z == b.mask_z;
}

}  // namespace

void CoarseCorrection::reserve(Substep& s) {
    const std::size_t weight_bytes = s.particles.capacity() * 4;
    if (!weight_ || weight_->bytes() < weight_bytes) weight_ = backend_.allocate("coarse weight", weight_bytes);
    const GridShape& grid = s.neighborhood.shape();
    Bits bits = merged({grid.bits_x, grid.bits_y, grid.bits_z});
    if (!levels_.empty() && is_same(levels_.front().shape, level_of(bits))) return;
    levels_.clear();
    std::vector<Level> levels;  // memory may run out halfway
    for (;;) {
        const CoarseLevel shape = level_of(bits);
        const std::size_t count = coarse_count(shape);
        levels.push_back({shape, backend_.allocate("coarse matrix", count * COARSE_ROW * 4),
                          backend_.allocate("coarse residual", count * 4), backend_.allocate("coarse guess", count * 4),
                          backend_.allocate("coarse correction", count * 4)});
        if (merged(bits) == bits) break;
        bits = merged(bits);
    }
    levels_ = std::move(levels);
}

void CoarseCorrection::prepare(Substep& s, Operators& operators, Buffer& residual, Buffer& u, Buffer& products) {
    const auto count = static_cast<std::uint32_t>(s.particles.count());
    const auto cell_count = static_cast<std::uint32_t>(s.neighborhood.shape().cell_count());
    backend_.launch(Kernel::coarse_weights, count,
                    {count, s.particles.position(), operators.factor(), residual, u, *weight_});
    backend_.launch(Kernel::coarse_products, cell_count,
                    {s.constants, cell_count, s.neighborhood.cell_start(), s.particles.position(), operators.factor(),
                     *weight_, operators.list().start(), operators.list().list(), products});
    backend_.launch(Kernel::coarse_matrix, coarse_count(finest()),
                    {s.constants, finest(), s.neighborhood.cell_start(), products, *levels_.front().matrix});
    for (std::size_t k = 1; k < levels_.size(); ++k)
        backend_.launch(Kernel::coarser_matrix, coarse_count(levels_[k].shape),
                        {levels_[k - 1].shape, levels_[k].shape, *levels_[k - 1].matrix, *levels_[k].matrix});
}

void CoarseCorrection::solve(Substep& s, Buffer& residual, Buffer& u) {
    Level& first = levels_.front();
    backend_.launch(Kernel::coarse_restrict, coarse_count(first.shape),
                    {s.constants, first.shape, s.neighborhood.cell_start(), *weight_, residual, u, *first.matrix,
                     *first.b, *first.guess});
    for (std::size_t k = 1; k < levels_.size(); ++k) {
        const Level &child = levels_[k - 1], &level = levels_[k];
        backend_.launch(
            Kernel::coarse_down, coarse_count(level.shape),
            {child.shape, level.shape, *child.matrix, *child.b, *child.guess, *level.matrix, *level.b, *level.guess});
    }
    Level& last = levels_.back();
    backend_.launch(Kernel::coarse_bottom, 1, {last.shape, *last.matrix, *last.b, *last.z});
    for (std::size_t k = levels_.size() - 1; k-- > 0;) {
        const Level &level = levels_[k], &parent = levels_[k + 1];
        backend_.launch(Kernel::coarse_up, coarse_count(level.shape),
                        {level.shape, parent.shape, *level.matrix, *level.b, *level.guess, *parent.z, *level.z});
    }
}

std::uint64_t CoarseCorrection::product_bytes(std::uint64_t particle_count) {
    return (particle_count / COARSE_LEAST + 1) * COARSE_TABLE * 4;
}

std::uint64_t CoarseCorrection::bytes(std::uint64_t particle_count) {
    const std::uint64_t cells = particle_count / 8;  // of the grid; a level has an eighth of the one below
    return particle_count * 4 + cells / 7 * (COARSE_ROW + 3) * 4;
}

}  // namespace fontana
