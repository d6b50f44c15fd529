// Device time by the name of the launch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "backends/backend.h"
#include "backends/opencl/opencl_api.h"

namespace fontana {

// Launches are noted as events and their times read later, when the work is done: asking at once would make the host
// wait for every kernel.
class LaunchProfile {
 public:
    void add(const std::string& label, std::uint64_t elements, OpenClEvent event);
    // Whether so many events wait that they should be collected before more are added.
    bool is_full() const;
    // Reads the times of the events; all of them must have finished. Returns the first error.
    cl_int collect();
    const std::vector<ProfileRow>& rows() const { return rows_; }

 private:
    std::size_t row_of(const std::string& label);

    std::vector<ProfileRow> rows_;
    std::vector<std::pair<std::size_t, OpenClEvent>> pending_;  // a row, and a launch to be added to it
};

}  // namespace fontana
