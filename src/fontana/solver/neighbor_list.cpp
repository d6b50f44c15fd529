#include "solver/neighbor_list.h"

#include <algorithm>

#include "util/error.h"

namespace fontana {
namespace {

// Kernels count words in 32 bits.
constexpr std::uint64_t k_most_words = 0xffffffffu;
// Words of a shared list that a loop over vectors reads at a time, at the most.
constexpr std::uint64_t k_widest_vector = 16;

// A full neighbourhood has 32; every list of a particle's own ends with a word more, and has two more for a long step.
ListLayout layout_of(const DeviceInfo& device) {
    if (device.list_group > 1) return {true, device.list_group, 4, 18};
    if (device.is_gpu) return {false, 1, 2, 48};
    return {true, 1, 2, 34};
}

// Words that say where the lists are; of shared ones, how long they are too. The room that they need stands behind.
std::size_t start_words(const ListLayout& layout, std::size_t particle_count) {
    return layout.group > 1 ? 2 * ((particle_count + layout.group - 1) / layout.group) : particle_count;
}

}  // namespace

NeighborList::NeighborList(Backend& backend) : backend_(backend), layout_(layout_of(backend.device())) {}

void NeighborList::reserve(std::size_t particle_capacity) {
    if (list_ && reserved_ >= particle_capacity) return;
    const std::uint64_t lists = layout_.is_packed ? 1 : particle_capacity,
                        usual = layout_.is_packed ? std::max<std::uint64_t>(64, layout_.usual_words * particle_capacity)
                                                  : layout_.usual_words,
                        capacity = std::max(capacity_, usual), total = lists * capacity;
    if (total > k_most_words)
        fail(FONTANA_OUT_OF_MEMORY, "neighbour lists of " + std::to_string(particle_capacity) + " particles, " +
                                        std::to_string(total) + " words in all, cannot be indexed");
    list_.reset();  // the old one first, so that the two never stand side by side; there is none if memory runs out
    start_ = backend_.allocate("list start", (start_words(layout_, particle_capacity) + 2) * 4);
    list_ = backend_.allocate("neighbour list", total * layout_.word_bytes);
    capacity_ = capacity;
    reserved_ = particle_capacity;
}

void NeighborList::set_layout(StepConstants& constants) const {
    constants.list_capacity = static_cast<std::uint32_t>(capacity_);
    constants.list_stride = layout_.is_packed ? 1 : static_cast<std::uint32_t>(reserved_);
}

void NeighborList::build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants) {
    const std::size_t count = particles.count(), needed_at = start_words(layout_, count) * 4;
    for (;;) {
        reserve(particles.capacity());
        set_layout(constants);
        std::uint32_t needed[2] = {};  // the low word first
        backend_.write(*start_, needed, sizeof needed, needed_at);
        backend_.launch(Kernel::build_neighbor_list, count,
                        {constants, particles.position(), neighborhood.cell_start(), *start_, *list_});
        backend_.read(*start_, needed, sizeof needed, needed_at);
        const std::uint64_t words = needed[0] | std::uint64_t{needed[1]} << 32;
        if (words <= capacity_) {
            if (layout_.group > 1) blank_words_behind(words);
            return;
        }
        capacity_ = words + words / 16 + 16;
        list_.reset();
    }
}

// A vector may reach beyond the end of the last list. What an earlier build left there could be particles that are
// gone, and that were no numbers any more: even with no weight those would spoil a sum.
void NeighborList::blank_words_behind(std::uint64_t words) {
    const std::uint32_t first_particle[k_widest_vector] = {};
    const std::uint64_t count = std::min(k_widest_vector, capacity_ - words);
    backend_.write(*list_, first_particle, count * sizeof(std::uint32_t), words * sizeof(std::uint32_t));
}

std::uint64_t NeighborList::bytes(std::uint64_t particle_count, const DeviceInfo& device) {
    const ListLayout layout = layout_of(device);
    return start_words(layout, particle_count) * 4 + particle_count * layout.usual_words * layout.word_bytes;
}

}  // namespace fontana
