// The private data of the public scene and of its frames, for the library and the Python module.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>
#include <weft/scene.hpp>

#include "api/physics_library/data.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"

namespace weft {

struct Scene::Data {
  scene::Scene scene;
  std::string text;                               ///< TOML without the changes
  std::filesystem::path file;                     ///< path as given by the caller
  std::vector<std::vector<std::string>> changes;  ///< those of load() or parse(), then those of each with()
};

}  // namespace weft

namespace weft::library {

/// A scene of a TOML text with changes (Scene::Data::changes). `name`: see Scene::parse(). `shown`: path of the scene
/// in messages. Throws SceneError.
Scene scene_of(std::string_view text, const std::filesystem::path& name, const std::filesystem::path& shown,
               std::vector<std::vector<std::string>> changes);

/// Returns data whose objects are views of the snapshot. The data own the snapshot.
Frame::Data view(frame::SnapshotPtr snapshot);

}  // namespace weft::library
