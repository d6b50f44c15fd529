#include "source_particles.h"

#include <GA/GA_Handle.h>
#include <GA/GA_Primitive.h>
#include <GA/GA_PrimitiveTypes.h>
#include <GEO/GEO_PrimVDB.h>
#include <UT/UT_BoundingBox.h>

#include <cmath>
#include <stdexcept>

#include "points.h"
#include "solid_fill.h"

namespace fontana::houdini {
namespace {

// Polygons as fans: where one is not convex, the parts outside it cancel, since they are crossed both ways.
TriangleMesh triangulated(const GU_Detail& detail) {
    TriangleMesh mesh;
    mesh.position = read_points(detail, "", PointsWanted::all).position;
    const auto index = [&](const GA_Primitive* polygon, GA_Size k) {
        return static_cast<std::uint32_t>(detail.pointIndex(polygon->getPointOffset(k)));
    };
    for (GA_Index n = 0; n < detail.getNumPrimitives(); ++n) {
        const GA_Primitive* polygon = detail.getPrimitiveByIndex(n);
        if (polygon->getTypeId() != GA_PRIMPOLY) continue;
        for (GA_Size k = 2; k < polygon->getVertexCount(); ++k)
            mesh.triangles.push_back({index(polygon, 0), index(polygon, k - 1), index(polygon, k)});
    }
    return mesh;
}

template <typename Value>
std::vector<Value> repeated_mean(const std::vector<Value>& values, std::size_t components, std::size_t count) {
    if (values.empty()) return {};
    std::vector<double> mean(components, 0.0);
    for (std::size_t k = 0; k < values.size(); ++k)
        mean[k % components] +=
            static_cast<double>(values[k]) * static_cast<double>(components) / static_cast<double>(values.size());
    std::vector<Value> result(components * count);
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = static_cast<Value>(mean[k % components]);
    return result;
}

template <typename Handle, typename Value>
std::vector<Value> read_attribute(const GU_Detail& detail, const GA_Range& range, const char* name) {
    const Handle handle(&detail, GA_ATTRIB_POINT, name);
    std::vector<Value> values;
    if (handle.isInvalid()) return values;
    GA_Offset start, end;
    for (GA_Iterator it(range); it.blockAdvance(start, end);) {
        const std::size_t before = values.size();
        values.resize(before + static_cast<std::size_t>(end - start));
        handle.getBlock(start, end - start, values.data() + before);
    }
    return values;
}

void require_spacing(double spacing) {
    if (!(spacing > 0.0) || !std::isfinite(spacing))
        throw std::runtime_error("the particle spacing is " + std::to_string(spacing) + "; expected metres above 0");
}

template <typename Use>
void for_each_vdb(const GU_Detail& detail, const Use& use) {
    for (GA_Index n = 0; n < detail.getNumPrimitives(); ++n) {
        const GA_Primitive* primitive = detail.getPrimitiveByIndex(n);
        if (primitive->getTypeId() == GA_PRIMVDB) use(*static_cast<const GEO_PrimVDB*>(primitive));
    }
}

bool is_inside(const GEO_PrimVDB& vdb, const UT_Vector3& position) {
    const fpreal value = vdb.getValueF(position);
    return vdb.isSDF() ? value < 0.0 : value > 0.0;
}

LatticeBox lattice_box(const UT_BoundingBox& box) {
    const auto number = [](fpreal32 value) { return static_cast<double>(value); };
    return {{number(box.xmin()), number(box.ymin()), number(box.zmin())},
            {number(box.xmax()), number(box.ymax()), number(box.zmax())}};
}

}  // namespace

bool has_vdb(const GU_Detail& detail) {
    bool found = false;
    for_each_vdb(detail, [&](const GEO_PrimVDB&) { found = true; });
    return found;
}

SourceParticles particles_in_vdbs(const GU_Detail& detail, double spacing) {
    require_spacing(spacing);
    std::vector<LatticeBox> boxes;
    std::vector<const GEO_PrimVDB*> vdbs;
    for_each_vdb(detail, [&](const GEO_PrimVDB& vdb) {
        UT_BoundingBox box;
        if (!vdb.getBBox(&box)) return;
        vdbs.push_back(&vdb);
        boxes.push_back(lattice_box(box));
    });
    SourceParticles particles;
    particles.position = fill_where(boxes, spacing, [&](std::size_t k, const float* p) {
        const UT_Vector3 position(p[0], p[1], p[2]);
        for (std::size_t earlier = 0; earlier < k; ++earlier)
            if (is_inside(*vdbs[earlier], position)) return false;  // it is there already
        return is_inside(*vdbs[k], position);
    });
    return particles;
}

bool has_mesh(const GU_Detail& detail) {
    for (GA_Index n = 0; n < detail.getNumPrimitives(); ++n) {
        const GA_Primitive* primitive = detail.getPrimitiveByIndex(n);
        if (primitive->getTypeId() == GA_PRIMPOLY && primitive->getVertexCount() > 2) return true;
    }
    return false;
}

SourceParticles particles_at_points(const GU_Detail& detail, const std::string& group) {
    SourcePoints points = read_points(detail, group, PointsWanted::all);
    SourceParticles particles;
    particles.position = std::move(points.position);
    particles.velocity = std::move(points.velocity);
    particles.mass = std::move(points.mass);
    PointGroup members(detail, group);
    particles.viscosity = read_attribute<GA_ROHandleF, float>(detail, members.range(), "viscosity");
    particles.phase = read_attribute<GA_ROHandleI, int32>(detail, members.range(), "phase");
    return particles;
}

SourceParticles particles_in_mesh(const GU_Detail& detail, double spacing) {
    require_spacing(spacing);
    const TriangleMesh mesh = triangulated(detail);
    for (const float x : mesh.position)
        if (!std::isfinite(x))
            throw std::runtime_error("a point of the mesh is at a place that is not a finite number");
    if (!is_closed(mesh))
        throw std::runtime_error(
            "the mesh is open, so it has no inside: close it (PolyCap, Boolean, VDB from Polygons) or give points");
    const SourceParticles surface = particles_at_points(detail, "");
    SourceParticles particles;
    particles.position = fill_solid(mesh, spacing);
    const std::size_t count = particles.count();
    particles.velocity = repeated_mean(surface.velocity, 3, count);
    particles.mass = repeated_mean(surface.mass, 1, count);
    particles.viscosity = repeated_mean(surface.viscosity, 1, count);
    particles.phase = repeated_mean(surface.phase, 1, count);
    return particles;
}

}  // namespace fontana::houdini
