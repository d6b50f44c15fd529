// Geometry of the double.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "GA/GA_Detail.h"
#include "GOP/GOP_Manager.h"

namespace {

std::atomic<GA_DataId> last_data_id{0};
std::atomic<exint> single_accesses{0};

}  // namespace

GA_Attribute::GA_Attribute(GA_AttributeOwner owner, std::string name, GA_Storage storage, int tuple_size,
                           double fallback)
    : owner_(owner),
      name_(std::move(name)),
      storage_(storage),
      tuple_size_(tuple_size),
      fallback_(fallback),
      data_id_(++last_data_id) {}

// The same data has the same id, whichever detail it is in.
GA_Attribute::GA_Attribute(const GA_Attribute& other)
    : GA_Attribute(other.owner_, other.name_.toStdString(), other.storage_, other.tuple_size_, other.fallback_) {
    resize(other.offset_count_);
    const std::size_t page_bytes = GA_PAGE_SIZE * static_cast<std::size_t>(tuple_size_) * element_bytes();
    for (std::size_t page = 0; page < pages_.size(); ++page)
        std::memcpy(pages_[page].get(), other.pages_[page].get(), page_bytes);
    data_id_ = other.data_id_;
    type_info_ = other.type_info_;
}

exint GA_Attribute::single_access_count() { return single_accesses; }
void GA_Attribute::count_single_access() { ++single_accesses; }
void GA_Attribute::bumpDataId() { data_id_ = ++last_data_id; }

std::size_t GA_Attribute::element_bytes() const {
    return storage_ == GA_STORE_INT32 || storage_ == GA_STORE_REAL32 ? 4 : 8;
}

void GA_Attribute::resize(GA_Size offset_count) {
    const auto page_count = static_cast<std::size_t>((offset_count + GA_PAGE_SIZE - 1) / GA_PAGE_SIZE);
    const std::size_t page_bytes = GA_PAGE_SIZE * static_cast<std::size_t>(tuple_size_) * element_bytes();
    while (pages_.size() < page_count) pages_.emplace_back(new char[page_bytes]());
    pages_.resize(page_count);
    const GA_Size before = offset_count_;
    offset_count_ = offset_count;
    if (fallback_ != 0.0)
        for (GA_Offset offset = before; offset < offset_count; ++offset)
            for (int c = 0; c < tuple_size_; ++c) set_number(offset, c, fallback_);
}

const void* GA_Attribute::place(GA_Offset offset) const {
    if (offset < 0 || offset >= offset_count_) throw std::logic_error("double: an offset outside the detail");
    const auto in_page = static_cast<std::size_t>(offset % GA_PAGE_SIZE * tuple_size_);
    return pages_[static_cast<std::size_t>(offset / GA_PAGE_SIZE)].get() + in_page * element_bytes();
}

void* GA_Attribute::place(GA_Offset offset) {
    return const_cast<void*>(static_cast<const GA_Attribute*>(this)->place(offset));
}

double GA_Attribute::number(GA_Offset offset, int component) const {
    const void* tuple = place(offset);
    switch (storage_) {
        case GA_STORE_INT32:
            return static_cast<const int32*>(tuple)[component];
        case GA_STORE_INT64:
            return static_cast<double>(static_cast<const int64*>(tuple)[component]);
        case GA_STORE_REAL32:
            return static_cast<double>(static_cast<const float*>(tuple)[component]);
        case GA_STORE_REAL64:
            return static_cast<const double*>(tuple)[component];
    }
    return 0.0;
}

void GA_Attribute::set_number(GA_Offset offset, int component, double value) {
    void* tuple = place(offset);
    switch (storage_) {
        case GA_STORE_INT32:
            static_cast<int32*>(tuple)[component] = static_cast<int32>(value);
            break;
        case GA_STORE_INT64:
            static_cast<int64*>(tuple)[component] = static_cast<int64>(value);
            break;
        case GA_STORE_REAL32:
            static_cast<float*>(tuple)[component] = static_cast<float>(value);
            break;
        case GA_STORE_REAL64:
            static_cast<double*>(tuple)[component] = value;
            break;
    }
}

