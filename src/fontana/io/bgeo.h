// Houdini's classic binary geometry (.bgeo, version 5), points only: what Houdini, Partio and splashsurf read.
//
// All numbers are big-endian, of 4 bytes where nothing else is said:
//
//   "Bgeo" 'V' version=5
//   counts of: points, primitives, point groups, primitive groups,
//              point, vertex, primitive and detail attributes
//   per point attribute: length of the name (2 bytes), name, components (2 bytes), type, a default per component
//   per point: P as x y z w with w = 1, then the attributes in order
//   what the other counts announce; then the bytes 0x00 0xff
//
// Types: 0 float, 1 integer, 2 string, 4 index into a table of strings, 5 vector (floats that Houdini transforms).
// The same description in code: Partio's BGEO.cpp, splashsurf's bgeo_format.rs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fontana {

// Arrays of the caller's, in order of id.
struct BgeoView {
    std::size_t particle_count = 0;
    const float* position = nullptr;  // 3 a particle, m
    const float* velocity = nullptr;  // 3 a particle, m/s
    const std::int32_t* id = nullptr;
    const float* density = nullptr;   // kg/m^3
    const float* pressure = nullptr;  // Pa
    const float* pscale = nullptr;    // m, the radius to draw
    const float* mass = nullptr;      // kg
};

// The same as read from a file. An array is empty if the file has no such attribute; P it always has.
struct BgeoParticles {
    std::vector<float> position, velocity;
    std::vector<std::int32_t> id;
    std::vector<float> density, pressure, pscale, mass;

    std::size_t particle_count() const { return position.size() / 3; }
};

// Writes P, v, id, density, pressure, pscale, mass; replaces `path` once the file is complete and on disk. Returns the
// hash64 of the file. Throws Error: FONTANA_BAD_INPUT for a null array or more particles than the format's 2^31 - 1,
// FONTANA_IO_ERROR.
std::uint64_t write_bgeo(const std::string& path, const BgeoView& particles);

// Reads those attributes, in any order, of any .bgeo without string attributes of points; what it has beside them
// (other attributes, primitives, groups) is passed over. Throws Error: FONTANA_BAD_INPUT for a file that is damaged or
// of another format, FONTANA_IO_ERROR.
BgeoParticles read_bgeo(const std::string& path);

}  // namespace fontana
