// The particles of all cloths: their masses, the forces of their materials, and the layout of their matrix.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "physics/forces/bands.hpp"
#include "physics/forces/force.hpp"
#include "physics/forces/ties.hpp"
#include "physics/forces/triangle_membrane.hpp"
#include "physics/integrator/system.hpp"
#include "physics/model/model.hpp"
#include "physics/motion/spline.hpp"
#include "physics/simulation/frame_report.hpp"
#include "physics/simulation/inflation.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::forces {
class RopeForce;
class StretchLimit;
struct LockLinearisation;
}  // namespace weft::forces

namespace weft::simulation {

/// Numbers the particles of all cloths consecutively, in the order of the model. After them come the four particles of
/// the frame (mesh::RigidFrame) of each body that forces move. A part is a cloth or such a frame. Forces depend on
/// their arguments and on a state: rest shapes of cloth that is being sewn, rope lengths, ties, enclosed air, and the
/// set of held particles. update_rest_shapes(), finish_step(), update_enclosed_air(), set_held_particles() and accept()
/// update this state.
class ClothSystem {
 public:
  explicit ClothSystem(const model::Model& model);

  std::span<const double> masses() const { return masses_; }
  std::size_t cloths() const { return membranes_.size(); }
  std::size_t parts() const { return forces_.size(); }
  /// First particle of a part (cloths come first); for `parts()`, the number of all particles.
  Index first_particle(std::size_t part) const { return first_[part]; }
  /// First frame particle of each body of the model; −1 for a body without a frame.
  std::vector<Index> first_of_frames(const model::Model& model) const;
  /// Smallest model::Cloth::spacing of all cloths [m]; infinite without cloths.
  double spacing() const { return spacing_; }

  /// Sets the gravity that cancel_weight_of_sewn_cloth() uses in the following steps [m/s²].
  void use_gravity(const Vec3& gravity) { gravity_ = gravity; }
  /// Subtracts the weight of cloth that is being sewn from `force` [N]. Otherwise the cloth would fall before its seams
  /// are closed.
  void cancel_weight_of_sewn_cloth(std::span<Vec3> force) const;

  /// A range of particles of one part. Forces on the particles of different ranges can be evaluated
  /// in parallel.
  struct Range {
    std::size_t part;  ///< number of the part, a cloth or a frame
    Index begin, end;
    std::size_t number;  ///< as in forces::Evaluation::range
  };
  /// The ranges of all parts. The division does not change any bit of the forces.
  std::span<const Range> ranges() const { return ranges_; }
  /// Number of ranges that ranges() would have with an unlimited number of threads.
  std::size_t largest_range_count() const;

  /// Adds the forces on the part with number `part` (or on its range `at.range`), except weight and the force of
  /// enclosed air. `at` has positions and velocities of all particles.
  void add_forces(std::size_t part, const forces::Evaluation& at) const;

  /// Per cloth, the linearisation of the forces that limit its extension (thread locks, forces::StretchLimit); empty
  /// for cloths without such a limit.
  using LockLinearisations = std::vector<forces::LockLinearisation>;
  /// These three functions call StretchLimit::begin(), update() and add_linearisation_difference(),
  /// respectively, for all cloths with a limit.
  void begin_locks(std::span<const Vec3> x, LockLinearisations& linearisations) const;
  void update_locks(std::span<const Vec3> x, bool first, LockLinearisations& linearisations) const;
  void add_lock_differences(std::span<const Vec3> x, const LockLinearisations& linearisations,
                            std::span<Vec3> force) const;

  /// Fills `assembly` with the masses times rate² (`rate` in 1/s) and the stiffness that does not depend on positions.
  /// Held particles and rope lengths determine this stiffness; set_held_particles() and update_rest_shapes() return
  /// whether it may have changed.
  void fill_constant(double rate, solver::Assembly& assembly) const;

  /// An empty system with the sparsity pattern of these forces.
  solver::LinearSystem make_linear_system() const;

  /// Call it before a step. `t`: time of the step's stage (integrator::Stepper) [s since the start of the run]. Updates
  /// rope lengths, ties, and the rest shapes of cloth that is being sewn to this time. Returns whether the constant
  /// part of the stiffness has changed since the last call.
  bool update_rest_shapes(double t);
  /// Call it after a step that ends at time t [s since the start of the run]. Updates the same values as
  /// update_rest_shapes(t), because the stage of the midpoint rule is earlier than the end of the step. Also updates
  /// the pressures and amounts of air that the model gives.
  void finish_step(double t);

  /// Whether rope lengths, sewing, ties, and given pressures or amounts of air are the same at t0 and t1, and no
  /// triangle catches up (see accept()). `t0` and `t1` are scene times [s], but update_rest_shapes() takes the time
  /// since the start of the run.
  bool is_constant_between(double t0, double t1) const;

  /// Updates the enclosed air for the step with its stage at time t [s since the start of the run]; call it after
  /// update_rest_shapes(t). `x`: particles at the start of the step [m].
  void update_enclosed_air(double t, std::span<const Vec3> x);
  const Inflation& inflation() const { return inflation_; }
  Inflation& inflation() { return inflation_; }

  /// Sets the particles that pins hold. Returns whether this set has changed; the bending stiffness beside pins depends
  /// on it.
  bool set_held_particles(std::span<const integrator::HeldParticle> pinned);

