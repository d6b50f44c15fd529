#include "scene.h"

#include <GA/GA_Handle.h>

#include "fontana.h"

void add_block(GU_Detail& detail, int side, float lift) {
    const float spacing = 0.05f;
    const GA_Offset first = detail.appendPointBlock(GA_Size{side} * side * side);
    GA_Offset offset = first;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (int k = 0; k < side; ++k, ++offset) {
                const float shift = 0.002f * static_cast<float>((7 * i + 3 * j + 5 * k) % 5);
                detail.setPos3(offset, UT_Vector3(spacing * static_cast<float>(i) + shift,
                                                  spacing * static_cast<float>(j) + lift + 0.05f,
                                                  spacing * static_cast<float>(k) - shift));
            }
}

BlockScene::BlockScene(int block_side, bool changes_with_time) : side(block_side) {
    source = &network.create_geometry(
        "block", [this](GU_Detail& detail, fpreal) { add_block(detail, side, lift); }, changes_with_time);
    solver = &network.create("fontana::solver::1.0", "solver");
    solver->setInput(0, source);
    set_int(*solver, "use_gpu", 0);
    set_int(*solver, "solver_threads", 1);
    set_float(*solver, "fluid_particle_spacing", 0.05);
    set_int(*solver, "use_scene_rate", 0);
    set_float(*solver, "time_frame_rate", 240.0);
    add_collider(*solver, FONTANA_PLANE_Y);
    set_float(*solver, "collider_centre1", floor_height, 1);
}

std::uint64_t hash_of(const GU_Detail& detail) {
    Bytes bytes;
    for (const std::string& name : detail.attribute_names(GA_ATTRIB_POINT)) {
        const GA_Attribute* attribute = detail.findPointAttribute(name);
        for (GA_Iterator it(detail.getPointRange()); !it.atEnd(); ++it)
            for (int c = 0; c < attribute->getTupleSize(); ++c) {
                const double value = attribute->number(*it, c);
                const auto* first = reinterpret_cast<const unsigned char*>(&value);
                bytes.insert(bytes.end(), first, first + sizeof value);
            }
    }
    return fontana_hash(bytes.data(), bytes.size());
}

std::uint64_t hash_at(BlockScene& scene, double frame) { return hash_of(hdk_double::cook(*scene.solver, frame)); }

std::vector<std::uint64_t> played(int last) {
    BlockScene scene;
    std::vector<std::uint64_t> hashes;
    for (int frame = 1; frame <= last; ++frame) hashes.push_back(hash_at(scene, frame));
    return hashes;
}

std::string sentences(const SOP_Node& node) {
    std::string text;
    for (const UT_ErrorManager::Entry& entry : node.messages()) text += entry.text + "\n";
    return text;
}

void set_int(SOP_Node& node, const char* name, int value) { node.setInt(name, 0, 0.0, value); }

void set_float(SOP_Node& node, const char* name, double value, int component) {
    node.setFloat(name, component, 0.0, value);
}

int add_collider(SOP_Node& node, int type) {
    const int number = static_cast<int>(node.evalInt("colliders", 0, 0.0)) + 1;
    set_int(node, "colliders", number);
    set_int(node, ("collider_type" + std::to_string(number)).c_str(), type);
    return number;
}
