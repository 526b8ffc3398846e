// Cameras that move with an obstacle or with a part of a character.
#pragma once

#include <cstddef>
#include <vector>

#include "environment/environment.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

class CameraMounts {
 public:
  CameraMounts(const scene::Scene& scene, const environment::Environment& environment);

  /// Moves the cameras of a frame from where their keys have them to where what they follow has taken them. Linear in
  /// the vertices of the obstacles that they follow.
  void move(frame::FrameSnapshot& snapshot) const;

 private:
  struct Mount {
    std::size_t camera = 0;
    environment::Parent parent;
    bool turns = true;       ///< with the rotation of the parent, too
    std::size_t state = 0;   ///< of an obstacle: number of its surface
    std::vector<Vec3> mesh;  ///< of an obstacle: its vertices in its own coordinates [m]
  };
  std::vector<Mount> mounts_;
};

}  // namespace weft::simulation
