// Typed errors. Inside the library they are exceptions; the C interface turns them into a status and a sentence.
#pragma once

#include <stdexcept>
#include <string>

#include "fontana.h"

namespace fontana {

using Status = fontana_status;

class Error : public std::runtime_error {
 public:
    Error(Status status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
    Status status() const { return status_; }

 private:
    Status status_;
};

[[noreturn]] inline void fail(Status status, const std::string& sentence) { throw Error(status, sentence); }

}  // namespace fontana
