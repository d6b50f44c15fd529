// A class for each status, under FontanaError.
#include "bindings.h"

namespace fontana_python {

namespace {

PyObject* error_classes[FONTANA_INTERNAL + 1];

// A sentence may name a file whose name is not UTF-8; it is decoded as Python decodes such names.
[[noreturn]] void raise_error(fontana_status status, const char* sentence) {
    const nb::object text = nb::steal(PyUnicode_DecodeFSDefault(sentence));
    if (text.is_valid()) PyErr_SetObject(error_classes[status], text.ptr());
    throw nb::python_error();
}

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
    raise_error(status, fontana_last_error());
}

void bad_input(const std::string& sentence) { raise_error(FONTANA_BAD_INPUT, sentence.c_str()); }

}  // namespace fontana_python