GA_Offset GA_IndexMap::append(GA_Size count) {
    const GA_Offset first = offsetSize();
    for (GA_Size k = 0; k < count; ++k) {
        indices_.push_back(indexSize());
        offsets_.push_back(first + k);
    }
    return first;
}

void GA_IndexMap::remove(GA_Offset offset) {
    const GA_Index index = indexFromOffset(offset);
    offsets_.erase(offsets_.begin() + index);
    indices_[static_cast<std::size_t>(offset)] = -1;
    for (GA_Index k = index; k < indexSize(); ++k) indices_[static_cast<std::size_t>(offsetFromIndex(k))] = k;
}

void GA_IndexMap::clear() {
    offsets_.clear();
    indices_.clear();
}

void GA_Iterator::skip_others() {
    while (!atEnd() && range_.group() && !range_.group()->containsOffset(**this)) ++index_;
}

bool GA_Iterator::blockAdvance(GA_Offset& start, GA_Offset& end) {
    if (atEnd()) return false;
    start = **this;
    end = start + 1;
    ++*this;
    while (!atEnd() && **this == end && end % GA_PAGE_SIZE != 0) {
        ++end;
        ++*this;
    }
    return true;
}

GA_Primitive::GA_Primitive(const GA_Detail& detail, const GA_PrimitiveTypeId& type, GA_Offset first_vertex,
                           GA_Size vertex_count, bool closed)
    : detail_(&detail), type_(type), first_vertex_(first_vertex), vertex_count_(vertex_count), closed_(closed) {}

GA_Offset GA_Primitive::getPointOffset(GA_Size i) const { return detail_->getTopology().point_of(first_vertex_ + i); }

std::unique_ptr<GA_Primitive> GA_Primitive::copy_for(const GA_Detail& detail) const {
    return std::make_unique<GA_Primitive>(detail, type_, first_vertex_, vertex_count_, closed_);
}

GA_Offset GA_Topology::append(GA_Size count) {
    const auto first = static_cast<GA_Offset>(points_.size());
    points_.resize(points_.size() + static_cast<std::size_t>(count), GA_INVALID_OFFSET);
    return first;
}

GA_Detail::GA_Detail() { addTuple(GA_STORE_REAL32, GA_ATTRIB_POINT, "P", 3); }

GA_Offset GA_Detail::appendPointBlock(GA_Size count) {
    const GA_Offset first = points_.append(count);
    for (auto& attribute : attributes_)
        if (attribute->getOwner() == GA_ATTRIB_POINT) attribute->resize(points_.offsetSize());
    return first;
}

bool GA_Detail::destroyPointOffset(GA_Offset offset) {
    if (!points_.is_active(offset)) return false;
    for (auto& [name, group] : point_groups_) group.remove(offset);
    points_.remove(offset);
    return true;
}

void GA_Detail::clearAndDestroy() {
    points_.clear();
    topology_.clear();
    primitives_.clear();
    point_groups_.clear();
    attributes_.clear();
    addTuple(GA_STORE_REAL32, GA_ATTRIB_POINT, "P", 3);
}

void GA_Detail::replaceWith(const GA_Detail& other) {
    points_ = other.points_;
    topology_ = other.topology_;
    point_groups_ = other.point_groups_;
    primitives_.clear();
    for (const auto& primitive : other.primitives_) primitives_.push_back(primitive->copy_for(*this));
    attributes_.clear();
    for (const auto& attribute : other.attributes_) attributes_.push_back(std::make_unique<GA_Attribute>(*attribute));
}

UT_Vector3 GA_Detail::getPos3(GA_Offset offset) const {
    const GA_Attribute* p = getP();
    return UT_Vector3(static_cast<float>(p->number(offset, 0)), static_cast<float>(p->number(offset, 1)),
                      static_cast<float>(p->number(offset, 2)));
}

