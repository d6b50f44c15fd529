// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include <iosfwd>
#include <map>
#include <memory>
#include <string>

#include "OP/OP_Operator.h"

class OP_OperatorTable {
 public:
    bool addOperator(OP_Operator* entry, std::ostream* errors = nullptr);
    OP_Operator* getOperator(const char* name) const;

    // The double's own.
    const std::map<std::string, std::unique_ptr<OP_Operator>>& operators() const { return operators_; }

 private:
    std::map<std::string, std::unique_ptr<OP_Operator>> operators_;
};
