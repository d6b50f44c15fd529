// Hashes that tell an edit from a frame that is as it was.
#pragma once

#include <cstdint>

#include "frame_host.h"

namespace fontana::houdini {

enum class Keyed { yes, no };

// Of the settings and colliders that are keyed, or of those that are not; the others count with their names alone, so
// that setting the first key of a parameter is an edit too.
std::uint64_t key_of(const FrameSettings& settings, Keyed which);
std::uint64_t key_of(const SourcePoints& points);

}  // namespace fontana::houdini
