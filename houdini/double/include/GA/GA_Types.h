// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Types.h"

// Indices count what is there; offsets are places in memory, and deleting leaves gaps among them.
using GA_Size = exint;
using GA_Index = exint;
using GA_Offset = exint;
using GA_PageNum = exint;
using GA_DataId = int64;

constexpr GA_Offset GA_INVALID_OFFSET = -1;
constexpr GA_DataId GA_INVALID_DATAID = -1;
constexpr GA_Size GA_PAGE_SIZE = 1 << 10;

enum GA_AttributeOwner { GA_ATTRIB_VERTEX, GA_ATTRIB_POINT, GA_ATTRIB_PRIMITIVE, GA_ATTRIB_GLOBAL };
constexpr GA_AttributeOwner GA_ATTRIB_DETAIL = GA_ATTRIB_GLOBAL;
enum GA_Storage { GA_STORE_INT32, GA_STORE_INT64, GA_STORE_REAL32, GA_STORE_REAL64 };
enum GA_TypeInfo { GA_TYPE_VOID, GA_TYPE_POINT, GA_TYPE_VECTOR };

class GA_Defaults {
 public:
    explicit GA_Defaults(int64 value) : value_(static_cast<double>(value)) {}
    explicit GA_Defaults(int32 value) : value_(value) {}
    explicit GA_Defaults(fpreal64 value) : value_(value) {}
    explicit GA_Defaults(fpreal32 value) : value_(static_cast<double>(value)) {}
    double value() const { return value_; }

 private:
    double value_;
};
