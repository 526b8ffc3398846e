// How feet roll and swing, how high the hips are above them, and how far the knees bend.
#pragma once

#include <array>
#include <vector>

#include "character/gait_track.hpp"

namespace weft::character {

struct FootState {
  Vec3 ankle = Vec3::Zero();
  double yaw = 0;    ///< of the foot against its rest [rad]
  double pitch = 0;  ///< [rad], + toes up; 0 flat
  double toes = 0;   ///< bend of the toes against the foot [rad], + up
};

/// Where the hip joints are, against the middle of the pelvis, key by key from the first of the track on.
using HipOffsets = std::vector<std::array<Vec3, 2>>;

/// The way of both feet and the height of the pelvis, such that knees bend as people's do.
///
/// From strike to shortly before the next foot's strike the leg that stands decides how high the pelvis is: its knee
/// follows the curve. In between the height passes over. The leg that stays behind raises its heel as far as its knee
/// wants. In the air the knee and the direction of the leg go from what they are when the toes leave to what they are
/// at the strike, with their velocities and accelerations. A foot that stands rolls without sliding: over the heel,
/// which is round, stays flat, and bends about the ball, the toes flat.
class Feet {
 public:
  /// All must outlive it.
  Feet(const Physique& body, const StepPlan& plan, const Track& track, const HipOffsets& hips);

  /// For keys that are a stride or more from the ends of the track.
  FootState at(int side, int key) const;
  double pelvis_height(int key) const { return heights_[track_.index(key)]; }

 private:
  const Plant& plant(int side, std::size_t number) const { return plan_.plants[side][number]; }
  double next_size(int side, std::size_t number) const;
  Vec3 hip(int side, int key) const;
  double knee(int side, std::size_t number, int key) const;
  double reach(double knee) const;
  double strike_pitch(const Plant& plant, int key) const;
  double standing_pitch(int side, std::size_t number, int key) const;
  static double toe_pitch(double pitch);
  Vec3 rolling_ankle(const Plant& plant, double pitch) const;
  FootState standing(int side, std::size_t number, int key) const;
  FootState swinging(int side, std::size_t number, int key) const;
  double height_above(int side, std::size_t number, int key) const;
  void find_heights();

  const Physique& body_;
  const StepPlan& plan_;
  const Track& track_;
  const HipOffsets& hips_;
  std::vector<double> heights_;
};

}  // namespace weft::character
