// The equation of one step as the integrator sees it: cloth, what it meets, and what is remembered between evaluations.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "collision/response/contact_response.hpp"
#include "forces/stretch_limit.hpp"
#include "integrator/system.hpp"
#include "simulation/attachments.hpp"
#include "simulation/cloth_system.hpp"
#include "simulation/rigid_vertices.hpp"

namespace weft::simulation {

/// All that evaluations leave behind for those that follow: with the same of it the same arguments give the same bits.
struct SolveMemory {
  // Changed by linearisations. Cloth at rest does with the rows of the matrix that it has.
  solver::LinearSystem system;
  solver::Assembly assembly;        ///< what its matrix is written from
  double rate = 0;                  ///< of both [1/s]; 0: of none
  std::vector<Vec3> linearised_at;  ///< where each cloth's rows were put together; empty: nowhere
  collision::ContactLag contacts;
  ClothSystem::LockLags locks;  ///< none before the first step

  // Saves time only. Of the forces within the cloths: most cloths of a scene are solved, and do not move, while one
  // goes on.
  using Quads = std::vector<solver::Quad<double>>;
  Quads x, v;   ///< where each cloth's forces were last evaluated; not a number: nowhere
  Quads force;  ///< what they were [N]
};

/// What draws a particle to a place.
struct Pull {
  Index particle;
  Vec3 x, v;         ///< the place and its velocity at the end of the step [m], [m/s]
  double stiffness;  ///< [N/m]
  double damping;    ///< [N·s/m]
};

/// ClothSystem computes, ContactResponse too; here is what they are given of the past.
class StepProblem final : public integrator::System {
 public:
  /// The cloth must outlive it.
  explicit StepProblem(ClothSystem& cloth);

  /// What the cloth meets, and the vertices of bodies that forces move, if there are some. Must outlive the steps.
  void use_contacts(const collision::ContactResponse& contacts, const RigidVertices* vertices = nullptr) {
    contacts_ = &contacts;
    vertices_ = vertices;
  }

  /// Springs between cloths and to bodies. Must outlive the steps.
  void use_attachments(const Attachments& attachments) { attachments_ = &attachments; }

  /// Before the first solve of a step that ends at time t [s] of the simulation, with what pins hold until then: sews
  /// cloth on to there, and friction goes by the loads at the start, threads lock by their tensions there (at x). The
  /// next linearisation puts the matrix together anew. `pulls` must outlive the step.
  void begin_step(double t, std::span<const Vec3> x, std::span<const integrator::HeldParticle> pinned,
                  std::span<const Pull> pulls = {});

  /// Velocities of the air at all particles for the step that begins [m/s]; without, it is the same everywhere.
  void blow(SolveMemory::Quads air);

  /// Within a step, where its contacts are others now: their loads are followed for half as many updates as those of
  /// the first ones, or more if there were less so far.
  void forget_contacts() {
    memory_.contacts = {{}, {}, {}, std::min(memory_.contacts.updates, numerics.newton.patience / 2)};
  }

  /// Before a step is solved anew: friction goes by the loads of its start, whatever they become.
  void keep_loads() { memory_.contacts = {{}, {}, {}, numerics.newton.patience}; }

  const SolveMemory& memory() const { return memory_; }

  std::span<const double> masses() const override { return cloth_.masses(); }
  void constant_forces(std::span<Vec3> force) const override { cloth_.take_weight_off(force); }
  void forces(const integrator::StagePoint& at, std::span<Vec3> force) override;
  void linear_forces(const integrator::StagePoint& at, std::span<Vec3> force) override;
  void linearise(const integrator::StagePoint& at, int iteration, std::span<Vec3> force) override;
  bool contact_forces(const integrator::StagePoint& at, std::span<Vec3> push, std::span<Vec3> friction,
                      std::span<double> limit) const override;
  bool find_impacts(const integrator::StagePoint& at, const StepStart& start, std::span<Vec3> right_side) override;
  bool is_translation_invariant() const override { return true; }
  solver::LinearSystem& linear_system() override { return memory_.system; }

 private:
  void forget();
  void add_pulls(const integrator::StagePoint& at, std::span<Vec3> force) const;
  void add_cloth_forces(const integrator::StagePoint& at, std::span<Vec3> force);
  bool move_to(std::size_t cloth, const integrator::StagePoint& at);
  void evaluate(const integrator::StagePoint& at, bool assemble, int iteration = 0);
  void use_rate(double rate);
  bool is_stale(std::size_t cloth, std::span<const Vec3> x) const;
  template <class Add>
  void add_contact_forces(std::span<const Vec3> x_end, std::span<Vec3> force, const Add& add);
  std::vector<Vec3> with_vertices(std::span<const Vec3> of_particles) const;
  void put_together(const integrator::StagePoint& at, int iteration);

  ClothSystem& cloth_;
  const collision::ContactResponse* contacts_ = nullptr;  // nullptr where the scene has nothing that meets
  const RigidVertices* vertices_ = nullptr;               // likewise, of bodies that forces move
  const Attachments* attachments_ = nullptr;
  std::span<const Pull> pulls_;
  SolveMemory::Quads air_;
  SolveMemory memory_;
  std::vector<char> chosen_;  // per cloth: is to be evaluated; scratch
};

}  // namespace weft::simulation
