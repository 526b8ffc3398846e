// Particles that pins hold or move.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "physics/integrator/system.hpp"
#include "physics/model/model.hpp"

namespace weft::simulation {

/// Largest speed of a pin or an attachment that cloth can follow [m/s]; a hand reaches 10.
inline constexpr double kMaxHoldSpeed = 20;

/// All pins of a model; they move particles along key frames or with a body.
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
  /// Index of the pin that has this particle at time t [s]. The particle must then belong to a pin.
  std::size_t pin_of(Index particle, double t) const { return owner_at(particle, t).pin; }
  /// Fraction of that pin's strength for this particle, in (0, 1]; 0 for a particle without a pin.
  double strength_fraction(Index particle, double t) const { return owner_at(particle, t).fraction; }

  /// Particles of all pins with their targets at time t [s], without those of pins released before t. Each particle has
  /// one entry. If pins overlap, the particle belongs to the first of them in the model that is not released; but a pin
  /// with the particle in its region comes before one with the particle in its fade.
  void held_at(double t, const model::Model& model, std::vector<integrator::HeldParticle>& held) const;
  /// Whether a pin is released at a time in [t0, t1) [s].
  bool release_between(double t0, double t1) const;

 private:
  /// A point beside a triangle of a body without bones; it moves with the triangle as if rigidly attached.
  struct Anchor {
    std::array<std::size_t, 3> corners;
    std::array<double, 3> weights;  // barycentric, of the nearest point of the triangle at the start
    Vec3 arm;                       // from that point, in the axes of the triangle [m]
  };
  /// A pin that has a particle for some time, and the fraction of the pin's strength for this particle.
  struct Owner {
    std::size_t pin = 0;
    double fraction = 0;  // 0: no pin
    double release = 0;   // of the pin [s]; infinite: never
  };
  static std::vector<std::vector<Owner>> owners(const model::Model& model, const std::vector<Index>& first_particle);
  Owner owner_at(Index particle, double t) const;
  static std::vector<Anchor> anchor(const model::Model& model, std::size_t character, double t,
                                    std::span<const Vec3> places);
  /// The particles that one pin has at some time, which share one motion.
  struct Group {
    Info info;
    std::vector<Index> particles;
    std::vector<Vec3> arms;       // particles at the start relative to the origin of the motion, in its axes [m]
    double release = -1;          // [s]; negative: never
    int follow = -1;              // number of the obstacle or character that it follows; −1: it follows `track`
    std::vector<Anchor> anchors;  // in place of `arms`, if it follows a body without bones
    // In place of `arms`, if it follows a body with bones: the vertices that represent its particles.
    std::vector<std::size_t> skinned;
    std::optional<motion::Track> track;  // of model::Pin::middle, if it follows no body
  };

  std::vector<Group> groups_;
  std::vector<std::vector<Owner>> owners_of_;  // per particle, in the order of their releases
};

}  // namespace weft::simulation
