// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

// A build may define another major version: 20 has plain integers for the indices of inputs.
#ifndef SYS_VERSION_MAJOR_INT
#define SYS_VERSION_MAJOR_INT 21
#endif
#define SYS_VERSION_MINOR_INT 0
