// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <memory>

#include "GU/GU_Detail.h"

class GU_DetailHandle {
 public:
    void allocateAndSet(GU_Detail* detail, bool own = true) {
        detail_ = own ? std::shared_ptr<GU_Detail>(detail) : std::shared_ptr<GU_Detail>(detail, [](GU_Detail*) {});
    }
    bool isNull() const { return !detail_; }
    bool isValid() const { return !isNull(); }
    const GU_Detail* gdp() const { return detail_.get(); }
    GU_Detail* gdpNC() { return detail_.get(); }

 private:
    std::shared_ptr<GU_Detail> detail_;
};

class GU_ConstDetailHandle {
 public:
    GU_ConstDetailHandle() = default;
    GU_ConstDetailHandle(const GU_DetailHandle& handle) : handle_(handle) {}
    bool isNull() const { return handle_.isNull(); }
    bool isValid() const { return handle_.isValid(); }
    const GU_Detail* gdp() const { return handle_.gdp(); }

 private:
    GU_DetailHandle handle_;
};
