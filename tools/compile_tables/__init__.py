"""What compilers for devices make of the kernels, a module a vendor. Each has

missing() -> str | None               why it cannot compile here; None where it can
TARGETS                               the architectures it is asked for by default
rows(kernel_source, architectures)    a dict a kernel and architecture: kernel, compiler, target; registers, spill_bytes
                                      and scratch_bytes of a thread, shared_bytes of a work-group, each None where the
                                      target does not say; and what else the compiler tells
"""
