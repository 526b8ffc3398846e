// Up axes of shapes and of mesh files.
#pragma once

#include <filesystem>

#include "film/assets/mesh_file.hpp"
#include "film/scene/scene.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::environment {

/// Shapes are made with their axis along z. If y is up, turns them by −90° about x: z becomes y, x stays.
mesh::Mesh turned_up(mesh::Mesh mesh, scene::UpAxis up);

/// The axes of a mesh file. If a character uses the same file, the character's up axis applies unless `up` states one.
/// If nothing states the up axis, it is y for the file of a character, and the scene's up axis for other files.
assets::MeshAxes axes_of(const scene::Scene& scene, const std::filesystem::path& file, double scale, scene::FileUp up);

}  // namespace weft::environment