void GA_Detail::setPos3(GA_Offset offset, const UT_Vector3& position) {
    for (int c = 0; c < 3; ++c) getP()->set_number(offset, c, static_cast<double>(position(static_cast<unsigned>(c))));
}

const GA_Attribute* GA_Detail::findAttribute(GA_AttributeOwner owner, const UT_StringRef& name) const {
    for (const auto& attribute : attributes_)
        if (attribute->getOwner() == owner && attribute->getName() == name) return attribute.get();
    return nullptr;
}

GA_Attribute* GA_Detail::findAttribute(GA_AttributeOwner owner, const UT_StringRef& name) {
    return const_cast<GA_Attribute*>(static_cast<const GA_Detail*>(this)->findAttribute(owner, name));
}

GA_Attribute* GA_Detail::addTuple(GA_Storage storage, GA_AttributeOwner owner, const UT_StringHolder& name,
                                  int tuple_size, const GA_Defaults& defaults) {
    GA_Attribute* present = findAttribute(owner, name);
    if (present && present->storage() == storage && present->getTupleSize() == tuple_size) return present;
    if (present)
        attributes_.erase(
            std::find_if(attributes_.begin(), attributes_.end(), [&](const auto& a) { return a.get() == present; }));
    attributes_.push_back(
        std::make_unique<GA_Attribute>(owner, name.toStdString(), storage, tuple_size, defaults.value()));
    attributes_.back()->resize(owner == GA_ATTRIB_POINT ? points_.offsetSize() : 1);
    return attributes_.back().get();
}

GA_PointGroup* GA_Detail::newPointGroup(const UT_StringHolder& name) {
    return &point_groups_.emplace(name.toStdString(), GA_PointGroup(name.toStdString())).first->second;
}

const GA_PointGroup* GA_Detail::findPointGroup(const UT_StringRef& name) const {
    const auto found = point_groups_.find(name.toStdString());
    return found == point_groups_.end() ? nullptr : &found->second;
}

GA_PointGroup* GA_Detail::findPointGroup(const UT_StringRef& name) {
    return const_cast<GA_PointGroup*>(static_cast<const GA_Detail*>(this)->findPointGroup(name));
}

GA_Offset GA_Detail::appendPrimitivesAndVertices(const GA_PrimitiveTypeId& type, GA_Size count, GA_Size vertices_each,
                                                 GA_Offset& first_vertex, bool closed) {
    const GA_Offset first = getNumPrimitives();
    first_vertex = topology_.append(count * vertices_each);
    for (GA_Size k = 0; k < count; ++k)
        append(std::make_unique<GA_Primitive>(*this, type, first_vertex + k * vertices_each, vertices_each, closed));
    return first;
}

const GA_Primitive* GA_Detail::getPrimitiveByIndex(GA_Index index) const {
    return primitives_[static_cast<std::size_t>(index)].get();
}

void GA_Detail::bumpDataIdsForAddOrRemove(bool points, bool, bool) {
    if (points) bumpAllDataIds();
}

void GA_Detail::bumpAllDataIds() {
    for (auto& attribute : attributes_) attribute->bumpDataId();
}

std::vector<std::string> GA_Detail::attribute_names(GA_AttributeOwner owner) const {
    std::vector<std::string> names;
    for (const auto& attribute : attributes_)
        if (attribute->getOwner() == owner) names.push_back(attribute->getName().toStdString());
    return names;
}

const GA_PointGroup* GOP_Manager::parsePointGroups(const char* pattern, const GroupCreator& creator, bool, bool, bool,
                                                   GA_Index, ParseInfo*) {
    std::istringstream names(pattern ? pattern : "");
    GA_PointGroup merged("");
    std::string name;
    while (names >> name) {
        const GA_PointGroup* group = creator.getDetail()->findPointGroup(name);
        if (!group) return nullptr;
        for (GA_Iterator it(creator.getDetail()->getPointRange(group)); !it.atEnd(); ++it) merged.addOffset(*it);
    }
    made_.push_back(merged);
    return &made_.back();
}
