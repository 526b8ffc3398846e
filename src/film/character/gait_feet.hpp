// Motion of the feet in stance and swing, height of the hips above them, and bend of the knees.
#pragma once

#include <array>
#include <vector>

#include "film/character/gait_track.hpp"

namespace weft::character {

/// State of one foot at one key.
struct FootState {
  Vec3 ankle = Vec3::Zero();  ///< [m]
  double yaw = 0;             ///< rotation of the foot about the vertical, relative to the rest pose [rad]
  double pitch = 0;           ///< [rad]; > 0: toes up, 0: flat
  double toes = 0;            ///< upward bend of the toes relative to the foot [rad]
};

/// Positions of the left and the right hip joint relative to Joint::hips, in world axes [m]. One entry per key, from
/// the first key of the track on.
using HipOffsets = std::vector<std::array<Vec3, 2>>;

/// Computes the paths of both feet and the height of the pelvis, such that knees bend as in human walking.
///
/// The knee of the stance leg follows the curve walking::knee. From shortly after the strike of this leg until shortly
/// before the strike of the other foot, this bend determines the height of the pelvis. Between these intervals, the
/// height is interpolated. Late in stance, the heel rises until the knee has the bend of the curve, also between these
/// intervals.
///
/// In swing, knee bend, leg direction and foot pitch are interpolated from toe-off to the strike. At both ends, their
/// values, velocities and accelerations equal those in stance, except the velocity and acceleration of the knee at the
/// strike, and the acceleration of the pitch at toe-off.
///
/// A foot in stance rolls without sliding, in this order: over its round heel; flat; bending about the ball, first with
/// flat toes, then over the toe tips.
class Feet {
 public:
  /// All arguments must outlive the Feet.
  Feet(const Physique& body, const StepPlan& plan, const Track& track, const HipOffsets& hips);

  /// State of a foot at a key, which must be at least one stride away from both ends of the track. `side`: 0 left, 1
  /// right.
  FootState at(int side, int key) const;
  double pelvis_height(int key) const { return heights_[track_.index(key)]; }

 private:
  const Foothold& foothold(int side, std::size_t number) const { return plan_.footholds[side][number]; }
  double next_size(int side, std::size_t number) const;
  Vec3 hip(int side, int key) const;
  double knee(int side, std::size_t number, int key) const;
  double leg_extent(double knee) const;
  double strike_pitch(const Foothold& foothold, int key) const;
  double standing_pitch(int side, std::size_t number, int key) const;
  static double toe_pitch(double pitch);
  Vec3 rolling_ankle(const Foothold& foothold, double pitch) const;
  FootState stance_state(int side, std::size_t number, int key) const;
  FootState swing_state(int side, std::size_t number, int key) const;
  double height_above(int side, std::size_t number, int key) const;
  void find_heights();

  const Physique& body_;
  const StepPlan& plan_;
  const Track& track_;
  const HipOffsets& hips_;
  std::vector<double> heights_;
};

}  // namespace weft::character
