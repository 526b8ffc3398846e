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

/// A scene without mistakes. A Scene never changes. Copies share the data, and any thread may read a Scene.
class WEFT_API Scene {
 public:
  /// Reads a file. Each of `changes` is "path.to.key=value", as for `--set` on the command line, such as
  /// "cloth.band.material.fabric=silk". Throws SceneError with all mistakes.
  static Scene load(const std::filesystem::path& file, const std::vector<std::string>& changes = {});
  /// As load(), for TOML text in memory. `name`: path that stands for the file and need not exist;
  /// relative paths in the text start at its folder.
  static Scene parse(std::string_view toml, const std::vector<std::string>& changes = {},
                     const std::filesystem::path& name = "scene.toml");
  /// Returns this scene with further changes, applied after its own and checked again. A key replaces
  /// a key of the scene that excludes it: time.step replaces time.tolerance. Throws SceneError with all mistakes.
  Scene with(const std::vector<std::string>& changes) const;

  const std::string& name() const;             ///< file name without its ending
  double fps() const;                          ///< frames per second
  int frames() const;                          ///< number of frames; frame k shows time k / fps, frame 0 the start
  std::vector<std::string> cloths() const;     ///< names, in the order of the scene
  std::vector<std::string> obstacles() const;  ///< names, in the order of the scene
  /// The scene as TOML, with its changes and with the defaults of keys that are not given, except
  /// keys whose default means "none".
  std::string text() const;

  struct Data;
  /// For the library itself.
  explicit Scene(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

/// The material of a fabric, such as "silk", for cloths of a Model. Its values are measured or,
/// where no measurement is known, estimated. If there is no fabric of this name, throws
/// std::invalid_argument with all names.
WEFT_API Material fabric(std::string_view name);

}  // namespace weft
