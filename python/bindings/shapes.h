// Colliders and emitters from a word and keyword arguments.
#pragma once

#include "bindings.h"

namespace fontana_python {

// Fields that are not given have the library's defaults; an unknown type or field is BadInput.
fontana_collider collider_from(const std::string& type, const nb::kwargs& keywords);
fontana_emitter emitter_from(const std::string& type, const nb::kwargs& keywords);

}  // namespace fontana_python
