// A class for each status, under FontanaError.
#include "bindings.h"

namespace fontana_python {

namespace {

PyObject* error_classes[FONTANA_INTERNAL + 1];

}  // namespace

void bind_errors(nb::module_& m) {
    PyObject* base = PyErr_NewException("fontana.FontanaError", nullptr, nullptr);
    m.attr("FontanaError") = nb::borrow(base);
    const char* names[] = {nullptr,      "BadInput", "OutOfMemory",  "Unstable", "Interrupted", "DeviceUnavailable",
                           "DeviceLost", "IoError",  "InternalError"};
    for (int status = 1; status <= FONTANA_INTERNAL; ++status) {
        error_classes[status] = PyErr_NewException((std::string("fontana.") + names[status]).c_str(), base, nullptr);
        m.attr(names[status]) = nb::borrow(error_classes[status]);
    }
}

void check(fontana_status status) {
    if (status == FONTANA_OK) return;
    PyErr_SetString(error_classes[status], fontana_last_error());
    throw nb::python_error();
}

void bad_input(const std::string& sentence) {
    PyErr_SetString(error_classes[FONTANA_BAD_INPUT], sentence.c_str());
    throw nb::python_error();
}

}  // namespace fontana_python
