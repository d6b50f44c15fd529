// The lists of neighbours on the device (kernels/neighbor_list.h), and their capacity.
#pragma once

#include <memory>

#include "backends/backend.h"
#include "kernels/step_constants.h"
#include "solver/neighborhood.h"
#include "solver/particles.h"

namespace fontana {

// How a device has its lists.
struct ListLayout {
    bool is_packed;             // one list behind another; or side by side, with as much room for each
    std::uint32_t group;        // particles that share a list
    std::uint32_t word_bytes;   // of a list
    std::uint32_t usual_words;  // of it for each particle, which there is room for at first
};

class NeighborList {
 public:
    explicit NeighborList(Backend& backend);

    // Finds everyone's neighbours and sets the lists' layout in `constants`. Grows until all fit, so that nobody is
    // left out; OUT_OF_MEMORY says how many words it was about.
    void build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants);

    Buffer& start() { return *start_; }
    Buffer& list() { return *list_; }
    static std::uint64_t bytes(std::uint64_t particle_count, const DeviceInfo& device);

 private:
    void reserve(std::size_t particle_capacity);
    void set_layout(StepConstants& constants) const;
    void blank_words_behind(std::uint64_t words);

    Backend& backend_;
    const ListLayout layout_;
    std::uint64_t capacity_ = 0;  // words there is room for: packed, on all lists; else on each
    std::size_t reserved_ = 0;    // particles there is room for
    std::unique_ptr<Buffer> start_, list_;
};

}  // namespace fontana
