// Device time by the name of the launch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "backends/backend.h"

namespace fontana {

// Launches are noted as events and their times read later, when the work is done: asking at once would make the host
// wait for every kernel. `Event` owns what a driver tells the time of one launch by.
template <typename Event>
class LaunchProfile {
 public:
    void add(const std::string& label, std::uint64_t elements, Event event) {
        const std::size_t row = row_of(label);
        ++rows_[row].launches;
        rows_[row].elements += elements;
        pending_.emplace_back(row, std::move(event));
    }

    // Whether so many events wait that they should be collected before more are added.
    bool is_full() const { return pending_.size() >= 1024; }

    // Reads the times of the events; all of them must have finished. `read_seconds(event, seconds)` returns the
    // driver's error code, 0 for none. Returns the first error.
    template <typename ReadSeconds>
    int collect(const ReadSeconds& read_seconds) {
        int first_error = 0;
        for (const auto& [row, event] : pending_) {
            double seconds = 0.0;
            const int code = read_seconds(event, seconds);
            if (code == 0) rows_[row].seconds += seconds;
            if (first_error == 0) first_error = code;
        }
        pending_.clear();
        return first_error;
    }

    const std::vector<ProfileRow>& rows() const { return rows_; }

 private:
    std::size_t row_of(const std::string& label) {
        for (std::size_t row = 0; row < rows_.size(); ++row)
            if (rows_[row].name == label) return row;
        ProfileRow row;
        row.name = label;
        rows_.push_back(row);
        return rows_.size() - 1;
    }

    std::vector<ProfileRow> rows_;
    std::vector<std::pair<std::size_t, Event>> pending_;  // a row, and a launch to be added to it
};

}  // namespace fontana
