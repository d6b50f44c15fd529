#include "solver/neighbor_list.h"

#include <algorithm>

#include "solver/diagnostics.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr std::uint32_t k_usual_capacity = 48;
constexpr std::uint32_t k_padding = 16;  // the widest vector a processor's loops use
// Indices into the lists are 32-bit.
constexpr std::uint64_t k_most_entries = 0xffffffffu;

}  // namespace

void NeighborList::reserve(std::size_t particle_count) {
    if (list_ && reserved_ >= particle_count) return;
    std::size_t roomy = particle_count + particle_count / 4;
    if (std::uint64_t{roomy} * capacity_ > k_most_entries) roomy = particle_count;
    if (std::uint64_t{roomy} * capacity_ > k_most_entries)
        fail(FONTANA_OUT_OF_MEMORY, "neighbour lists of " + std::to_string(particle_count) + " particles with up to " +
                                        std::to_string(capacity_) + " neighbours each cannot be indexed");
    list_.reset();  // the old one first, so that the two never stand side by side; there is none if memory runs out
    count_ = backend_.allocate("neighbour count", roomy * 4);
    list_ = backend_.allocate("neighbour list", roomy * capacity_ * 4);
    reserved_ = roomy;
}

// A processor walks one particle's list from end to end; a GPU's threads walk side by side.
void NeighborList::set_layout(StepConstants& constants) const {
    const auto rows = static_cast<std::uint32_t>(reserved_);
    const bool side_by_side = backend_.device().is_gpu;
    constants.list_capacity = capacity_;
    constants.list_particle_stride = side_by_side ? 1 : capacity_;
    constants.list_neighbor_stride = side_by_side ? rows : 1;
    constants.list_padding = side_by_side ? 1 : k_padding;
}

std::uint32_t NeighborList::longest(std::size_t particle_count) {
    return largest_of(backend_, *count_, particle_count);
}

void NeighborList::build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants) {
    const std::size_t count = particles.count();
    for (;;) {
        reserve(count);
        set_layout(constants);
        backend_.launch(Kernel::build_neighbor_list, count,
                        {constants, particles.position(), neighborhood.cell_start(), *count_, *list_});
        const std::uint32_t needed = longest(count);
        if (needed <= capacity_) return;
        capacity_ = (needed + needed / 4 + k_padding) / k_padding * k_padding;
        list_.reset();
    }
}

std::uint64_t NeighborList::bytes(std::uint64_t particle_count) {
    return (particle_count + particle_count / 4) * (k_usual_capacity + 1) * 4;
}

}  // namespace fontana
