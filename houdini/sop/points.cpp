#include "points.h"

#include <stdexcept>

namespace fontana::houdini {
namespace {

static_assert(sizeof(UT_Vector3F) == 3 * sizeof(float), "vectors are copied as three floats");

template <typename Handle, typename Value>
void append_block(std::vector<float>& to, const Handle& handle, GA_Offset start, GA_Offset end) {
    if (handle.isInvalid()) return;
    const std::size_t before = to.size();
    to.resize(before + static_cast<std::size_t>(end - start) * sizeof(Value) / sizeof(float));
    handle.getBlock(start, end - start, reinterpret_cast<Value*>(to.data() + before));
}

SourcePoints read_range(const GU_Detail& detail, const GA_Range& range, std::vector<int>& is_continuous) {
    const GA_ROHandleV3 position(detail.getP()), velocity(&detail, GA_ATTRIB_POINT, "v");
    const GA_ROHandleF mass(&detail, GA_ATTRIB_POINT, "mass");
    const GA_ROHandleI continuous(&detail, GA_ATTRIB_POINT, continuous_attribute);
    SourcePoints points;
    GA_Offset start, end;
    for (GA_Iterator it(range); it.blockAdvance(start, end);) {
        append_block<GA_ROHandleV3, UT_Vector3F>(points.position, position, start, end);
        append_block<GA_ROHandleV3, UT_Vector3F>(points.velocity, velocity, start, end);
        append_block<GA_ROHandleF, float>(points.mass, mass, start, end);
        const std::size_t before = is_continuous.size();
        is_continuous.resize(before + static_cast<std::size_t>(end - start), 0);
        if (continuous.isValid()) continuous.getBlock(start, end - start, is_continuous.data() + before);
    }
    return points;
}

void keep_some(std::vector<float>& values, std::size_t components, const std::vector<int>& is_kept) {
    if (values.empty()) return;
    std::size_t place = 0;
    for (std::size_t k = 0; k < is_kept.size(); ++k)
        for (std::size_t c = 0; is_kept[k] && c < components; ++c) values[place++] = values[components * k + c];
    values.resize(place);
}

}  // namespace

PointGroup::PointGroup(const GU_Detail& detail, const std::string& pattern) : detail_(detail) {
    if (pattern.empty()) return;
    members_ = groups_.parsePointGroups(pattern.c_str(), GOP_Manager::GroupCreator(&detail));
    if (!members_)
        throw std::runtime_error("the group '" + pattern +
                                 "' is not a point group of the first input; leave it empty to take all points");
}

SourcePoints read_points(const GU_Detail& detail, const std::string& group, PointsWanted wanted) {
    const PointGroup members(detail, group);
    std::vector<int> is_continuous;
    SourcePoints points = read_range(detail, members.range(), is_continuous);
    if (wanted == PointsWanted::all) return points;
    keep_some(points.position, 3, is_continuous);
    keep_some(points.velocity, 3, is_continuous);
    keep_some(points.mass, 1, is_continuous);
    return points;
}

}  // namespace fontana::houdini
