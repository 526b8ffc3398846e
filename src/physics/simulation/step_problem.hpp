// The physical system of one step as the integrator uses it (integrator::System): forces of cloths, contacts and
// attachments, and what these keep between evaluations.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "physics/collision/response/contact_response.hpp"
#include "physics/forces/stretch_limit.hpp"
#include "physics/integrator/system.hpp"
#include "physics/simulation/attachments.hpp"
#include "physics/simulation/cloth_system.hpp"
#include "physics/simulation/rigid_vertices.hpp"

namespace weft::simulation {

/// State that evaluations of forces keep for later evaluations. Two evaluations with equal memory and equal arguments
/// give the same bits.
struct SolveMemory {
  // Of all evaluations of forces, only StepProblem::linearise() changes the members of this group. A cloth that has
  // hardly moved since its rows of the matrix were assembled keeps these rows.
  solver::LinearSystem system;
  solver::Assembly assembly;        ///< of the matrix in `system`
  double rate = 0;                  ///< StagePoint::rate for which system and assembly were filled [1/s]; 0: not set
  std::vector<Vec3> linearised_at;  ///< positions where each cloth's rows were assembled; empty: not assembled
  collision::ContactStates contacts;
  ClothSystem::LockLinearisations locks;  ///< empty before the first step

  // Internal forces of cloths. They are kept to save time: in a solve, most cloths converge before
  // the last one does.
  using PaddedVec3s = std::vector<solver::PaddedVec3<double>>;
  PaddedVec3s x, v;   ///< where each cloth's forces were last evaluated; NaN: nowhere
  PaddedVec3s force;  ///< the forces there [N]
};

/// A damped spring that pulls a particle to a point.
struct PinSpring {
  Index particle;
  Vec3 x, v;                ///< the point and its velocity at the end of the step [m], [m/s]
  double stiffness;         ///< [N/m]; 0 for a particle that lags, which only the damper pulls
  double damping;           ///< [N·s/m]
  Vec3 x_middle, v_middle;  ///< as x and v, in the middle of the step; used by the midpoint rule
};

/// Sums the forces of ClothSystem, Attachments, ContactResponse and pin springs; keeps their memory between
/// evaluations.
class StepProblem final : public integrator::System {
 public:
  /// The cloth must outlive this object.
  explicit StepProblem(ClothSystem& cloth);

  /// Sets the contacts, and the vertices of bodies that forces move; nullptr: no such bodies. Both must outlive the
  /// steps.
  void use_contacts(const collision::ContactResponse& contacts, const RigidVertices* vertices = nullptr) {
    contacts_ = &contacts;
    vertices_ = vertices;
  }

  /// Sets the springs between cloths and to bodies. They must outlive the steps.
  void use_attachments(const Attachments& attachments) { attachments_ = &attachments; }

  /// Begins a step with its stage at time t [s since the start of the run], before its first solve. Updates rest shapes
  /// and enclosed air. Resets the memory: thread locks start from the tensions at the start positions x [m], and the
  /// next linearisation assembles the whole matrix. `pinned`: particles that pins or keys hold in the step. `pulls`
  /// must outlive the step.
  void begin_step(double t, std::span<const Vec3> x, std::span<const integrator::HeldParticle> pinned,
                  std::span<const PinSpring> pulls = {});

  /// Sets the air velocity at each particle, until the next call [m/s]. Before the first call, the air velocity is
  /// `Physics::wind` everywhere.
  void set_air_velocity(SolveMemory::PaddedVec3s air);

  /// Call it within a step if contacts have changed: discards what is kept per contact. In a step, friction follows the
  /// normal forces during the first `numerics.newton.slow_after` updates. After this call, friction follows them for at
  /// least half as many further updates.
  void limit_friction_updates() {
    memory_.contacts = {{}, {}, {}, std::min(memory_.contacts.updates, numerics.newton.slow_after / 2)};
  }

  /// Call before a step is solved again: in that solve, friction uses the normal forces at the start of the step.
  void fix_normal_forces() { memory_.contacts = {{}, {}, {}, numerics.newton.slow_after}; }

  const SolveMemory& memory() const { return memory_; }

  std::span<const double> masses() const override { return cloth_.masses(); }
  void constant_forces(std::span<Vec3> force) const override { cloth_.cancel_weight_of_sewn_cloth(force); }
  void forces(const integrator::StagePoint& at, std::span<Vec3> force) override {
    add_forces(collision::ForceLaw::exact, at, force);
  }
  void linear_forces(const integrator::StagePoint& at, std::span<Vec3> force) override {
    add_forces(collision::ForceLaw::tangent, at, force);
  }
  void linearise(const integrator::StagePoint& at, int iteration, std::span<Vec3> force) override;
  bool contact_forces(const integrator::StagePoint& at, std::span<Vec3> push, std::span<Vec3> friction,
                      std::span<double> normal_force, std::span<double> limit) const override;
  bool find_impacts(const integrator::StagePoint& at, const StepStart& start, std::span<Vec3> right_side) override;
  bool is_translation_invariant() const override { return true; }
  solver::LinearSystem& linear_system() override { return memory_.system; }

 private:
  void reset_memory();
  void restart_terms(const integrator::StagePoint& at);
  void add_forces(collision::ForceLaw law, const integrator::StagePoint& at, std::span<Vec3> force);
  void add_pulls(const integrator::StagePoint& at, std::span<Vec3> force) const;
  void add_cloth_forces(const integrator::StagePoint& at, std::span<Vec3> force);
  bool update_positions(std::size_t part, const integrator::StagePoint& at);
  void evaluate(const integrator::StagePoint& at, bool assemble);
  void use_rate(double rate);
  bool is_stale(std::size_t part, std::span<const Vec3> x) const;
  template <class Add>
  void add_contact_forces(std::span<const Vec3> x_end, std::span<Vec3> force, const Add& add);
  std::vector<Vec3> with_vertices(std::span<const Vec3> of_particles) const;
  void assemble_rows(const integrator::StagePoint& at);

  ClothSystem& cloth_;
  const collision::ContactResponse* contacts_ = nullptr;  // nullptr if nothing can collide
  const RigidVertices* vertices_ = nullptr;               // nullptr if there are none
  const Attachments* attachments_ = nullptr;
  std::span<const PinSpring> pulls_;
  SolveMemory::PaddedVec3s air_;
  SolveMemory memory_;
  std::vector<char> is_active_;  // scratch, per part: whether to evaluate it
};

}  // namespace weft::simulation
