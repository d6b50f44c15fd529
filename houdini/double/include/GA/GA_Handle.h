// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "GA/GA_Detail.h"

namespace hdk_double {

// One component of a value, and how many it has.
template <typename T>
struct Components {
    using Base = T;
    static constexpr int count = 1;
    static Base& at(T& value, int) { return value; }
    static Base at(const T& value, int) { return value; }
};
template <typename B>
struct Components<UT_Vector3T<B>> {
    using Base = B;
    static constexpr int count = 3;
    static B& at(UT_Vector3T<B>& value, int i) { return value(static_cast<unsigned>(i)); }
    static B at(const UT_Vector3T<B>& value, int i) { return value(static_cast<unsigned>(i)); }
};

template <typename B>
constexpr bool is_stored_as(GA_Storage storage) {
    if (std::is_same_v<B, float>) return storage == GA_STORE_REAL32;
    if (std::is_same_v<B, double>) return storage == GA_STORE_REAL64;
    if (std::is_same_v<B, int32>) return storage == GA_STORE_INT32;
    return storage == GA_STORE_INT64;
}

// Calls copy(offset, first, count) for each part of a block that lies in one page.
template <typename Copy>
void for_each_page(GA_Offset start, GA_Size count, const Copy& copy) {
    for (GA_Size done = 0; done < count;) {
        const GA_Size piece = std::min(count - done, GA_PAGE_SIZE - (start + done) % GA_PAGE_SIZE);
        copy(start + done, static_cast<std::size_t>(done), static_cast<std::size_t>(piece));
        done += piece;
    }
}

}  // namespace hdk_double

template <typename T>
class GA_ROHandleT {
    using Parts = hdk_double::Components<T>;

 public:
    GA_ROHandleT() = default;
    GA_ROHandleT(const GA_Attribute* attribute) { bind(attribute, 1); }
    GA_ROHandleT(const GA_Detail* detail, GA_AttributeOwner owner, const UT_StringRef& name, int minimum_size = 1) {
        bind(detail->findAttribute(owner, name), minimum_size);
    }
    bool isValid() const { return attribute_ != nullptr; }
    bool isInvalid() const { return attribute_ == nullptr; }
    const GA_Attribute* getAttribute() const { return attribute_; }
    GA_DataId getDataId() const { return attribute_ ? attribute_->getDataId() : GA_INVALID_DATAID; }

    T get(GA_Offset offset, int component = 0) const {
        GA_Attribute::count_single_access();
        return value(offset, component);
    }
    void getBlock(GA_Offset start, GA_Size count, T* destination, int stride = 1, int component = 0) const {
        const auto step = static_cast<std::size_t>(stride);
        hdk_double::for_each_page(start, count, [&](GA_Offset offset, std::size_t first, std::size_t piece) {
            if (step == 1 && is_exact())
                std::memcpy(static_cast<void*>(destination + first), attribute_->place(offset), piece * sizeof(T));
            else
                for (std::size_t k = 0; k < piece; ++k)
                    destination[(first + k) * step] = value(offset + static_cast<GA_Offset>(k), component);
        });
    }

 protected:
    void bind(const GA_Attribute* attribute, int minimum_size) {
        if (attribute && attribute->getTupleSize() >= std::max(minimum_size, Parts::count)) attribute_ = attribute;
    }
    bool is_exact() const {
        return attribute_->getTupleSize() == Parts::count &&
               hdk_double::is_stored_as<typename Parts::Base>(attribute_->storage());
    }
    T value(GA_Offset offset, int component) const {
        T result{};
        for (int c = 0; c < Parts::count; ++c)
            Parts::at(result, c) = static_cast<typename Parts::Base>(attribute_->number(offset, component + c));
        return result;
    }

    const GA_Attribute* attribute_ = nullptr;
};

template <typename T>
class GA_RWHandleT : public GA_ROHandleT<T> {
    using Base = GA_ROHandleT<T>;
    using Parts = hdk_double::Components<T>;

 public:
    GA_RWHandleT() = default;
    GA_RWHandleT(GA_Attribute* attribute) : Base(attribute), writable_(this->isValid() ? attribute : nullptr) {}
    GA_RWHandleT(GA_Detail* detail, GA_AttributeOwner owner, const UT_StringRef& name, int minimum_size = 1)
        : Base(detail, owner, name, minimum_size) {
        writable_ = this->isValid() ? detail->findAttribute(owner, name) : nullptr;
    }
    GA_Attribute* getAttribute() const { return writable_; }
    void bumpDataId() const { writable_->bumpDataId(); }

    void set(GA_Offset offset, const T& value) const {
        GA_Attribute::count_single_access();
        store(offset, value, 0);
    }
    void setBlock(GA_Offset start, GA_Size count, const T* source, int stride = 1, int component = 0) const {
        const auto step = static_cast<std::size_t>(stride);
        hdk_double::for_each_page(start, count, [&](GA_Offset offset, std::size_t first, std::size_t piece) {
            if (step == 1 && this->is_exact())
                std::memcpy(writable_->place(offset), static_cast<const void*>(source + first), piece * sizeof(T));
            else
                for (std::size_t k = 0; k < piece; ++k)
                    store(offset + static_cast<GA_Offset>(k), source[(first + k) * step], component);
        });
    }

 private:
    void store(GA_Offset offset, const T& value, int component) const {
        for (int c = 0; c < Parts::count; ++c)
            writable_->set_number(offset, component + c, static_cast<double>(Parts::at(value, c)));
    }

    GA_Attribute* writable_ = nullptr;
};

using GA_ROHandleF = GA_ROHandleT<fpreal32>;
using GA_ROHandleI = GA_ROHandleT<int32>;
using GA_ROHandleID = GA_ROHandleT<int64>;
using GA_ROHandleV3 = GA_ROHandleT<UT_Vector3F>;
using GA_RWHandleF = GA_RWHandleT<fpreal32>;
using GA_RWHandleI = GA_RWHandleT<int32>;
using GA_RWHandleID = GA_RWHandleT<int64>;
using GA_RWHandleV3 = GA_RWHandleT<UT_Vector3F>;
