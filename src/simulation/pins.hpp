// Particles that the scene holds or moves.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "environment/environment.hpp"
#include "integrator/system.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// All pins of a scene, evaluated at the end of each step.
class Pins {
 public:
  /// `first_particle`: number of the first particle of each cloth.
  Pins(const scene::Scene& scene, const environment::Environment& environment,
       const std::vector<Index>& first_particle);

  bool empty() const { return groups_.empty(); }

  /// What a pin is, of those that hold particles.
  struct About {
    std::size_t cloth = 0, number = 0;  ///< of the scene; number in its cloth, from 0
    std::size_t particles = 0;
    std::optional<double> strength;  ///< of the spring to each particle [N/m]; none: it is held
  };
  std::size_t size() const { return groups_.size(); }
  const About& about(std::size_t pin) const { return groups_[pin].about; }
  /// The pin that a particle belongs to; only of particles that belong to one.
  std::size_t of(Index particle) const { return owned_[static_cast<std::size_t>(particle)].pin; }
  /// What its spring has of the strength of that pin, above 0 and at most 1; likewise.
  double share(Index particle) const { return owned_[static_cast<std::size_t>(particle)].share; }

  /// Particles held at time t [s]; pins that are released by then are left out. One entry per particle: where pins
  /// overlap, the first of the scene wins, and the part of one over the fade of another.
  void held_at(double t, const environment::Environment& environment,
               std::vector<integrator::HeldParticle>& held) const;
  /// Whether a pin that holds at t0 is released by t1 [s].
  bool release_between(double t0, double t1) const;

 private:
  /// A place beside a triangle of a body without bones, that moves with it as if it were rigid.
  struct Anchor {
    std::array<std::size_t, 3> corners;
    std::array<double, 3> weights;  // of the point of the triangle that was nearest at the start
    Vec3 arm;                       // from there, along the triangle's axes [m]
  };
  /// Whose a particle is, by its number among the groups, and its share.
  struct Owned {
    std::size_t pin = 0;
    double share = 0;  // 0: nobody's
  };
  static std::vector<Owned> owners(const environment::Environment& environment,
                                   const std::vector<Index>& first_particle);
  static std::vector<Anchor> anchor(const environment::Environment& environment, std::size_t character, double t,
                                    std::span<const Vec3> places);
  /// Particles that share one motion.
  struct Group {
    About about;
    std::vector<Index> particles;
    std::vector<Vec3> arms;                   // from the motion's origin at the start, in its own directions [m]
    double release = -1;                      // [s]; negative: never
    int follow = -1;                          // obstacle or character, or −1 for `track`
    std::vector<Anchor> anchors;              // on a body without bones, instead of arms
    std::vector<std::size_t> skinned;         // vertices of a character that has them, instead of arms
    std::optional<environment::Track> track;  // of the middle of the particles
  };

  std::vector<Group> groups_;
  std::vector<Owned> owned_;  // per particle
};

}  // namespace weft::simulation
