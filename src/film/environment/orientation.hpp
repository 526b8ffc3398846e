// Up axes of shapes and of mesh files.
#pragma once

#include <filesystem>

#include "film/assets/mesh_file.hpp"
#include "film/scene/scene.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::environment {

/// Turns the mesh of a shape to the up axis. The mesh must have z up. If y is up in the scene, rotates it by −90° about
/// x: z becomes y, y becomes −z.
mesh::Mesh rotate_to_up_axis(mesh::Mesh mesh, scene::UpAxis up);

/// The axes of a mesh file. If a character uses the same file, the up axis that the scene gives this character applies,
/// unless `up` states one. If nothing states the up axis, it is y for the file of a character, and the up axis of the
/// scene for other files.
assets::MeshAxes axes_of(const scene::Scene& scene, const std::filesystem::path& file, double scale, scene::FileUp up);

}  // namespace weft::environment
