// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <functional>
#include <utility>

#include "GA/GA_Primitive.h"
#include "GA/GA_PrimitiveTypes.h"
#include "UT/UT_BoundingBox.h"

// A function of space in place of a grid.
class GEO_PrimVDB : public GA_Primitive {
 public:
    using Field = std::function<fpreal(const UT_Vector3&)>;
    GEO_PrimVDB(const GA_Detail& detail, UT_BoundingBox box, bool is_sdf, Field field)
        : GA_Primitive(detail, GA_PRIMVDB, 0, 0, false), box_(box), is_sdf_(is_sdf), field_(std::move(field)) {}

    bool isSDF() const { return is_sdf_; }
    fpreal getValueF(const UT_Vector3& position) const { return field_(position); }
    bool getBBox(UT_BoundingBox* box) const {
        *box = box_;
        return true;
    }
    std::unique_ptr<GA_Primitive> copy_for(const GA_Detail& detail) const override {
        return std::make_unique<GEO_PrimVDB>(detail, box_, is_sdf_, field_);
    }

 private:
    UT_BoundingBox box_;
    bool is_sdf_;
    Field field_;
};
