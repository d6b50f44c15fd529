// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

class GA_PrimitiveTypeId {
 public:
    GA_PrimitiveTypeId() = default;
    GA_PrimitiveTypeId(int id) : id_(id) {}
    int get() const { return id_; }
    bool operator==(int other) const { return id_ == other; }
    bool operator!=(int other) const { return id_ != other; }
    bool operator==(const GA_PrimitiveTypeId& other) const { return id_ == other.id_; }
    bool operator!=(const GA_PrimitiveTypeId& other) const { return id_ != other.id_; }

 private:
    int id_ = -1;
};
