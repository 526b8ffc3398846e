// Skinning weights of the mannequin.
#pragma once

#include <array>

#include "film/character/mannequin.hpp"

namespace weft::character {

/// Weight of each joint at a point of the left half, x >= 0. Weights sum to 1 and vary smoothly; at most four are > 0.
std::array<double, kJointCount> mannequin_weights(const std::array<Vec3, kJointCount>& joints, double height,
                                                  const Vec3& p);

/// Smooth step: 0 up to `low`, 1 from `high` on; twice continuously differentiable.
double smooth_ramp(double x, double low, double high);

}  // namespace weft::character
