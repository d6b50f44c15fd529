// Fills the inside of a closed mesh with points on a lattice.
//
// Our own, because it is a hundred lines: the libraries that do it (libigl, OpenVDB) are larger than this plugin, and
// Houdini's own means are not there in the tests. Along a vertical line through each column of the lattice the surface
// is crossed inwards and outwards; what lies between is inside. So overlapping closed parts count once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace fontana::houdini {

struct TriangleMesh {
    std::vector<float> position;                          // 3 a point
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise or clockwise from outside, all alike
};

// Whether each edge is used as often in one direction as in the other. Points at one place count as one.
bool is_closed(const TriangleMesh& mesh);
// Lattice points inside, 3 floats each: multiples of `spacing` plus a half along each axis, so that a mesh that moves
// does not drag its points along. Throws std::runtime_error where there would be more than 2^28 columns or points.
std::vector<float> fill_solid(const TriangleMesh& mesh, double spacing);

struct LatticeBox {
    std::array<double, 3> low, high;
};
// The points of the same lattice in each box for which is_inside(number of the box, 3 floats) holds; the same limit.
std::vector<float> fill_where(const std::vector<LatticeBox>& boxes, double spacing,
                              const std::function<bool(std::size_t, const float*)>& is_inside);

}  // namespace fontana::houdini
