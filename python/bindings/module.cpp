// fontana._core: the C interface as Python objects. Names, arrays and errors change their form here, and nothing else
// happens: what this module can do, any plugin can.
#include "bindings.h"

NB_MODULE(_core, m) {
    using namespace fontana_python;
    // Tables and errors that Python modules hold until the interpreter ends are no leak worth a page of warnings.
    nb::set_leak_warnings(false);
    m.doc() = "The C interface of Fontana (fontana.h) as Python objects.";
    m.def("version", &fontana_version);
    bind_errors(m);
    bind_parameters(m);
    bind_shapes(m);
    bind_devices(m);
    bind_reports(m);
    bind_files(m);
    bind_simulation(m);
}
