#include "backends/opencl/opencl_profile.h"

namespace fontana {
namespace {

constexpr std::size_t k_most_pending_events = 1024;

}  // namespace

void LaunchProfile::add(const std::string& label, std::uint64_t elements, OpenClEvent event) {
    const std::size_t row = row_of(label);
    ++rows_[row].launches;
    rows_[row].elements += elements;
    pending_.emplace_back(row, std::move(event));
}

bool LaunchProfile::is_full() const { return pending_.size() >= k_most_pending_events; }

cl_int LaunchProfile::collect() {
    cl_int first_error = CL_SUCCESS;
    for (const auto& [row, event] : pending_) {
        cl_ulong begin = 0, end = 0;  // ns
        cl_int code =
            opencl().clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr);
        if (code == CL_SUCCESS)
            code = opencl().clGetEventProfilingInfo(event.get(), CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
        if (code == CL_SUCCESS) rows_[row].seconds += 1e-9 * static_cast<double>(end - begin);
        if (first_error == CL_SUCCESS) first_error = code;
    }
    pending_.clear();
    return first_error;
}

std::size_t LaunchProfile::row_of(const std::string& label) {
    for (std::size_t row = 0; row < rows_.size(); ++row)
        if (rows_[row].name == label) return row;
    ProfileRow row;
    row.name = label;
    rows_.push_back(row);
    return rows_.size() - 1;
}

}  // namespace fontana
