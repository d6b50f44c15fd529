// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <memory>

#include "GA/GA_PrimitiveTypeId.h"
#include "GA/GA_Types.h"

class GA_Detail;

class GA_Primitive {
 public:
    GA_Primitive(const GA_Detail& detail, const GA_PrimitiveTypeId& type, GA_Offset first_vertex, GA_Size vertex_count,
                 bool closed);
    virtual ~GA_Primitive() = default;
    const GA_PrimitiveTypeId& getTypeId() const { return type_; }
    GA_Size getVertexCount() const { return vertex_count_; }
    GA_Offset getPointOffset(GA_Size i) const;

    // The double's own.
    virtual std::unique_ptr<GA_Primitive> copy_for(const GA_Detail& detail) const;

 private:
    const GA_Detail* detail_;
    GA_PrimitiveTypeId type_;
    GA_Offset first_vertex_;
    GA_Size vertex_count_;
    bool closed_;
};
