// What every file of fontana._core needs: nanobind with the conversions in use, and how an error of the library becomes
// a Python exception.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "fontana.h"

namespace fontana_python {

namespace nb = nanobind;
using namespace nb::literals;

using Point = std::array<double, 3>;
// A name as the system has it: its bytes need not be UTF-8, which a std::string's must be.
using FilePath = std::filesystem::path;

// Raises the exception of this status, with the library's sentence; nothing for FONTANA_OK.
void check(fontana_status status);
[[noreturn]] void bad_input(const std::string& sentence);

// The words of "grid|all-pairs".
nb::tuple words(const std::string& choices);

// Each adds one subject to the module. Errors come first: all else may raise them.
void bind_errors(nb::module_& m);
void bind_parameters(nb::module_& m);
void bind_shapes(nb::module_& m);
void bind_devices(nb::module_& m);
void bind_reports(nb::module_& m);
void bind_files(nb::module_& m);
void bind_simulation(nb::module_& m);

}  // namespace fontana_python
