#include "solver/particles.h"

#include <algorithm>

#include "util/error.h"

namespace fontana {
namespace {

// Particles that are put together on the host at a time, so that a large block is not there twice.
constexpr std::size_t k_slice = 8192;

template <typename T>
std::vector<T> read_all(Backend& backend, const Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    backend.read(buffer, values.data(), count * sizeof(T));
    return values;
}

template <typename T>
void write_all(Backend& backend, Buffer& buffer, const std::vector<T>& values) {
    backend.write(buffer, values.data(), values.size() * sizeof(T));
}

}  // namespace

std::uint64_t Particles::bytes_per_particle() {
    return 2 * (16 + 16 + 4)  // position, velocity, id, and where they are sorted to
           + 2 * 4 + 16;      // density, pressure, acceleration
}

void Particles::grow(std::unique_ptr<Buffer>& buffer, const char* name, std::size_t bytes, std::size_t kept_bytes) {
    std::unique_ptr<Buffer> larger = backend_.allocate(name, bytes);
    if (kept_bytes) backend_.copy(*buffer, *larger, kept_bytes);
    buffer = std::move(larger);
}

void Particles::reserve(std::size_t capacity) {
    if (capacity <= capacity_ && position_) return;
    if (capacity > most)
        fail(FONTANA_BAD_INPUT, std::to_string(capacity) + " particles are more than the " + std::to_string(most) +
                                    " that ids and indices can count");
    const std::size_t roomy = std::max({capacity, capacity_ + capacity_ / 4, std::size_t{64}});
    grow(position_, "position", 16 * roomy, 16 * count_);
    grow(velocity_, "velocity", 16 * roomy, 16 * count_);
    grow(id_, "id", 4 * roomy, 4 * count_);
    grow(density_, "density", 4 * roomy, 4 * count_);
    grow(pressure_, "pressure", 4 * roomy, 4 * count_);
    grow(acceleration_, "acceleration", 16 * roomy, 16 * count_);
    grow(force_by_id_, "force", has_force_ ? 16 * roomy : 0, has_force_ ? 16 * count_ : 0);
    grow(other_position_, "sorted position", 16 * roomy, 0);
    grow(other_velocity_, "sorted velocity", 16 * roomy, 0);
    grow(other_id_, "sorted id", 4 * roomy, 0);
    capacity_ = roomy;  // only now: memory may run out halfway
}

void Particles::append(std::size_t count, const Source& source, float rest_density) {
    reserve(count_ + count);
    for (std::size_t done = 0; done < count; done += k_slice)
        write_slice(done, std::min(count, done + k_slice), source, rest_density);
    count_ += count;
}

void Particles::write_slice(std::size_t begin, std::size_t end, const Source& source, float rest_density) {
    const std::size_t count = end - begin, first = count_ + begin;
    std::vector<float4> x(count), v(count);
    std::vector<std::uint32_t> id(count);
    const std::vector<float> density(count, rest_density), pressure(count, 0.0f);
    const std::vector<float4> acceleration(count);  // zero, whatever stood there before fewer were uploaded
    for (std::size_t k = 0; k < count; ++k) {
        source(begin + k, x[k], v[k]);
        id[k] = static_cast<std::uint32_t>(first + k);
    }
    backend_.write(*position_, x.data(), count * 16, first * 16);
    backend_.write(*velocity_, v.data(), count * 16, first * 16);
    backend_.write(*id_, id.data(), count * 4, first * 4);
    backend_.write(*density_, density.data(), count * 4, first * 4);
    backend_.write(*pressure_, pressure.data(), count * 4, first * 4);
    backend_.write(*acceleration_, acceleration.data(), count * 16, first * 16);
}

void Particles::set_force(const std::vector<float4>& force_by_id) {
    force_by_id_ = backend_.allocate("force", force_by_id.empty() ? 0 : capacity_ * 16);
    has_force_ = !force_by_id.empty();
    write_all(backend_, *force_by_id_, force_by_id);
}

ParticleState Particles::download() {
    ParticleState state;
    if (!count_) return state;
    state.position = read_all<float4>(backend_, *position_, count_);
    state.velocity = read_all<float4>(backend_, *velocity_, count_);
    state.id = read_all<std::uint32_t>(backend_, *id_, count_);
    state.density = read_all<float>(backend_, *density_, count_);
    state.pressure = read_all<float>(backend_, *pressure_, count_);
    state.acceleration = read_all<float4>(backend_, *acceleration_, count_);
    if (has_force_) state.force_by_id = read_all<float4>(backend_, *force_by_id_, count_);
    return state;
}

void Particles::upload(const ParticleState& state) {
    reserve(state.position.size());
    set_force(state.force_by_id);  // what needs memory comes first: if there is none, the old particles stay
    count_ = state.position.size();
    if (!count_) return;  // there may not be any buffers yet
    write_all(backend_, *position_, state.position);
    write_all(backend_, *velocity_, state.velocity);
    write_all(backend_, *id_, state.id);
    write_all(backend_, *density_, state.density);
    write_all(backend_, *pressure_, state.pressure);
    write_all(backend_, *acceleration_, state.acceleration);
}

void Particles::reorder(const Buffer& order) {
    backend_.launch(Kernel::gather_state, count_,
                    {static_cast<std::uint32_t>(count_), order, *position_, *velocity_, *id_, *other_position_,
                     *other_velocity_, *other_id_});
    position_.swap(other_position_);
    velocity_.swap(other_velocity_);
    id_.swap(other_id_);
}

}  // namespace fontana
