// Of the double, not of the HDK: houdini/double/PROVENANCE.md.
#pragma once

#define SYS_VISIBILITY_EXPORT __attribute__((visibility("default")))
