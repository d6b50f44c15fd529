// The lists of neighbours on the device (kernels/neighbor_list.h), and their capacity.
#pragma once

#include <memory>

#include "backends/backend.h"
#include "kernels/step_constants.h"
#include "solver/neighborhood.h"
#include "solver/particles.h"

namespace fontana {

class NeighborList {
 public:
    explicit NeighborList(Backend& backend) : backend_(backend) {}

    // Finds everyone's neighbours and sets the list's layout in `constants`. Grows until the fullest list fits, so that
    // nobody is left out; OUT_OF_MEMORY says how many neighbours it was about.
    void build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants);

    Buffer& count() { return *count_; }
    Buffer& list() { return *list_; }
    static std::uint64_t bytes(std::uint64_t particle_count);

 private:
    void reserve(std::size_t particle_count);
    void set_layout(StepConstants& constants) const;
    std::uint32_t longest(std::size_t particle_count);

    Backend& backend_;
    std::uint32_t capacity_ = 48;  // a full neighbourhood at the usual spacing has 32
    std::size_t reserved_ = 0;     // particles there is room for
    std::unique_ptr<Buffer> count_, list_;
};

}  // namespace fontana
