#include "source_node.h"

#include <GU/GU_Detail.h>
#include <PRM/PRM_TemplateBuilder.h>
#include <SOP/SOP_NodeVerb.h>

#include <algorithm>
#include <stdexcept>

#include "SOP_FontanaSource.proto.h"
#include "points.h"
#include "source_particles.h"

using namespace fontana::houdini;

const char* const SOP_FontanaSourceNode::type_name = "fontana::source::1.0";

namespace {

class SourceVerb final : public SOP_NodeVerb {
 public:
    SOP_NodeParms* allocParms() const override { return new SOP_FontanaSourceParms; }
    UT_StringHolder name() const override { return SOP_FontanaSourceNode::type_name; }
    CookMode cookMode(const SOP_NodeParms*) const override { return COOK_GENERIC; }
    void cook(const CookParms& cookparms) const override;

    static const SOP_NodeVerb::Register<SourceVerb> the_verb;
};
const SOP_NodeVerb::Register<SourceVerb> SourceVerb::the_verb;

template <typename Value>
void set_all(std::vector<Value>& values, std::size_t count, bool wanted, Value value) {
    if (wanted) values.assign(count, value);
}

// What the panel says on top of what the input brought.
void apply_panel(const SOP_FontanaSourceParms& parms, SourceParticles& particles) {
    const std::size_t count = particles.count();
    const UT_Vector3D added = parms.getVelocity();
    const bool adds = std::any_of(added.data(), added.data() + 3, [](double v) { return v != 0.0; });
    if (particles.velocity.empty() && adds) particles.velocity.assign(3 * count, 0.0f);
    for (std::size_t k = 0; k < particles.velocity.size(); ++k)
        particles.velocity[k] += static_cast<float>(added.data()[k % 3]);
    set_all(particles.mass, count, parms.getSetMass() && parms.getMass() > 0.0, static_cast<float>(parms.getMass()));
    set_all(particles.viscosity, count, parms.getSetViscosity(), static_cast<float>(parms.getViscosity()));
    set_all(particles.phase, count, parms.getSetPhase(), static_cast<int32>(parms.getPhase()));
    set_all(particles.continuous, count, parms.getEmission() == SOP_FontanaSourceEnums::Emission::CONTINUOUS, 1);
}

void write(const SourceParticles& particles, GU_Detail& detail) {
    detail.clearAndDestroy();
    detail.appendPointBlock(static_cast<GA_Size>(particles.count()));
    detail.bumpDataIdsForAddOrRemove(true, true, true);
    const auto vectors = [&](GA_Attribute* attribute, const std::vector<float>& values) {
        write_by_page(detail, GA_RWHandleV3(attribute), reinterpret_cast<const UT_Vector3F*>(values.data()));
    };
    vectors(detail.getP(), particles.position);
    if (!particles.velocity.empty()) {
        GA_Attribute* velocity = detail.addFloatTuple(GA_ATTRIB_POINT, "v", 3);
        velocity->setTypeInfo(GA_TYPE_VECTOR);
        vectors(velocity, particles.velocity);
    }
    const auto numbers = [&](const char* name, const std::vector<float>& values) {
        if (values.empty()) return;
        write_by_page(detail, GA_RWHandleF(detail.addFloatTuple(GA_ATTRIB_POINT, name, 1)), values.data());
    };
    numbers("mass", particles.mass);
    numbers("viscosity", particles.viscosity);
    const auto wholes = [&](const char* name, const std::vector<int32>& values) {
        if (values.empty()) return;
        write_by_page(detail, GA_RWHandleI(detail.addIntTuple(GA_ATTRIB_POINT, name, 1)), values.data());
    };
    wholes("phase", particles.phase);
    wholes(continuous_attribute, particles.continuous);
}

SourceParticles particles_of(const GU_Detail& input, const SOP_FontanaSourceParms& parms) {
    if (has_vdb(input)) return particles_in_vdbs(input, parms.getParticleSpacing());
    if (has_mesh(input)) return particles_in_mesh(input, parms.getParticleSpacing());
    return particles_at_points(input, parms.getGroup().c_str());
}

void SourceVerb::cook(const CookParms& cookparms) const {
    const auto& parms = cookparms.parms<SOP_FontanaSourceParms>();
    GU_Detail* detail = cookparms.gdh().gdpNC();
    const GU_Detail* input = cookparms.inputGeo(0);
    if (!input) return detail->clearAndDestroy();
    try {
        SourceParticles particles = particles_of(*input, parms);
        apply_panel(parms, particles);
        write(particles, *detail);
    } catch (const std::exception& error) {  // none may reach Houdini
        detail->clearAndDestroy();
        cookparms.sopAddError(SOP_MESSAGE, error.what());
    }
}

}  // namespace

OP_Node* SOP_FontanaSourceNode::construct(OP_Network* network, const char* name, OP_Operator* entry) {
    return new SOP_FontanaSourceNode(network, name, entry);
}

PRM_Template* SOP_FontanaSourceNode::build_templates() {
    static PRM_TemplateBuilder builder("SOP_FontanaSource.cpp"_sh, dialog_script());
    return builder.templates();
}

SOP_FontanaSourceNode::SOP_FontanaSourceNode(OP_Network* network, const char* name, OP_Operator* entry)
    : SOP_Node(network, name, entry) {
    mySopFlags.setManagesDataIDs(true);
}

const SOP_NodeVerb* SOP_FontanaSourceNode::cookVerb() const { return SourceVerb::the_verb.get(); }
