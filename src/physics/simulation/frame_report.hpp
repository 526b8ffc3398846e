// Measured data of one frame, for statistics and plots.
#pragma once

#include <string>
#include <vector>

#include "core/timer.hpp"

namespace weft::simulation {

/// Air that a cloth encloses.
struct EnclosedAir {
  std::string cloth;
  double volume = 0;    ///< [m³]
  double pressure = 0;  ///< gauge pressure: above that outside [Pa]
};

/// The load of an attachment, or of a seam that can tear.
struct AttachmentLoad {
  std::string name;
  double load = 0;  ///< sum of the magnitudes of its spring forces, at the end of the frame [N]
  /// Whether it holds at the end of the frame. Attachment: it has begun, and is neither released nor broken. Seam: at
  /// least one tie (spring between the two edges) is closed and not torn.
  bool holds = false;
};

/// Computation time and counts of one frame, and quantities measured in it.
struct FrameReport {
  int frame = 0;
  double time = 0;  ///< [s]
  StageTime simulate;
  /// Parts of `simulate`. `collide`: contact detection and separation of surfaces. `forces`: evaluation of forces and
  /// assembly of their matrix. `preconditioner`: its setup, and its application outside of linear solves. `linear`:
  /// linear solves.
  StageTime collide, forces, preconditioner, linear;
  int steps = 0;              ///< number of accepted steps
  int rejected_steps = 0;     ///< number of steps that were rejected and repeated as shorter ones
  int inexact_steps = 0;      ///< number of steps that were accepted although their error exceeded time.tolerance
  double error_estimate = 0;  ///< sum, over the steps, of the estimated local errors of positions [m]
  double solver_error = 0;    ///< sum, over the steps, of the estimated position errors due to the solver [m]
  int newton_iterations = 0;
  int linear_iterations = 0;
  /// Number of near pairs of features (within the detection distance) in the last step; see Engine::proximities().
  int proximities = 0;
  int constraints = 0;          ///< number of contacts with a force, plus number of held particles, in the last step
  double min_distance = 0;      ///< smallest distance of the near pairs [m]; infinite if there are none
  double max_strain = 0;        ///< largest |length / rest length - 1| of weft and warp in any step
  double stretch_ratio = 0;     ///< largest ratio of extension to material.max_stretch in any step
  double kinetic_energy = 0;    ///< [J]
  double potential_energy = 0;  ///< energy of gravity, zero at the origin [J]
  double elastic_energy = 0;    ///< energy of stretch, shear, bending, seams, rigid frames and attachments [J]
  double air_energy = 0;        ///< energy of enclosed air [J]
  double pin_work = 0;          ///< work of pins on the cloth since the frame before [J]
  double solver_work = 0;       ///< work of the residual of the equations of motion since the frame before [J]
  /// Largest number, in any step, of pinched cloth triangles (triangles to which obstacles leave no
  /// space). A triangle counts once for each obstacle limb (model::Body::limbs) that pinches it.
  int pinched_pairs = 0;
  /// Largest number, in any step, of pinned particles that cannot reach their targets.
  int lagging_particles = 0;
  std::vector<EnclosedAir> enclosed;        ///< one per cloth with pressure
  std::vector<AttachmentLoad> attachments;  ///< one per attachment, then one per seam that can tear
  /// Warnings of this frame, such as "frame 37: 'sheet' has no room between ..., near (x, y, z) m".
  std::vector<std::string> warnings;
};

}  // namespace weft::simulation
