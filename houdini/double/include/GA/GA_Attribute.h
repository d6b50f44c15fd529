// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "GA/GA_Types.h"
#include "UT/UT_StringHolder.h"

// Values of one kind for every offset, in pages of GA_PAGE_SIZE offsets, each page a block of memory of its own.
class GA_Attribute {
 public:
    GA_Attribute(GA_AttributeOwner owner, std::string name, GA_Storage storage, int tuple_size, double fallback);

    GA_AttributeOwner getOwner() const { return owner_; }
    const UT_StringHolder& getName() const { return name_; }
    int getTupleSize() const { return tuple_size_; }
    GA_DataId getDataId() const { return data_id_; }
    void bumpDataId();
    void setTypeInfo(GA_TypeInfo info) { type_info_ = info; }
    GA_TypeInfo getTypeInfo() const { return type_info_; }

    // The double's own.
    GA_Storage storage() const { return storage_; }
    void resize(GA_Size offset_count);
    double number(GA_Offset offset, int component) const;
    void set_number(GA_Offset offset, int component, double value);
    // Memory of the tuple at `offset`; the tuples up to the end of its page follow.
    void* place(GA_Offset offset);
    const void* place(GA_Offset offset) const;
    GA_Attribute(const GA_Attribute& other);
    GA_Attribute& operator=(const GA_Attribute&) = delete;
    // How often a value was read or set one by one, rather than by block, in all attributes.
    static exint single_access_count();
    static void count_single_access();

 private:
    std::size_t element_bytes() const;

    GA_AttributeOwner owner_;
    UT_StringHolder name_;
    GA_Storage storage_;
    int tuple_size_;
    double fallback_;
    GA_DataId data_id_;
    GA_TypeInfo type_info_ = GA_TYPE_VOID;
    GA_Size offset_count_ = 0;
    std::vector<std::unique_ptr<char[]>> pages_;
};
using GA_ATINumeric = GA_Attribute;
