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
    explicit NeighborList(Backend& backend) : backend_(backend), group_(backend.device().list_group) {}

    // Finds everyone's neighbours and sets the lists' layout in `constants`. Grows until all fit, so that nobody is
    // left out; OUT_OF_MEMORY says how many neighbours it was about.
    void build(Particles& particles, Neighborhood& neighborhood, StepConstants& constants);

    Buffer& count() { return *count_; }
    Buffer& list() { return *list_; }
    // With so many particles to a list.
    static std::uint64_t bytes(std::uint64_t particle_count, std::uint32_t group);

 private:
    bool is_shared() const { return group_ > 1; }
    std::uint64_t entries(std::uint64_t particle_count, std::uint64_t capacity) const;
    // Where in count() the length of all shared lists stands.
    std::size_t shared_total(std::size_t particle_count) const;
    void reserve(std::size_t particle_capacity);
    void set_layout(StepConstants& constants) const;
    // What capacity_ must be for the lists just built.
    std::uint32_t needed(std::size_t particle_count);

    Backend& backend_;
    const std::uint32_t group_;   // particles that share a list
    std::uint32_t capacity_ = 0;  // neighbours there is room for: on each list, or on all where they are shared
    std::size_t reserved_ = 0;    // particles there is room for
    std::unique_ptr<Buffer> count_, list_;
};

}  // namespace fontana
