// A script that loads point caches, cameras and lights into Blender.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/view.hpp"

namespace weft::exporter {

/// Collects the data that the script contains: cameras, lights, colours. The script reads the meshes from files that
/// are named after the objects.
class BlenderScript {
 public:
  /// `width`, `height`: of the rendered pictures [pixels].
  BlenderScript(const frame::FrameSnapshot& first, const Lighting& lighting, std::string name, double fps, int width,
                int height);

  /// Adds the next frame, starting with the first.
  void add(int frame, const std::vector<View>& views);

  /// Runs in Blender 3.4 or later without additional modules.
  std::string text() const;

 private:
  nlohmann::ordered_json film_;
};

}  // namespace weft::exporter
