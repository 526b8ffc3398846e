// Curves of human walking: harmonics over one stride, fitted to motion capture.
#pragma once

#include <array>

namespace weft::character {

/// The curve mean + Σ_k (cosine[k] cos(2π (k + 1) phase) + sine[k] sin(2π (k + 1) phase)). Phase: 0 at a strike of the
/// left heel, 1 at the next one.
struct HarmonicCurve {
  double mean = 0;
  std::array<double, 6> cosine{}, sine{};

  double at(double phase) const;
};

/// Fitted to subject 12, trial 1 of the CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu, created with
/// funding from NSF EIA-0196217; free for use in research and commercial projects worldwide): 4.4 s of straight walking
/// at 120 Hz, two strides of the left foot and three of the right. A heel strikes when its ankle is farthest in front
/// of the hips (Zeni et al., "Two simple methods for determining gait events", 2008); the phase is linear between
/// strikes. The harmonics are a least-squares fit to all frames between the first and the last strike. Each curve of
/// one side is fitted to the data of both sides, those of the right shifted by half a stride. Yaw and roll of trunk and
/// head have only odd harmonics, pitch of the pelvis has only even ones. Pelvis yaw has no fifth harmonic: that of the
/// recording, 0.6°, would shake cloth on the hips. All angles are in degrees. Root mean square residuals: foot pitch
/// 2.5°, arm 3.4°, elbow 2.9°, all other angles below 1.7°.
namespace walking {

constexpr double kSpeed = 0.896, kPeriod = 1.289;  ///< speed [m/s] and stride time [s] in the recording
constexpr double kLegLength = 0.788;               ///< distance from hip to ankle of the recorded person [m]
constexpr double kFlatPitch = -10.8;               ///< value of foot_pitch for a flat foot [degrees]

// Positive yaw turns to the left, positive roll raises the left side, and positive pitch tilts forward.
constexpr HarmonicCurve pelvis_yaw{0, {-0.52, 0, 0, 0, 0, 0}, {-2.52, 0, -0.16, 0, 0, 0}};
constexpr HarmonicCurve pelvis_roll{0, {-3.92, 0, -0.66, 0, 0.07, 0}, {1.59, 0, -0.72, 0, 0.09, 0}};
constexpr HarmonicCurve pelvis_pitch{0.66, {0, 1.12, 0, 0.17, 0, -0.03}, {0, 0.36, 0, -0.13, 0, 0.05}};
constexpr HarmonicCurve chest_yaw{0, {3.39, 0, -0.80, 0, 0.03, 0}, {-1.86, 0, -0.09, 0, -0.12, 0}};
constexpr HarmonicCurve chest_roll{0, {-1.54, 0, 0.35, 0, 0.03, 0}, {-0.14, 0, -0.06, 0, -0.09, 0}};
constexpr HarmonicCurve head_yaw{0, {1.09, 0, 0.14, 0, 0.04, 0}, {-0.84, 0, -0.23, 0, -0.07, 0}};

// Curves of the left side. `foot_pitch`: pitch of the line from the ankle to the ball of the foot; positive raises the
// toes.
constexpr HarmonicCurve foot_pitch{
    -22.00, {12.48, 20.97, -0.12, -0.43, 3.08, 0.53}, {25.19, -5.71, -7.76, 2.40, 0.46, -0.92}};
// `arm_forward`, `arm_out`: angle of the upper arm from the vertical, forward and outward. `elbow`: bend of the elbow.
constexpr HarmonicCurve arm_forward{
    -5.20, {-7.63, 0.35, -0.26, 0.18, 0.06, 0.09}, {3.37, -0.02, -0.39, -0.03, -0.26, -0.05}};
constexpr HarmonicCurve arm_out{1.47, {-3.60, 0, 0.02, 0.12, 0.01, -0.02}, {0.91, -0.09, 0.10, 0.05, 0.04, 0.04}};
constexpr HarmonicCurve elbow{23.61, {-5.76, 4.14, -0.20, -0.05, 0.08, -0.17}, {2.17, -3.43, 0.02, 0.28, 0.23, 0.02}};

/// Knee flexion: 5° at contact, 18° in loading response, 5.5° in terminal stance, 39° at toe-off and 60° in initial
/// swing, as in Perry, "Normal Gait" (Atlas of Limb Prosthetics, 1992, ch. 13). A manually chosen spline connects these
/// values; the harmonics approximate it within 0.6°. The knee angles of the recording are not usable: they are 20°
/// larger in stance, and clipped at 0.
constexpr HarmonicCurve knee{22.99, {-3.24, -13.50, -0.53, -0.87, 0.13, -0.21}, {-20.21, 8.12, 3.68, 0.64, 0.49, 0.02}};

}  // namespace walking
}  // namespace weft::character
