// What an input is made into: plain arrays of particles.
#pragma once

#include <GU/GU_Detail.h>

#include <string>
#include <vector>

namespace fontana::houdini {

// An array that the input does not have is empty.
struct SourceParticles {
    std::vector<float> position, velocity;  // 3 each
    std::vector<float> mass, viscosity;
    std::vector<int32> phase, continuous;
    std::size_t count() const { return position.size() / 3; }
};

bool has_mesh(const GU_Detail& detail);
// The inside of all polygons. They take over the mean of each attribute of the mesh's points. Throws std::runtime_error
// where the mesh is open.
SourceParticles particles_in_mesh(const GU_Detail& detail, double spacing);
bool has_vdb(const GU_Detail& detail);
// Where a level set is negative or a fog above 0, of all VDBs; on the lattice of particles_in_mesh.
SourceParticles particles_in_vdbs(const GU_Detail& detail, double spacing);
// The points as they are, or those of a group.
SourceParticles particles_at_points(const GU_Detail& detail, const std::string& group);

}  // namespace fontana::houdini
