// A script that loads point caches, cameras and lights into Blender.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "export/view.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// What the script sets beside the meshes, which it reads from files of their names.
class BlenderScript {
 public:
  /// `width`, `height`: of the pictures [pixels].
  BlenderScript(const frame::FrameSnapshot& first, const Lighting& lighting, std::string name, double fps, int width,
                int height);

  /// The next frame, the first too.
  void add(int frame, const std::vector<View>& views);

  /// For Blender from 3.4 on; it needs no module that is not Blender's.
  std::string text() const;

 private:
  nlohmann::ordered_json film_;
};

}  // namespace weft::exporter
