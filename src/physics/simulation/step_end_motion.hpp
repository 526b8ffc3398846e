// Motion of a body or pin at the end of a step.
#pragma once

#include "physics/model/model.hpp"

namespace weft::simulation {

inline bool has_zero_derivatives(const motion::PoseSample& pose) {
  return pose.velocity.isZero(0) && pose.angular_velocity.isZero(0) && pose.acceleration.isZero(0) &&
         pose.angular_acceleration.isZero(0);
}
inline bool has_zero_derivatives(const motion::VertexMotion& vertex) {
  return vertex.velocity.isZero(0) && vertex.acceleration.isZero(0);
}

/// The sample of a motion at the time t [s] at which a step ends: `sample_at`(t). From its last key on, a motion has
/// zero derivatives, but in a step that ends at this key it has moved. So if all derivatives are zero, the velocities
/// are those just before t.
template <class SampleAt>
auto sample_at_step_end(double t, const SampleAt& sample_at) {
  auto sample = sample_at(t);
  if (!has_zero_derivatives(sample)) return sample;
  const auto before = sample_at(t - model::kSameTime);
  sample.velocity = before.velocity;
  if constexpr (requires { sample.angular_velocity; }) sample.angular_velocity = before.angular_velocity;
  return sample;
}

}  // namespace weft::simulation
