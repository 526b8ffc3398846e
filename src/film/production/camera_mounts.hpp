// Cameras that move with an obstacle or with a part of a character.
#pragma once

#include <cstddef>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"

namespace weft::production {

class CameraMounts {
 public:
  CameraMounts(const scene::Scene& scene, const environment::Environment& environment);

  /// Moves each camera that follows a body along with that body, from the position that the camera's keys give.
  /// Takes time linear in the vertices of the followed obstacles.
  void move(frame::FrameSnapshot& snapshot) const;

 private:
  struct Mount {
    std::size_t camera = 0;
    model::Parent parent;
    bool follows_rotation = true;  ///< also rotate with the parent
    std::size_t surface = 0;       ///< of an obstacle: index of its surface in the snapshot
    std::vector<Vec3> mesh;        ///< of an obstacle: its vertices in its own coordinates [m]
  };
  std::vector<Mount> mounts_;
};

}  // namespace weft::production
