#include "free_places.h"

#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace fontana::houdini {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        return static_cast<std::size_t>(fontana_hash(cell.data(), sizeof cell));
    }
};

Cell cell_of(const float* x, double size) {
    return {std::llround(std::floor(static_cast<double>(x[0]) / size)),
            std::llround(std::floor(static_cast<double>(x[1]) / size)),
            std::llround(std::floor(static_cast<double>(x[2]) / size))};
}

double squared_distance(const float* a, const float* b) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double difference = static_cast<double>(a[k]) - static_cast<double>(b[k]);
        sum += difference * difference;
    }
    return sum;
}

// Points by cell; a particle rules out those near it in its own and the neighbouring cells.
class Candidates {
 public:
    Candidates(const SourcePoints& points, double distance)
        : points_(points), distance_(distance), is_free_(points.count(), true) {
        for (std::size_t k = 0; k < points.count(); ++k)
            cells_[cell_of(&points.position[3 * k], distance)].push_back(k);
    }

    void rule_out_near(const float* particle) {
        const Cell centre = cell_of(particle, distance_);
        for (int k = 0; k < 27; ++k) {
            const auto found = cells_.find({centre[0] + k % 3 - 1, centre[1] + k / 3 % 3 - 1, centre[2] + k / 9 - 1});
            if (found == cells_.end()) continue;
            for (const std::size_t point : found->second)
                if (squared_distance(particle, &points_.position[3 * point]) < distance_ * distance_)
                    is_free_[point] = false;
        }
    }
    bool is_free(std::size_t point) const { return is_free_[point]; }

 private:
    const SourcePoints& points_;
    double distance_;
    std::unordered_map<Cell, std::vector<std::size_t>, CellHash> cells_;
    std::vector<bool> is_free_;
};

void append(std::vector<float>& to, const std::vector<float>& from, std::size_t first, std::size_t count) {
    if (from.empty()) return;
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * count);
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

SourcePoints in_free_places(const SourcePoints& points, const std::vector<float>& particles, double spacing) {
    Candidates candidates(points, 0.9 * spacing);
    for (std::size_t k = 0; k + 2 < particles.size(); k += 3) candidates.rule_out_near(&particles[k]);
    SourcePoints free;
    for (std::size_t k = 0; k < points.count(); ++k) {
        if (!candidates.is_free(k)) continue;
        append(free.position, points.position, k, 3);
        append(free.velocity, points.velocity, k, 3);
        append(free.mass, points.mass, k, 1);
    }
    return free;
}

}  // namespace fontana::houdini
