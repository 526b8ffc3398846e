// The particles of all cloths: masses, what the materials name of forces, and how their matrix is laid out.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "environment/environment.hpp"
#include "environment/spline.hpp"
#include "forces/bands.hpp"
#include "forces/force.hpp"
#include "forces/ties.hpp"
#include "forces/triangle_membrane.hpp"
#include "integrator/system.hpp"
#include "scene/scene.hpp"
#include "simulation/inflation.hpp"
#include "solver/linear_system.hpp"

namespace weft::forces {
class Cord;
class StretchLimit;
struct LockLag;
}  // namespace weft::forces

namespace weft::simulation {

/// Whether cloth of this material has bending at all. Without rigidity there is nothing that the viscosity and the
/// friction of a fabric could damp.
bool bends(const scene::Material& material);

/// Whether the threads of this material lock.
bool locks(const scene::Material& material);

/// Particles are numbered through all cloths, in the order of the scene; behind them are four for each body that forces
/// move, its frame, likewise. A part is a cloth or such a frame. Nothing here changes but the rest shape of
/// cloth that is being sewn and what pins hold: the same arguments give the same forces.
class ClothSystem {
 public:
  ClothSystem(const scene::Scene& scene, const environment::Environment& environment);

  std::span<const double> masses() const { return masses_; }
  std::size_t cloths() const { return membranes_.size(); }
  std::size_t parts() const { return forces_.size(); }
  /// Of this part, cloths first, or of `parts()` the number of all particles.
  Index first_particle(std::size_t part) const { return first_[part]; }
  /// Of each body of the environment, the first particle of its frame; −1 for those without one.
  std::vector<Index> first_of_frames(const environment::Environment& environment) const;
  /// Least distance between neighbouring particles of all cloths [m].
  double spacing() const { return spacing_; }

  /// In the steps from here on [m/s²].
  void use_gravity(const Vec3& gravity) { gravity_ = gravity; }
  /// Takes the weight off what is being sewn: it would fall before it fits.
  void take_weight_off(std::span<Vec3> force) const;

  /// The particles of a cloth, or some of them, whose forces may be evaluated beside those of others.
  struct Range {
    std::size_t cloth;
    Index begin, end;
    std::size_t number;  ///< as forces::Evaluation has it
  };
  /// Some for each thread, or a whole cloth; forces are the same to the bit, however they are cut.
  std::span<const Range> ranges() const { return ranges_; }

  /// The forces on one part but its weight; positions, velocities and forces are those of all particles.
  void add_forces(std::size_t cloth, const forces::Evaluation& at) const;

  /// Locks of threads as forces::StretchLimit has them, per cloth; nothing of cloths without a limit.
  using LockLags = std::vector<forces::LockLag>;
  void begin_locks(std::span<const Vec3> x, LockLags& lags) const;
  void update_locks(std::span<const Vec3> x, bool first, LockLags& lags) const;
  void add_lock_lags(std::span<const Vec3> x, const LockLags& lags, std::span<Vec3> force) const;

  /// rate² M and the part of the stiffness that only hold() changes.
  void fill_constant(double rate, solver::Assembly& assembly) const;

  /// An empty system with the pattern of this one.
  solver::LinearSystem make_linear_system() const;

  /// Gives ropes the length, and cloths that are being sewn the rest shape that they have at time t of the simulation
  /// [s].
  void sew(double t);

  /// Whether keys leave all ropes as long as they are between two times of the simulation [s].
  bool lengths_stay(double t0, double t1) const;

  /// Air that cloths enclose, in the step that ends at time t of the simulation [s]; after sew(t). `x`: its start [m].
  void inflate(double t, std::span<const Vec3> x);
  const Inflation& inflation() const { return inflation_; }
  Inflation& inflation() { return inflation_; }

  /// Which particles pins hold from now on; whether that is a change, and with it the stiffness at the borders of pins.
  bool hold(std::span<const integrator::HeldParticle> pinned);

  /// What lasts from frame to frame: how far cloths are sewn, and what air they enclose.
  template <class Archive>
  void serialize(Archive& archive);

  double elastic_energy(std::span<const Vec3> x) const;
  /// Of the air that cloths enclose [J].
  double air_energy(std::span<const Vec3> x) const { return inflation_.energy(x); }
  double kinetic_energy(std::span<const Vec3> v) const;
  /// Of gravity, zero at the origin [J].
  double potential_energy(std::span<const Vec3> x, const Vec3& gravity) const;
  double max_strain(std::span<const Vec3> x) const;
  /// Where threads are stretched most, as a share of what their cloth allows.
  struct Overstretch {
    double share = 0;       ///< of the limit; 0 where no cloth has one
    std::size_t cloth = 0;  ///< by its number
    double extension = 0;   ///< length / rest length − 1
    Vec3 place = Vec3::Zero();
  };
  Overstretch overstretch(std::span<const Vec3> x) const;
  /// Largest strain of the edges at each particle of one cloth.
  std::vector<float> strain_per_particle(std::size_t cloth, std::span<const Vec3> x) const;

 private:
  void add_quad_forces(std::size_t cloth, const mesh::Grid& grid, const scene::Material& material,
                       const scene::Physics& physics);
  void add_triangle_forces(std::size_t cloth, const mesh::Sheet& sheet, const scene::Cloth& of, double put_on,
                           const scene::Physics& physics);
  void add_rope_forces(std::size_t cloth, std::span<const double> lengths, const scene::Rope& rope,
                       const scene::Physics& physics);
  void add_frames(const scene::Scene& scene, const environment::Environment& environment);
  void add_limit(std::size_t cloth, std::unique_ptr<forces::StretchLimit> limit);
  solver::BlockMatrix lay_out_matrix() const;
  void cut_groups(const environment::Environment& environment);
  void cut_ranges();

  std::vector<Index> first_;  // per part, and the total at the end
  std::vector<double> masses_;
  std::vector<std::vector<std::unique_ptr<forces::Force>>> forces_;          // per part
  std::vector<Range> ranges_;                                                // in the order of particles
  std::vector<const forces::Membrane*> membranes_;                           // of them, one per cloth
  std::vector<std::pair<std::size_t, const forces::StretchLimit*>> limits_;  // likewise, of cloths that have one
  /// A cloth while it is sewn.
  struct Sewing {
    std::size_t cloth;
    double begin, duration;  // [s]
    double share = -1;       // of the way to the pattern
    forces::TriangleMembrane* membrane;
    forces::Bands* bands;         // nullptr where it has none
    forces::StretchLimit* limit;  // likewise
    forces::Ties* ties;           // likewise
    double time = 0;              // of ties, since the run began [s]

    void use_share(double new_share);
  };
  std::vector<Sewing> sewing_;
  /// A rope whose length has keys.
  struct DrawnRope {
    forces::Cord* cord;
    double length;                   // that it was made with [m]
    environment::Spline<1> lengths;  // by time of the scene
  };
  std::vector<DrawnRope> drawn_;
  Inflation inflation_;
  std::vector<char> held_;  // per particle: by a pin
  Vec3 gravity_;
  double begin_;  // of the run, in the time of the scene [s]
  double spacing_ = std::numeric_limits<double>::infinity();
  std::vector<solver::Grouping> groupings_;  // of the preconditioner
};

}  // namespace weft::simulation