  /// Cloth that was sewn wider than its pattern, because its threads would have locked.
  struct Widening {
    std::size_t cloth;  ///< number of the cloth
    double fraction;    ///< TriangleMembrane::Widening::fraction
    Vec3 place;         ///< position of TriangleMembrane::Widening::particle [m]
  };
  /// Accepts a step over h [s] that ends with particles at x [m]. Updates the states of the ties of tearable seams
  /// (Ties::accept()). Stops the sewing of triangles whose threads lock. If the threads of such a triangle no longer
  /// lock, the triangle catches up: its rest shape approaches the pattern, also after the end of the sewing. Returns
  /// the cloths whose sewing ended with this step, if they were widened.
  std::vector<Widening> accept(std::span<const Vec3> x, double h);
  /// The load of each seam that can tear.
  std::vector<AttachmentLoad> measure_seams(std::span<const Vec3> x) const;
  /// Copies the state of sewing, and which ties of seams hold or are torn. Cloth k of `there` has the number
  /// `cloths[k]` in this object.
  void copy_sewing_from(const ClothSystem& there, std::span<const std::size_t> cloths);

  /// Saves or restores rope lengths, the progress of sewing, torn seams, and enclosed air.
  template <class Archive>
  void serialize(Archive& archive);

  /// Elastic energy of all parts [J].
  double elastic_energy(std::span<const Vec3> x) const;
  /// Energy of the enclosed air [J].
  double air_energy(std::span<const Vec3> x) const { return inflation_.energy(x); }
  /// Kinetic energy of all particles [J].
  double kinetic_energy(std::span<const Vec3> v) const;
  /// Gravitational energy, zero at the origin [J].
  double potential_energy(std::span<const Vec3> x, const Vec3& gravity) const;
  /// Largest |length / rest length − 1| of weft, warp and ropes.
  double max_strain(std::span<const Vec3> x) const;
  /// The place of a cloth with the largest extension of threads.
  struct Overstretch {
    std::size_t cloth;  ///< number of the cloth
    double ratio;       ///< extension / limit of the cloth; 0 if no thread is extended
    double extension;   ///< length / rest length − 1
    Vec3 place;         ///< [m]
  };
  /// One per cloth that has a limit of extension, in the order of the model.
  std::vector<Overstretch> overstretch(std::span<const Vec3> x) const;
  /// Largest |strain| of weft and warp next to each particle of one cloth.
  std::vector<float> strain_per_particle(std::size_t cloth, std::span<const Vec3> x) const;

 private:
  void add_quad_forces(std::size_t cloth, const model::Cloth& of, const model::Physics& physics);
  void add_triangle_forces(std::size_t cloth, const model::Cloth& of, const model::Physics& physics);
  void add_rope_forces(std::size_t cloth, const model::Rope& rope, const model::Physics& physics);
  void add_frames(const model::Model& model);
  void add_limit(std::size_t cloth, std::unique_ptr<forces::StretchLimit> limit);
  solver::BlockMatrix lay_out_matrix() const;
  void build_aggregates(const model::Model& model);
  void divide_into_ranges();
  void set_rest_time(double t);

  std::vector<Index> first_;  // first particle of each part, then the number of all particles
  std::vector<double> masses_;
  std::vector<std::vector<std::unique_ptr<forces::Force>>> forces_;          // per part
  std::vector<Range> ranges_;                                                // in the order of particles
  std::vector<const forces::Membrane*> membranes_;                           // one per cloth; owned by forces_
  std::vector<std::pair<std::size_t, const forces::StretchLimit*>> limits_;  // of the cloths that limit extension
  /// A cloth made of flat panels, which are sewn together during the run or, if `duration` is 0,
  /// before it.
  struct Sewing {
    std::size_t cloth;
    double begin, duration;  // [s]; begin: since the start of the run
    double progress = -1;    // of the rest shape, from 0 (start shape) to 1 (flat panels); −1: not set yet
    forces::TriangleMembrane* membrane;
    forces::Bands* bands;                      // nullptr if the cloth has none
    forces::StretchLimit* limit;               // nullptr if the cloth has none
    forces::Ties* ties;                        // nullptr if the cloth has none
    std::vector<std::string> tearing_seams{};  // names
    double time = 0;                           // at which the ties were last updated [s since the start of the run]

    double progress_at(double t) const;  // t: [s since the start of the run]
    void set_progress(double new_progress);
  };
  std::vector<Sewing> sewing_;
  /// A rope with key-framed length.
  struct KeyedRope {
    forces::RopeForce* force;
    double length;              // rest length at construction [m]
    motion::Spline<1> lengths;  // rest length [m] over scene time [s]
  };
  std::vector<KeyedRope> keyed_ropes_;
  // Whether the constant part of the stiffness has changed since the last update_rest_shapes().
  bool constant_changed_ = false;
  Inflation inflation_;
  std::vector<char> held_;  // per particle: whether a pin holds it
  Vec3 gravity_;
  double begin_;  // start of the run [s]
  double spacing_ = std::numeric_limits<double>::infinity();
  std::vector<solver::Aggregates> aggregate_levels_;  // of the preconditioner, finest first
};

}  // namespace weft::simulation
