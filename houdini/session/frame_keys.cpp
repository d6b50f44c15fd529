#include "frame_keys.h"

#include <string>

namespace fontana::houdini {
namespace {

// Bytes to hash. Member by member, since a struct may have gaps between its members.
class Bytes {
 public:
    template <typename T>
    void add(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void add_text(const std::string& text) {
        add(text.size());
        bytes_ += text;
    }
    std::uint64_t hash() const { return fontana_hash(bytes_.data(), bytes_.size()); }

 private:
    std::string bytes_;
};

void add_value(Bytes& bytes, const Setting& setting) {
    bytes.add(setting.numbers);
    bytes.add(setting.count);
    bytes.add_text(setting.text);
}

void add_value(Bytes& bytes, const ColliderSetting& collider) {
    const fontana_collider& s = collider.surface;
    bytes.add(static_cast<int>(s.type));
    bytes.add(s.enabled);
    bytes.add(s.flip);
    bytes.add(s.centre);
    bytes.add(s.radius);
    bytes.add(s.cutoff);
    bytes.add(s.thickness);
    bytes.add(s.elasticity);
    bytes.add(s.friction);
    bytes.add(s.velocity);
    bytes.add(collider.centre_before);
}

std::uint64_t hash_of(const std::vector<float>& values) {
    return fontana_hash(values.data(), values.size() * sizeof(float));
}

}  // namespace

std::uint64_t key_of(const FrameSettings& settings, Keyed which) {
    const bool keyed = which == Keyed::yes;
    Bytes bytes;
    for (const Setting& setting : settings.settings) {
        if (keyed && !setting.is_keyed) continue;
        bytes.add_text(setting.name);
        bytes.add(setting.is_keyed);
        if (setting.is_keyed == keyed) add_value(bytes, setting);
    }
    for (const ColliderSetting& collider : settings.colliders) {
        if (keyed && !collider.is_keyed) continue;
        bytes.add(collider.is_keyed);
        if (collider.is_keyed == keyed) add_value(bytes, collider);
    }
    return bytes.hash();
}

std::uint64_t key_of(const SourcePoints& points) {
    Bytes bytes;
    bytes.add(points.count());
    bytes.add(hash_of(points.position));
    bytes.add(hash_of(points.velocity));
    bytes.add(hash_of(points.mass));
    return bytes.hash();
}

}  // namespace fontana::houdini
