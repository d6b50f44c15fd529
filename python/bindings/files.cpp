// What the library does with files where no simulation is needed.
#include <cstdint>
#include <tuple>

#include "bindings.h"

namespace fontana_python {

namespace {

std::tuple<std::int64_t, std::uint64_t, std::string> checkpoint_info(const FilePath& path) {
    std::int64_t frame = 0;
    std::uint64_t count = 0;
    std::vector<char> tag(std::size_t{1} << 20 | 1);  // the longest a checkpoint may have
    check(fontana_checkpoint_info(path.c_str(), &frame, &count, tag.data(), tag.size()));
    return {frame, count, tag.data()};
}

std::uint64_t publish_file(const FilePath& path, const nb::bytes& data) {
    std::uint64_t hash = 0;
    check(fontana_publish_file(path.c_str(), data.c_str(), data.size(), &hash));
    return hash;
}

std::uint64_t hash(const nb::bytes& data) { return fontana_hash(data.c_str(), data.size()); }

}  // namespace

void bind_files(nb::module_& m) {
    m.def("checkpoint_info", &checkpoint_info, "path"_a);
    m.def("publish_file", &publish_file, "path"_a, "data"_a);
    m.def("hash", &hash, "data"_a);
}

}  // namespace fontana_python
