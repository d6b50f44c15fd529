#include "solver/neighbor_list.h"

#include <algorithm>

#include "kernels/neighbor_list.h"
#include "solver/diagnostics.h"
#include "util/error.h"

namespace fontana {
namespace {

constexpr std::uint64_t k_usual_length = 48;  // of a particle's own list: a full neighbourhood has 32
constexpr std::uint64_t k_usual_share = 18;   // of a particle in the list of a group
// Indices into the lists are 32-bit.
constexpr std::uint64_t k_most_entries = 0xffffffffu;

}  // namespace

std::uint64_t NeighborList::entries(std::uint64_t particle_count, std::uint64_t capacity) const {
    return is_shared() ? capacity : particle_count * capacity;
}

void NeighborList::reserve(std::size_t particle_capacity) {
    if (list_ && reserved_ >= particle_capacity) return;
    const std::uint64_t usual =
        is_shared() ? std::max<std::uint64_t>(64, particle_capacity * k_usual_share) : k_usual_length;
    const std::uint64_t capacity = std::max<std::uint64_t>(capacity_, usual),
                        total = entries(particle_capacity, capacity);
    if (total > k_most_entries)
        fail(FONTANA_OUT_OF_MEMORY, "neighbour lists of " + std::to_string(particle_capacity) + " particles, " +
                                        std::to_string(total) + " neighbours in all, cannot be indexed");
    list_.reset();  // the old one first, so that the two never stand side by side; there is none if memory runs out
    count_ = backend_.allocate("neighbour count",
                               (is_shared() ? shared_total(particle_capacity) + 1 : particle_capacity) * 4);
    list_ = backend_.allocate("neighbour list", total * 4);
    capacity_ = static_cast<std::uint32_t>(capacity);
    reserved_ = particle_capacity;
}

std::size_t NeighborList::shared_total(std::size_t particle_count) const {
    return shared_list_total(static_cast<std::uint32_t>(particle_count), group_);
}

// A processor walks one particle's list from end to end; a GPU's threads walk side by side.
void NeighborList::set_layout(StepConstants& constants) const {
    const bool side_by_side = backend_.device().is_gpu;
    constants.list_capacity = capacity_;
    constants.list_particle_stride = side_by_side ? 1 : capacity_;
    constants.list_neighbor_stride = side_by_side ? static_cast<std::uint32_t>(reserved_) : 1;
}

std::uint32_t NeighborList::needed(std::size_t particle_count) {
    if (!is_shared()) return largest_of(backend_, *count_, particle_count);
    std::uint32_t total = 0;
    backend_.read(*count_, &total, 4, shared_total(particle_count) * 4);
    return total;
}

void NeighborList::build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants) {
    const std::size_t count = particles.count();
    for (;;) {
        reserve(particles.capacity());
        set_layout(constants);
        const std::uint32_t nothing = 0;
        if (is_shared()) backend_.write(*count_, &nothing, 4, shared_total(count) * 4);
        backend_.launch(Kernel::build_neighbor_list, count,
                        {constants, particles.position(), neighborhood.cell_start(), *count_, *list_});
        const std::uint64_t found = needed(count);
        if (found <= capacity_) return;
        capacity_ = static_cast<std::uint32_t>(std::min(found + found / 16 + 16, k_most_entries));
        list_.reset();
    }
}

std::uint64_t NeighborList::bytes(std::uint64_t particle_count, std::uint32_t group) {
    const std::uint64_t words = group > 1 ? k_usual_share : k_usual_length + 1;
    return particle_count * words * 4 + (group > 1 ? particle_count / group * 8 : 0);
}

}  // namespace fontana
