// The candidates for neighbours of the particles of a cell, for loops over vectors of them. Included once per
// instruction set, by wide_kernels.cpp, after the vectors and the pair formulas.
#pragma once

namespace fontana::FONTANA_WIDE {

// Farther than any particle can be from another and still be its neighbour, and its square is finite.
constexpr float k_far = 1.0e18f;

inline Vec distance_squared(const float4& a, const Vec4& b) {
    const Vec dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
    return dx * dx + dy * dy + dz * dz;
}

// In columns: read and turned round once, then tested from the first-level cache by all the particles that have the
// same candidates. Where there are more than fit, as with all pairs, each particle reads them for itself.
class Candidates {
 public:
    Candidates(const StepConstants& c, const float4* position, const uint* cell_start)
        : c_(c), position_(position), cell_start_(cell_start) {}

    // All of the particles at x[0] to x[count - 1], count <= k_list_group, in the order of their indices; and perhaps
    // more, of cells that were asked for before.
    void choose(const float4* x, uint count) {
        CellCoordinates cell[k_list_group];
        uint cell_count = 0, known = 0;
        for (uint k = 0; k < count; ++k) {
            const CellCoordinates next = c_.use_grid ? cell_of(c_, x[k]) : CellCoordinates{0u, 0u, 0u};
            if (cell_count > 0 && is_same(next, cell[cell_count - 1])) continue;
            cell[cell_count++] = next;
            if (is_known(next)) ++known;
        }
        if (known == cell_count) return;
        cell_count_ = cell_count;
        for (uint k = 0; k < cell_count; ++k) cell_[k] = cell[k];
        find_ranges();
        read_columns();
    }

    // Whether there are no more than k_room.
    bool are_few() const { return total_ <= k_room; }

    // Calls visit(positions, their indices) for every vector of candidates. Lanes beyond the last candidate are far
    // from everything and weigh nothing.
    template <typename Visit>
    inline __attribute__((always_inline)) void for_all(const Visit& visit) const {
        if (are_few())
            for (uint k = 0; k < count_; k += width)
                visit(Vec4{load(x_ + k), load(y_ + k), load(z_ + k), load(w_ + k)}, index_ + k);
        else
            for_ranges([&](uint first, uint end) {
                alignas(64) uint index[width];
                store_indices(first, index);
                visit(blanked(load(position_ + first), end - first), index);
            });
    }

    static constexpr uint k_room = 1024;

 private:
    static bool is_same(const CellCoordinates& a, const CellCoordinates& b) {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }

    bool is_known(const CellCoordinates& cell) const {
        for (uint k = 0; k < cell_count_; ++k)
            if (is_same(cell, cell_[k])) return true;
        return false;
    }

    // In order, and joined where those of several cells overlap.
    void find_ranges() {
        range_count_ = 0;
        if (are_in_a_row()) {
            const CellCoordinates first = cell_[0], last = cell_[cell_count_ - 1];
            for (uint r = 0; r < 9; ++r)
                insert(
                    {candidate_range(c_, first, r, cell_start_).begin, candidate_range(c_, last, r, cell_start_).end});
        } else {
            for (uint k = 0; k < cell_count_; ++k)
                for (uint r = 0; r < candidate_range_count(c_, cell_[k]); ++r)
                    insert(candidate_range(c_, cell_[k], r, cell_start_));
            join_ranges();
        }
        total_ = 0;
        for (uint r = 0; r < range_count_; ++r) total_ += range_[r].end - range_[r].begin;
    }

    // Side by side along x, or nearly: then so are their candidates.
    bool are_in_a_row() const {
        const CellCoordinates first = cell_[0], last = cell_[cell_count_ - 1];
        return c_.use_grid && first.y == last.y && first.z == last.z && first.x > 0 && first.x <= last.x &&
               last.x < c_.grid_mask_x && last.x - first.x < k_list_group;
    }

    void insert(const Range& range) {
        uint place = range_count_++;
        for (; place > 0 && range_[place - 1].begin > range.begin; --place) range_[place] = range_[place - 1];
        range_[place] = range;
    }

    void join_ranges() {
        uint last = 0;
        for (uint r = 1; r < range_count_; ++r) {
            if (range_[r].begin > range_[last].end)
                range_[++last] = range_[r];
            else if (range_[r].end > range_[last].end)
                range_[last].end = range_[r].end;
        }
        range_count_ = last + 1;
    }

    void read_columns() {
        count_ = 0;
        if (!are_few()) return;
        for_ranges([&](uint first, uint end) { take(load(position_ + first), first, end - first); });
        take(blanked(Vec4{}, 0), 0, 0);
    }

    // Calls visit(first, end of the range) for every vector of every range.
    template <typename Visit>
    inline __attribute__((always_inline)) void for_ranges(const Visit& visit) const {
        for (uint r = 0; r < range_count_; ++r)
            for (uint first = range_[r].begin; first < range_[r].end; first += width) visit(first, range_[r].end);
    }

    static Vec4 blanked(const Vec4& rows, uint valid) {
        if (valid >= width) return rows;
        const uint within = (1u << valid) - 1u;
        return {keep(within, rows.x) + keep(~within, k_far - Vec{}), keep(within, rows.y), keep(within, rows.z),
                keep(within, rows.w)};
    }

    void take(const Vec4& rows, uint first, uint valid) {
        store(x_ + count_, rows.x);
        store(y_ + count_, rows.y);
        store(z_ + count_, rows.z);
        store(w_ + count_, rows.w);
        store_indices(first, index_ + count_);
        count_ += valid < width ? valid : width;
    }

    const StepConstants& c_;
    const float4* position_;
    const uint* cell_start_;
    CellCoordinates cell_[k_list_group];
    uint cell_count_ = 0, range_count_ = 0, total_ = 0, count_ = 0;
    Range range_[18 * k_list_group];
    alignas(64) float x_[k_room + width];
    alignas(64) float y_[k_room + width], z_[k_room + width], w_[k_room + width];
    alignas(64) uint index_[k_room + width];
};

}  // namespace fontana::FONTANA_WIDE
