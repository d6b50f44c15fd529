// What a session asks of the program it runs in: the settings and the points of any frame.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "fontana.h"

namespace fontana::houdini {

// One row of parameters.def at one frame.
struct Setting {
    std::string name;  // "fluid.viscosity"
    std::array<double, 3> numbers{};
    std::size_t count = 0;  // of numbers; 0: the value is `text`
    std::string text;
    bool is_keyed = false;  // may differ at another frame
};

struct ColliderSetting {
    fontana_collider surface{};
    std::array<double, 3> centre_before{};  // m of the scene, a frame earlier
    bool is_keyed = false;
};

struct FrameSettings {
    std::vector<Setting> settings;
    std::vector<ColliderSetting> colliders;
};

// Arrays as fontana_add_particles takes them; velocity and mass are empty where the host has none.
struct SourcePoints {
    std::vector<float> position, velocity, mass;
    std::size_t count() const { return position.size() / 3; }
};

// The first frame takes every point, those after it only what a source emits continuously.
enum class PointsWanted { all, continuous };

// The user, or the host, asked to stop.
class Interrupted : public std::runtime_error {
 public:
    Interrupted() : std::runtime_error("interrupted") {}
};

class FrameHost {
 public:
    virtual ~FrameHost() = default;
    virtual FrameSettings settings(std::int64_t frame) = 0;
    // Those with is_keyed alone: asked for every frame of the history at each cook, so it should cost little.
    virtual FrameSettings keyed_settings(std::int64_t frame) = 0;
    // May throw Interrupted, or std::runtime_error with a sentence.
    virtual SourcePoints points(std::int64_t frame, PointsWanted wanted) = 0;
    // A hash of the points of all frames where they do not change with time; 0 where they do.
    virtual std::uint64_t steady_points_key() = 0;
    // `fraction` of the way from where the cook began to the frame it is to reach.
    virtual bool is_interrupted(double fraction) = 0;
};

}  // namespace fontana::houdini
