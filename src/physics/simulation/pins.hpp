// Particles that pins hold or move.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "physics/integrator/system.hpp"
#include "physics/model/model.hpp"

namespace weft::simulation {

/// Largest speed of a pin or an attachment that cloth can follow [m/s]. For comparison: a hand reaches 10 m/s.
inline constexpr double kMaxHoldSpeed = 20;

/// All pins of a model: their particles, and the targets of these particles, which follow key frames or a body.
class Pins {
 public:
  /// `first_particle`: of each cloth.
  Pins(const model::Model& model, const std::vector<Index>& first_particle);

  bool empty() const { return groups_.empty(); }

  struct Info {
    std::size_t cloth = 0, number = 0;  ///< number of the cloth, and of the pin in its cloth, from 0
    std::size_t particles = 0;
    std::optional<double> strength;  ///< stiffness of the spring to each particle [N/m]; none: the particles are held
  };
  std::size_t size() const { return groups_.size(); }
  const Info& info(std::size_t pin) const { return groups_[pin].info; }
  /// Index of the pin that has this particle at time t [s]. The particle must belong to a pin at t.
  std::size_t pin_of(Index particle, double t) const { return owner_at(particle, t).pin; }
  /// Fraction, in (0, 1], of the strength of pin_of() that acts on this particle at time t [s]; 0
  /// for a particle without a pin.
  double strength_fraction(Index particle, double t) const { return owner_at(particle, t).fraction; }

  /// Fills `held` with the particles of all pins that are not released before t [s], and the
  /// targets of these particles at t. Each particle has one entry. If pins share a particle, it
  /// belongs to the first of them in the model that is not released; pins that have the particle in
  /// their region precede pins that have it in their fade (model::WeightedParticle::faded).
  /// Velocities are those at the end of a step (sample_at_step_end()).
  void held_at(double t, const model::Model& model, std::vector<integrator::HeldParticle>& held) const {
    held_at(t, t, model, held);
  }
  /// As above, with the same particles in the same order, but with their targets at the time `t_targets` [s].
  void held_at(double t, double t_targets, const model::Model& model,
               std::vector<integrator::HeldParticle>& held) const;
  /// Whether a pin is released at a time in [t0, t1) [s].
  bool release_between(double t0, double t1) const;

 private:
  /// A point near a triangle of a deforming body; the point moves as if rigidly attached to the
  /// triangle.
  struct Anchor {
    std::array<std::size_t, 3> corners;
    std::array<double, 3> weights;  // barycentric, of the nearest point of the triangle at the start
    Vec3 arm;                       // from that point, in the axes of the triangle [m]
  };
  /// A pin that has a particle until the pin is released, and the fraction of the pin's strength
  /// for this particle.
  struct Owner {
    std::size_t pin = 0;
    double fraction = 0;  // 0: no pin
    double release = 0;   // of the pin [s]; infinite: never
  };
  static std::vector<std::vector<Owner>> list_owners(const model::Model& model,
                                                     const std::vector<Index>& first_particle);
  Owner owner_at(Index particle, double t) const;
  static std::vector<Anchor> make_anchors(const model::Model& model, std::size_t body, double t,
                                          std::span<const Vec3> places);
  /// The particles that one pin has at any time.
  struct Group {
    Info info;
    std::vector<Index> particles;
    std::vector<Vec3> arms;       // start positions relative to the pose that moves the pin, in its axes [m]
    double release = -1;          // [s]; negative: never
    int follow = -1;              // number of the body that the pin follows; −1: it follows `track`
    std::vector<Anchor> anchors;  // in place of `arms`, if the pin follows triangles of a body
    // In place of `arms`, if the pin has a model::Pin::first_vertex: for each particle, the vertex
    // of the body that it follows.
    std::vector<std::size_t> followed_vertices;
    std::optional<motion::Track> track;  // motion of model::Pin::middle, if the pin follows no body
  };

  std::vector<Group> groups_;
  std::vector<std::vector<Owner>> owners_of_;  // pins of each particle, in the order of their releases
};

}  // namespace weft::simulation
