// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "GA/GA_Attribute.h"
#include "GA/GA_ElementGroup.h"
#include "GA/GA_IndexMap.h"
#include "GA/GA_Iterator.h"
#include "GA/GA_Primitive.h"
#include "UT/UT_Vector3.h"

class GA_Topology {
 public:
    void wireVertexPoint(GA_Offset vertex, GA_Offset point) { points_[static_cast<std::size_t>(vertex)] = point; }

    // The double's own.
    GA_Offset append(GA_Size count);
    GA_Offset point_of(GA_Offset vertex) const { return points_[static_cast<std::size_t>(vertex)]; }
    void clear() { points_.clear(); }

 private:
    std::vector<GA_Offset> points_;
};

// Points and polygons. Attributes of points and of the detail alone.
class GA_Detail {
 public:
    GA_Detail();
    virtual ~GA_Detail() = default;
    GA_Detail(const GA_Detail&) = delete;
    GA_Detail& operator=(const GA_Detail&) = delete;

    GA_Offset appendPointBlock(GA_Size count);
    GA_Offset appendPoint() { return appendPointBlock(1); }
    bool destroyPointOffset(GA_Offset offset);
    void clearAndDestroy();
    void replaceWith(const GA_Detail& other);

    GA_Size getNumPoints() const { return points_.indexSize(); }
    GA_Size getNumPrimitives() const { return static_cast<GA_Size>(primitives_.size()); }
    GA_Offset pointOffset(GA_Index index) const { return points_.offsetFromIndex(index); }
    GA_Index pointIndex(GA_Offset offset) const { return points_.indexFromOffset(offset); }
    const GA_IndexMap& getPointMap() const { return points_; }
    GA_Range getPointRange(const GA_PointGroup* group = nullptr) const { return GA_Range(points_, group); }

    GA_Attribute* getP() { return attributes_.front().get(); }
    const GA_Attribute* getP() const { return attributes_.front().get(); }
    UT_Vector3 getPos3(GA_Offset offset) const;
    void setPos3(GA_Offset offset, const UT_Vector3& position);
    GA_Attribute* findAttribute(GA_AttributeOwner owner, const UT_StringRef& name);
    const GA_Attribute* findAttribute(GA_AttributeOwner owner, const UT_StringRef& name) const;
    GA_Attribute* findPointAttribute(const UT_StringRef& name) { return findAttribute(GA_ATTRIB_POINT, name); }
    const GA_Attribute* findPointAttribute(const UT_StringRef& name) const {
        return findAttribute(GA_ATTRIB_POINT, name);
    }
    GA_Attribute* addFloatTuple(GA_AttributeOwner owner, const UT_StringHolder& name, int tuple_size,
                                const GA_Defaults& defaults = GA_Defaults(0.0)) {
        return addTuple(GA_STORE_REAL32, owner, name, tuple_size, defaults);
    }
    GA_Attribute* addIntTuple(GA_AttributeOwner owner, const UT_StringHolder& name, int tuple_size,
                              const GA_Defaults& defaults = GA_Defaults(0)) {
        return addTuple(GA_STORE_INT32, owner, name, tuple_size, defaults);
    }
    GA_Attribute* addTuple(GA_Storage storage, GA_AttributeOwner owner, const UT_StringHolder& name, int tuple_size,
                           const GA_Defaults& defaults = GA_Defaults(0.0));

    GA_PointGroup* newPointGroup(const UT_StringHolder& name);
    GA_PointGroup* findPointGroup(const UT_StringRef& name);
    const GA_PointGroup* findPointGroup(const UT_StringRef& name) const;

    GA_Offset appendPrimitivesAndVertices(const GA_PrimitiveTypeId& type, GA_Size count, GA_Size vertices_each,
                                          GA_Offset& first_vertex, bool closed = false);
    const GA_Primitive* getPrimitiveByIndex(GA_Index index) const;
    GA_Topology& getTopology() { return topology_; }
    const GA_Topology& getTopology() const { return topology_; }

    void bumpDataIdsForAddOrRemove(bool points, bool vertices, bool primitives);
    void bumpAllDataIds();

    // The double's own.
    std::vector<std::string> attribute_names(GA_AttributeOwner owner) const;
    void append(std::unique_ptr<GA_Primitive> primitive) { primitives_.push_back(std::move(primitive)); }

 private:
    GA_IndexMap points_;
    GA_Topology topology_;
    std::vector<std::unique_ptr<GA_Primitive>> primitives_;
    std::vector<std::unique_ptr<GA_Attribute>> attributes_;  // the first is P
    std::map<std::string, GA_PointGroup> point_groups_;
};
using GEO_Detail = GA_Detail;
