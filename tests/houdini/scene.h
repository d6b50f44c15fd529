// What the checks of the Houdini plugin share: a small network on the double, and the bytes it makes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hdk_double/hdk_double.h"
#include "io/checks.h"

// Just above the lowest particles of a block, so that the floor matters from the first frame on.
constexpr double floor_height = 0.055;

// A block of particles on a floor, on the cpu, in frames of few substeps.
class BlockScene {
 public:
    explicit BlockScene(int side = 5, bool changes_with_time = false);

    hdk_double::Network network;
    SOP_Node* source;
    SOP_Node* solver;
    // What the next cook of the source makes; edit() tells it so.
    int side;
    float lift = 0.0f;  // m
    void edit() { source->forceRecook(); }
};

// `side`^3 points at the spacing 0.05, somewhat off a lattice.
void add_block(GU_Detail& detail, int side, float lift);

using Bytes = std::vector<unsigned char>;
// Every output attribute of every point, in order of index.
std::uint64_t hash_of(const GU_Detail& detail);
std::uint64_t hash_at(BlockScene& scene, double frame);
// Hashes of frames 1 to `last`, each from a scene of its own that was played.
std::vector<std::uint64_t> played(int last);
// The sentences of a node, one a line.
std::string sentences(const SOP_Node& node);
void set_int(SOP_Node& node, const char* name, int value);
void set_float(SOP_Node& node, const char* name, double value, int component = 0);
// Adds a collider of this type through the panel; returns its number.
int add_collider(SOP_Node& node, int type);
