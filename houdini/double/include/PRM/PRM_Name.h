// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <memory>
#include <string>
#include <utility>

// As in Houdini the constructor only refers to its texts; setTokenAndLabel copies them.
class PRM_Name {
 public:
    PRM_Name() = default;  // the end of a list
    explicit PRM_Name(const char* token, const char* label = nullptr, int /*flags*/ = 0)
        : token_(token), label_(label ? label : token) {}
    void setTokenAndLabel(const char* token, const char* label) {
        copies_ = std::make_shared<const std::pair<std::string, std::string>>(token, label);
        token_ = copies_->first.c_str();
        label_ = copies_->second.c_str();
    }
    void setAsSentinel() { *this = PRM_Name(); }
    const char* getToken() const { return token_; }
    const char* getLabel() const { return label_; }

 private:
    std::shared_ptr<const std::pair<std::string, std::string>> copies_;
    const char *token_ = nullptr, *label_ = nullptr;
};
