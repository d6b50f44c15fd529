// The particles on a device: their arrays, in the order of the cells they were last sorted by.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "kernels/step_constants.h"

namespace fontana {

// What a simulation is, apart from its settings: enough to go on bit for bit, on this device or another.
struct ParticleState {
    std::vector<float4> position;  // x, y, z in m, mass in kg
    std::vector<float4> velocity;  // m/s
    std::vector<std::uint32_t> id;
    std::vector<float> density;        // kg/m^3
    std::vector<float> pressure;       // Pa
    std::vector<float4> acceleration;  // m/s^2
    std::vector<float4> force_by_id;   // N; empty where no force was set
};

class Particles {
 public:
    // Ids and indices are 32-bit, and three words a particle must be countable too.
    static constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() / 4;

    explicit Particles(Backend& backend) : backend_(backend) {}

    std::size_t count() const { return count_; }
    // How many there is room for without growing, here and in all arrays that go by it.
    std::size_t capacity() const { return capacity_; }
    static std::uint64_t bytes_per_particle();

    // Says where the k-th of those to be added is, with its mass, and how fast if it is not at rest.
    using Source = std::function<void(std::size_t k, float4& position, float4& velocity)>;
    // Ids go on from count(). `rest_density` is what their density reads until the next substep.
    void append(std::size_t count, const Source& source, float rest_density);
    void set_force(const std::vector<float4>& force_by_id);
    bool has_force() const { return has_force_; }

    ParticleState download();
    void upload(const ParticleState& state);

    // Into the order given; density and what is computed from neighbours is stale until computed again.
    void reorder(const Buffer& order);

    Buffer& position() { return *position_; }
    Buffer& velocity() { return *velocity_; }
    Buffer& id() { return *id_; }
    Buffer& density() { return *density_; }
    Buffer& pressure() { return *pressure_; }
    Buffer& acceleration() { return *acceleration_; }
    Buffer& force_by_id() { return *force_by_id_; }

    // The arrays that the next sort puts the particles into; free for use until then. 16, 16 and 4 bytes a particle.
    Buffer& spare_vectors() { return *other_position_; }
    Buffer& more_spare_vectors() { return *other_velocity_; }
    Buffer& spare_words() { return *other_id_; }

 private:
    void reserve(std::size_t capacity);
    void write_slice(std::size_t begin, std::size_t end, const Source& source, float rest_density);
    void grow(std::unique_ptr<Buffer>& buffer, const char* name, std::size_t bytes, std::size_t kept_bytes);

    Backend& backend_;
    std::size_t count_ = 0, capacity_ = 0;
    bool has_force_ = false;
    std::unique_ptr<Buffer> position_, velocity_, id_, density_, pressure_, acceleration_, force_by_id_,
        other_position_, other_velocity_, other_id_;
};

}  // namespace fontana
