#!/usr/bin/env bash
# compile_sample.sh FILE...: compiles HDK sample sources (SOP_Star.C, SOP_CPPWave.C) against the double.
#
# To show that the double is not bent to our plugin. It fetches nothing: take the samples from a Houdini
# ($HFS/toolkit/samples/SOP) or from SideFX's HDK pages; their licence lets you, but they are not part of this project.
set -euo pipefail
double=$(cd "$(dirname "$0")" && pwd)
[ $# -gt 0 ] || { sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for source in "$@"; do
    name=$(basename "${source%.*}")
    if grep -q THEDSFILE "$source"; then
        python3 "$double/generate_proto.py" "$source" "$work/$name.proto.h"
    fi
    "${CXX:-g++}" -std=c++17 -fsyntax-only -Wno-deprecated -I"$work" -I"$(dirname "$source")" -I"$double/include" \
        -x c++ "$source"
    echo "$source compiles against the double"
done
