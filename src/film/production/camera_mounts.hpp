// Cameras that move with an obstacle or with a part of a character.
#pragma once

#include <cstddef>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"

namespace weft::production {

/// Finds the cameras that follow something once, and moves them in each frame.
class CameraMounts {
 public:
  CameraMounts(const scene::Scene& scene, const environment::Environment& environment);

  /// Moves each camera that follows an obstacle or part. Before the call, the cameras of the snapshot must be where
  /// their keys place them. Transforms position and target by the motion of the obstacle or part since the start of the
  /// run; without scene::Camera::follow_rotation, only by its translation. Takes time linear in the number of vertices
  /// of the followed obstacles.
  void move(frame::FrameSnapshot& snapshot) const;

 private:
  struct Mount {
    std::size_t camera = 0;        ///< index of the camera in the snapshot
    model::Parent parent;          ///< obstacle or part of a character that the camera follows
    bool follows_rotation = true;  ///< whether the camera also rotates with the parent
    std::size_t surface = 0;       ///< if the parent is an obstacle: index of its surface in the snapshot
    std::vector<Vec3> mesh;        ///< if the parent is an obstacle: its vertices in its own coordinates [m]
  };
  std::vector<Mount> mounts_;
};

}  // namespace weft::production
