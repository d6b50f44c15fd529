#include "solid_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace fontana::houdini {
namespace {

constexpr double most = 268435456.0;  // 2^28 columns or points: gigabytes, and surely a mistake in the units

struct Point {
    double x, y, z;
};

// The surface crosses the column (i, k) at height y, upwards into the solid or out of it.
struct Crossing {
    std::int64_t i, k;
    double y;
    int direction;
};

Point corner(const TriangleMesh& mesh, std::uint32_t point) {
    const float* p = &mesh.position[std::size_t{3} * point];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// Twice the signed area of (a, b, (x, z)) seen from above. The ends are put in order first, so that the two triangles
// of an edge get the same number with opposite signs, whatever the rounding.
double side(const Point& a, const Point& b, double x, double z) {
    const bool swap = b.x < a.x || (b.x == a.x && b.z < a.z);
    const Point &first = swap ? b : a, &second = swap ? a : b;
    const double area = (second.x - first.x) * (z - first.z) - (second.z - first.z) * (x - first.x);
    return swap ? -area : area;
}

// A column through an edge belongs to one of its two triangles: the one for which the edge points to larger x, or z.
bool is_within(const Point& a, const Point& b, double x, double z, double orientation) {
    const double s = orientation * side(a, b, x, z);
    if (s != 0.0) return s > 0.0;
    const double dx = orientation * (b.x - a.x), dz = orientation * (b.z - a.z);
    return dx > 0.0 || (dx == 0.0 && dz > 0.0);
}

std::int64_t first_column(double x, double spacing) { return std::llround(std::ceil(x / spacing - 0.5)); }
double centre_of(std::int64_t column, double spacing) { return (static_cast<double>(column) + 0.5) * spacing; }

void require_few(double count, double spacing) {
    if (!(count <= most))
        throw std::runtime_error("a particle spacing of " + std::to_string(spacing) +
                                 " m is too fine for the size of the mesh: choose a larger one");
}

void add_crossings(const Point& a, const Point& b, const Point& c, double spacing, std::vector<Crossing>& crossings) {
    const double area = side(a, b, c.x, c.z);
    if (area == 0.0) return;  // seen edge on: its neighbours cross in its stead
    const double orientation = area > 0.0 ? 1.0 : -1.0;
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_z, high_z] = std::minmax({a.z, b.z, c.z});
    require_few((high_x - low_x) / spacing * ((high_z - low_z) / spacing), spacing);
    for (std::int64_t i = first_column(low_x, spacing); centre_of(i, spacing) <= high_x; ++i) {
        for (std::int64_t k = first_column(low_z, spacing); centre_of(k, spacing) <= high_z; ++k) {
            const double x = centre_of(i, spacing), z = centre_of(k, spacing);
            if (!is_within(a, b, x, z, orientation) || !is_within(b, c, x, z, orientation) ||
                !is_within(c, a, x, z, orientation))
                continue;
            const double wa = side(b, c, x, z) / area, wb = side(c, a, x, z) / area;
            crossings.push_back({i, k, wa * a.y + wb * b.y + (1.0 - wa - wb) * c.y, area > 0.0 ? 1 : -1});
            require_few(static_cast<double>(crossings.size()), spacing);
        }
    }
}

void fill_between(const Crossing& enter, const Crossing& leave, double spacing, std::vector<float>& out) {
    const double count = (leave.y - enter.y) / spacing + static_cast<double>(out.size() / 3);
    require_few(count, spacing);
    for (std::int64_t j = first_column(enter.y, spacing); centre_of(j, spacing) < leave.y; ++j)
        for (const std::int64_t index : {enter.i, j, enter.k})
            out.push_back(static_cast<float>(centre_of(index, spacing)));
}

}  // namespace

bool is_closed(const TriangleMesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> places;
    const auto place = [&](std::uint32_t point) {
        const float* p = &mesh.position[std::size_t{3} * point];
        return places.emplace(std::array<float, 3>{p[0], p[1], p[2]}, places.size()).first->second;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const auto& triangle : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = place(triangle[k]), b = place(triangle[(k + 1) % 3]);
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

std::vector<float> fill_where(const std::vector<LatticeBox>& boxes, double spacing,
                              const std::function<bool(std::size_t, const float*)>& is_inside) {
    std::vector<float> points;
    for (std::size_t n = 0; n < boxes.size(); ++n) {
        std::array<std::int64_t, 3> first, count;
        double all = 1.0;
        for (std::size_t c = 0; c < 3; ++c) {
            require_few((boxes[n].high[c] - boxes[n].low[c]) / spacing, spacing);
            first[c] = first_column(boxes[n].low[c], spacing);
            count[c] = std::max<std::int64_t>(0, first_column(boxes[n].high[c], spacing) - first[c]);
            all *= static_cast<double>(count[c]);
        }
        require_few(all, spacing);
        for (std::int64_t k = 0; k < count[0] * count[1] * count[2]; ++k) {
            const std::array<std::int64_t, 3> index = {k % count[0], k / count[0] % count[1], k / count[0] / count[1]};
            float point[3];
            for (std::size_t c = 0; c < 3; ++c) point[c] = static_cast<float>(centre_of(first[c] + index[c], spacing));
            if (is_inside(n, point)) points.insert(points.end(), point, point + 3);
        }
    }
    return points;
}

std::vector<float> fill_solid(const TriangleMesh& mesh, double spacing) {
    std::vector<Crossing> crossings;
    for (const auto& triangle : mesh.triangles)
        add_crossings(corner(mesh, triangle[0]), corner(mesh, triangle[1]), corner(mesh, triangle[2]), spacing,
                      crossings);
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.i, a.k, a.y, a.direction) < std::tie(b.i, b.k, b.y, b.direction);
    });
    std::vector<float> points;
    int depth = 0;
    for (std::size_t n = 0; n + 1 < crossings.size(); ++n) {
        const Crossing &here = crossings[n], &next = crossings[n + 1];
        depth += here.direction;
        const bool is_same_column = here.i == next.i && here.k == next.k;
        if (!is_same_column)
            depth = 0;
        else if (depth != 0)
            fill_between(here, next, spacing, points);
    }
    return points;
}

}  // namespace fontana::houdini
