#include "simulation/pins.hpp"

#include <algorithm>
#include <numeric>

namespace weft::simulation {
namespace {

int obstacle_named(const environment::Environment& environment, const std::string& name) {
  const auto found = std::find_if(environment.bodies.begin(), environment.bodies.end(),
                                  [&](const environment::BodyObject& body) { return body.name == name; });
  return found == environment.bodies.end() ? -1 : static_cast<int>(found - environment.bodies.begin());
}

}  // namespace

std::vector<Index> particles_of(const scene::ClothPart& part, const environment::ClothObject& cloth, Index first) {
  std::vector<Index> particles;
  for (std::size_t i = 0; i < cloth.fractions.size(); ++i)
    if (part.holds(cloth.fractions[i].x(), cloth.fractions[i].y())) particles.push_back(first + static_cast<Index>(i));
  return particles;
}

Pins::Pins(const scene::Scene& scene, const environment::Environment& environment,
           const std::vector<Index>& first_particle) {
  std::vector<Index> taken;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const environment::ClothObject& cloth = environment.cloths[c];
    for (const scene::Pin& pin : scene.cloths[c].pins) {
      Group group;
      for (Index particle : particles_of(pin, cloth, first_particle[c])) {
        if (std::find(taken.begin(), taken.end(), particle) != taken.end()) continue;
        group.particles.push_back(particle);
        taken.push_back(particle);
      }
      if (group.particles.empty()) continue;

      const auto start = [&](Index particle) -> const Vec3& {
        return cloth.motion.positions[static_cast<std::size_t>(particle - first_particle[c])];
      };
      group.release = pin.release;
      group.follow = pin.follow.empty() ? -1 : obstacle_named(environment, pin.follow);
      if (group.follow >= 0) {
        const environment::PoseSample pose = environment.pose(static_cast<std::size_t>(group.follow), 0);
        for (Index particle : group.particles)
          group.arms.push_back(pose.rotation.conjugate() * (start(particle) - pose.position));
      } else {
        group.track.emplace(pin.motion);
        group.origin = Vec3::Zero();
        for (Index particle : group.particles) group.origin += start(particle);
        group.origin /= static_cast<double>(group.particles.size());
        for (Index particle : group.particles) group.arms.push_back(start(particle) - group.origin);
      }
      groups_.push_back(std::move(group));
    }
  }
}

void Pins::held_at(double t, const environment::Environment& environment,
                   std::vector<integrator::HeldParticle>& held) const {
  held.clear();
  for (const Group& group : groups_) {
    if (group.release >= 0 && t > group.release) continue;
    environment::PoseSample pose;
    if (group.follow >= 0) {
      pose = environment.pose(static_cast<std::size_t>(group.follow), t);
    } else {
      pose = group.track->at(t);
      pose.position += group.origin;
    }
    for (std::size_t p = 0; p < group.particles.size(); ++p) {
      const Vec3 arm = pose.rotation * group.arms[p];
      held.push_back({{group.particles[p], Mat3::Zero()}, pose.position + arm, pose.velocity_at(arm)});
    }
  }
}

}  // namespace weft::simulation
