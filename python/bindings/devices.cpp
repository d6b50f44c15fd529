#include "devices.h"

namespace fontana_python {

Device::Device(const fontana_device& device)
    : backend(device.backend),
      name(device.name),
      driver(device.driver),
      reason(device.reason),
      neighbors(device.neighbors),
      memory_bytes(device.memory_bytes),
      compute_units(device.compute_units),
      is_gpu(device.is_gpu != 0),
      available(device.available != 0) {}

KernelProfile::KernelProfile(const fontana_kernel_profile& row)
    : name(row.name),
      launches(row.launches),
      elements(row.elements),
      seconds(row.seconds),
      bytes(row.bytes),
      flops(row.flops) {}

namespace {

std::vector<Device> devices() {
    const fontana_device* found = nullptr;
    std::size_t count = 0;
    check(fontana_list_devices(&found, &count));
    std::vector<Device> result;
    for (std::size_t k = 0; k < count; ++k) result.emplace_back(found[k]);
    return result;
}

Device choose_device(const std::string& backend) {
    fontana_device device;
    check(fontana_choose_device(backend.c_str(), &device));
    return Device(device);
}

}  // namespace

void bind_devices(nb::module_& m) {
    nb::class_<KernelProfile>(m, "KernelProfile")
        .def_ro("name", &KernelProfile::name)
        .def_ro("launches", &KernelProfile::launches)
        .def_ro("elements", &KernelProfile::elements)
        .def_ro("seconds", &KernelProfile::seconds)
        .def_ro("bytes", &KernelProfile::bytes)
        .def_ro("flops", &KernelProfile::flops);
    nb::class_<Device>(m, "Device")
        .def_ro("backend", &Device::backend)
        .def_ro("name", &Device::name)
        .def_ro("driver", &Device::driver)
        .def_ro("memory_bytes", &Device::memory_bytes)
        .def_ro("compute_units", &Device::compute_units)
        .def_ro("is_gpu", &Device::is_gpu)
        .def_ro("available", &Device::available)
        .def_ro("reason", &Device::reason)
        .def_prop_ro("neighbors", [](const Device& device) { return words(device.neighbors); });
    m.def("devices", &devices);
    m.def("choose_device", &choose_device, nb::arg("backend"));
}

}  // namespace fontana_python
