// A script that loads point caches, cameras and lights into Blender.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "tools/export/view.hpp"

namespace weft::exporter {

/// Collects the data that the script contains: cameras, lights, mappings of pictures, and colours
/// of the backs of cloth. The script reads meshes and motions from the files <object>.obj and
/// <object>.pc2 beside it.
class BlenderScript {
 public:
  /// `width`, `height`: of the rendered pictures [pixels].
  BlenderScript(const frame::FrameSnapshot& first, const Lighting& lighting, std::string name, double fps, int width,
                int height);

  /// Adds the next frame, starting with the first.
  void add(int frame, const std::vector<View>& views);

  /// The text of the script. Blender 3.4 or later runs it without additional modules.
  std::string text() const;

 private:
  nlohmann::ordered_json film_;
};

}  // namespace weft::exporter
