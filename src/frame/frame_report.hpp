// What is known of a frame and of its objects besides how they look: for statistics and plots.
#pragma once

#include <string>
#include <vector>

#include "core/timer.hpp"
#include "frame/frame_snapshot.hpp"

namespace weft::frame {

/// Air that a cloth encloses.
struct EnclosedAir {
  std::string cloth;
  double volume = 0;    ///< [m³]
  double pressure = 0;  ///< above that outside [Pa]
};

/// What an attachment bears.
struct AttachmentLoad {
  std::string name;
  double load = 0;  ///< sum of the forces of its springs, at the end of the frame [N]
  bool holds = false;
};

/// What the computation of one frame took and found.
struct FrameReport {
  int frame = 0;
  double time = 0;  ///< [s]
  StageTime simulate;
  /// Parts of it: contacts found and surfaces kept apart; forces and their matrix; the preconditioner set up; the
  /// iterations of the linear solver.
  StageTime collide, forces, preconditioner, linear;
  int steps = 0;              ///< accepted
  int rejected_steps = 0;     ///< done again, shorter
  int inexact_steps = 0;      ///< accepted although their error was above time.tolerance
  double error_estimate = 0;  ///< sum over the steps of what each adds to the error of positions [m], estimated
  double solver_error = 0;    ///< likewise, of what the solver left [m]
  int newton_iterations = 0;
  int linear_iterations = 0;
  int proximities = 0;        ///< pairs of features within 1.5 contact ranges, where the last step was expected to end
  int constraints = 0;        ///< contacts and pins that acted in the last step
  double min_distance = 0;    ///< least distance of two surfaces then [m]; infinite if none is within that
  double max_strain = 0;      ///< largest |length / rest length - 1| of a weft or warp edge, of all its steps
  double stretch_share = 0;   ///< largest extension as a share of material.max_stretch, of all its steps
  double kinetic_energy = 0;  ///< [J]
  double potential_energy = 0;        ///< of gravity, zero at the origin [J]
  double elastic_energy = 0;          ///< stretch, shear, bending, attachments [J]
  double air_energy = 0;              ///< of the air that cloths enclose [J]
  double pin_work = 0;                ///< that pins have done on the cloth since the frame before [J]
  double solver_work = 0;             ///< likewise, by what the solver has left of the equation of motion [J]
  int pinched_pairs = 0;              ///< most triangles of cloth at once that have no room and are in an obstacle
  int lagging_particles = 0;          ///< most at once that something kept from where a pin was to hold them
  std::vector<EnclosedAir> enclosed;  ///< of each cloth with pressure
  std::vector<AttachmentLoad> attachments;  ///< of each in the scene
  /// Of what begins or ends: "frame 37: 'sheet' has no room between ..., near (x, y, z) m".
  std::vector<std::string> warnings;
};

struct ObjectInfo {
  std::string name;
  ObjectKind kind;
  std::size_t vertices = 0, faces = 0;
};

}  // namespace weft::frame
