// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#include "SYS/SYS_Visibility.h"

// Included by exactly one source of a plugin: Houdini asks what the plugin was built for before it uses it.
extern "C" SYS_VISIBILITY_EXPORT void HoudiniDSOVersion(const char** version) { *version = "double"; }
extern "C" SYS_VISIBILITY_EXPORT void HoudiniGetTagInfo(const char** info) { *info = ""; }
