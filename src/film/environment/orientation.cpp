#include "film/environment/orientation.hpp"

#include <system_error>
#include <utility>
#include <variant>

namespace weft::environment {

mesh::Mesh rotate_to_up_axis(mesh::Mesh mesh, scene::UpAxis up) {
  if (up == scene::UpAxis::y)
    for (Vec3& x : mesh.positions) x = Vec3(x.x(), x.z(), -x.y());
  return mesh;
}

assets::MeshAxes axes_of(const scene::Scene& scene, const std::filesystem::path& file, double scale, scene::FileUp up) {
  assets::MeshAxes axes{scale, up, scene.up};
  std::error_code ignored;
  for (const scene::Character& character : scene.characters) {
    const auto* source = std::get_if<scene::CharacterFile>(&character.source);
    if (source == nullptr || !std::filesystem::equivalent(source->path, file, ignored)) continue;
    if (up == scene::FileUp::as_file) axes.up = character.up;
    axes.default_up = scene::FileUp::y;
  }
  return axes;
}

}  // namespace weft::environment
