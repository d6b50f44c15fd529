// Where a source that emits continuously may put a particle.
#pragma once

#include <vector>

#include "frame_host.h"

namespace fontana::houdini {

// The points that have no particle nearer than nine tenths of `spacing` (m of the scene): a fluid at rest is jittered
// by some percent, and a place that it only half left would be filled twice. `particles` has 3 floats each.
SourcePoints in_free_places(const SourcePoints& points, const std::vector<float>& particles, double spacing);

}  // namespace fontana::houdini
