// A scene: all objects to simulate, read from TOML and checked.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include <weft/api.hpp>
#include <weft/errors.hpp>
#include <weft/model.hpp>

namespace weft {

/// A checked scene. It never changes. Copies share the data of one scene, and any thread may read them.
class WEFT_API Scene {
 public:
  /// Reads a file. `changes`: "path.to.key=value", as for `--set` on the command line, such as
  /// "cloth.band.material.fabric=silk". Throws SceneError with all mistakes.
  static Scene load(const std::filesystem::path& file, const std::vector<std::string>& changes = {});
  /// The same for the text of a file. Relative paths in the text start at the folder of `name`, which need not exist.
  static Scene parse(std::string_view toml, const std::vector<std::string>& changes = {},
                     const std::filesystem::path& name = "scene.toml");
  /// This scene with further changes, checked again. Throws SceneError.
  Scene with(const std::vector<std::string>& changes) const;

  const std::string& name() const;  ///< file name without its ending
  double fps() const;               ///< frames per second
  int frames() const;               ///< number of frames; frame k is the state at time k / fps, frame 0 the start
  std::vector<std::string> cloths() const;     ///< names, in the order of the scene
  std::vector<std::string> obstacles() const;  ///< names, in the order of the scene
  /// The scene as TOML. Keys that the scene leaves out have their default values.
  std::string text() const;

  struct Data;
  /// For the library itself.
  const Data& data() const { return *data_; }

 private:
  explicit Scene(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// A measured fabric, such as "silk", for cloths of a Model. Throws std::invalid_argument with all names if there is
/// none of this name.
WEFT_API Material fabric(std::string_view name);

}  // namespace weft
