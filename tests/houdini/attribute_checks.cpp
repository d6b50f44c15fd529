// What the solver reads from its input's points and writes to its own.
#include <GA/GA_Handle.h>

#include <algorithm>

#include "checks.h"
#include "scene.h"

namespace {

void names_and_types() {
    BlockScene scene;
    const GU_Detail& detail = hdk_double::cook(*scene.solver, 4);
    const struct {
        const char* name;
        int size;
        GA_Storage storage;
    } expected[] = {{"P", 3, GA_STORE_REAL32},       {"v", 3, GA_STORE_REAL32},        {"id", 1, GA_STORE_INT64},
                    {"density", 1, GA_STORE_REAL32}, {"pressure", 1, GA_STORE_REAL32}, {"pscale", 1, GA_STORE_REAL32},
                    {"age", 1, GA_STORE_REAL32}};
    CHECK(detail.attribute_names(GA_ATTRIB_POINT).size() == std::size(expected));
    for (const auto& e : expected) {
        const GA_Attribute* attribute = detail.findPointAttribute(e.name);
        CHECK(attribute && attribute->getTupleSize() == e.size && attribute->storage() == e.storage);
    }
    CHECK(detail.findPointAttribute("v")->getTypeInfo() == GA_TYPE_VECTOR);
    const GA_ROHandleID id(&detail, GA_ATTRIB_POINT, "id");
    const GA_ROHandleF pscale(&detail, GA_ATTRIB_POINT, "pscale"), age(&detail, GA_ATTRIB_POINT, "age"),
        density(&detail, GA_ATTRIB_POINT, "density");
    for (GA_Index k = 0; k < detail.getNumPoints(); ++k) {
        const GA_Offset offset = detail.pointOffset(k);
        CHECK(id.get(offset) == k);
        CHECK(pscale.get(offset) == 0.025f);  // a radius: half the spacing
        CHECK(std::abs(age.get(offset) - 3.0f / 240.0f) < 1e-6f);
        CHECK(density.get(offset) > 100.0f);
    }
}

void the_scale_of_the_scene() {
    BlockScene scene;
    set_float(*scene.solver, "time_simulation_scale", 0.5);
    set_float(*scene.solver, "fluid_particle_spacing", 0.025);
    const GU_Detail& detail = hdk_double::cook(*scene.solver, 2);
    CHECK(GA_ROHandleF(&detail, GA_ATTRIB_POINT, "pscale").get(detail.pointOffset(0)) == 0.025f);
}

// More than a page of points; what is read and written goes by block.
void no_point_is_touched_one_by_one() {
    BlockScene scene(12);
    set_int(*scene.solver, "time_substeps", 2);
    hdk_double::cook(*scene.solver, 1);
    const exint before = GA_Attribute::single_access_count();
    hdk_double::cook(*scene.solver, 2);
    scene.edit();
    hdk_double::cook(*scene.solver, 3);
    CHECK(GA_Attribute::single_access_count() == before);
}

void data_ids_tell_what_changed() {
    BlockScene scene;
    const GU_Detail* detail = &hdk_double::cook(*scene.solver, 2);
    const GA_DataId p = detail->getP()->getDataId(), id = detail->findPointAttribute("id")->getDataId(),
                    pscale = detail->findPointAttribute("pscale")->getDataId();
    detail = &hdk_double::cook(*scene.solver, 3);
    CHECK(detail->getP()->getDataId() != p);
    CHECK(detail->findPointAttribute("id")->getDataId() == id);
    CHECK(detail->findPointAttribute("pscale")->getDataId() == pscale);
}

// A solver on a block whose points have what `dress` gives them.
template <typename Dress>
std::uint64_t dressed(const Dress& dress, std::string* said = nullptr) {
    BlockScene scene;
    SOP_Node& source = scene.network.create_geometry("dressed", [&](GU_Detail& detail, fpreal) {
        add_block(detail, 5, 0.0f);
        dress(detail);
    });
    scene.solver->setInput(0, &source);
    const std::uint64_t hash = hash_at(scene, 4);
    if (said) *said = sentences(*scene.solver);
    return hash;
}

template <typename Value>
void set_number(GU_Detail& detail, const char* name, const Value& value) {
    GA_Attribute* attribute = detail.addFloatTuple(GA_ATTRIB_POINT, name, 1);
    for (GA_Index k = 0; k < detail.getNumPoints(); ++k) attribute->set_number(detail.pointOffset(k), 0, value(k));
}

void velocity_and_mass_are_taken() {
    const std::uint64_t plain = dressed([](GU_Detail&) {});
    CHECK(plain == played(4).back());
    CHECK(plain != dressed([](GU_Detail& detail) { detail.addFloatTuple(GA_ATTRIB_POINT, "v", 3, GA_Defaults(1.0)); }));
    CHECK(plain != dressed([](GU_Detail& detail) {
              set_number(detail, "mass", [](GA_Index k) { return k % 2 ? 0.1 : 0.125; });
          }));
    std::string said;
    dressed([](GU_Detail& detail) { set_number(detail, "mass", [](GA_Index) { return 0.0; }); }, &said);
    CHECK(contains(said, "the mass of particle 0"));
}

void a_group_of_several_systems() {
    BlockScene scene;
    SOP_Node& both = scene.network.create_geometry("both", [](GU_Detail& detail, fpreal) {
        add_block(detail, 4, 0.0f);
        add_block(detail, 5, 1.0f);
        GA_PointGroup* group = detail.newPointGroup("upper");
        for (GA_Index k = 64; k < detail.getNumPoints(); ++k) group->addOffset(detail.pointOffset(k));
    });
    scene.solver->setInput(0, &both);
    CHECK(hdk_double::cook(*scene.solver, 3).getNumPoints() == 64 + 125);
    scene.solver->setString("upper", CH_STRING_LITERAL, "source_group", 0, 0.0);
    CHECK(hdk_double::cook(*scene.solver, 3).getNumPoints() == 125);
    scene.solver->setString("lower", CH_STRING_LITERAL, "source_group", 0, 0.0);
    hdk_double::cook(*scene.solver, 3);
    CHECK(contains(sentences(*scene.solver), "'lower' is not a point group"));
}

void activation_off_passes_through() {
    BlockScene scene;
    const std::uint64_t before = hash_at(scene, 4);
    set_int(*scene.solver, "activation", 0);
    CHECK(hash_at(scene, 4) == hash_of(hdk_double::cook(*scene.source, 4)));
    set_int(*scene.solver, "activation", 1);
    CHECK(hash_at(scene, 4) == before);
}

void the_info_panel() {
    BlockScene scene;
    hdk_double::cook(*scene.solver, 4);
    std::string text;
    const UT_InfoTree tree = hdk_double::info_of(*scene.solver, 4);
    for (const auto& [name, value] : tree.children().front().rows()) text += name + ": " + value + "\n";
    for (const char* part : {"Frame: 4\n", "Particles: 125\n", "Substeps: ", "limited by ",
                             "Iterations: ", "Density error: ", "Time of the frame: ", "Device: cpu",
                             "Device memory: ", "History: 4 frames"})
        CHECK(contains(text, part));
}

}  // namespace

void check_attributes() {
    names_and_types();
    the_scale_of_the_scene();
    no_point_is_touched_one_by_one();
    data_ids_tell_what_changed();
    velocity_and_mass_are_taken();
    a_group_of_several_systems();
    activation_off_passes_through();
    the_info_panel();
}
