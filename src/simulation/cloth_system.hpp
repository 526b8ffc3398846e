// The particles of all cloths as one system M x'' = f: forces put together from what the materials name.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "collision/response/contact_response.hpp"
#include "environment/environment.hpp"
#include "forces/air.hpp"
#include "forces/bands.hpp"
#include "forces/force.hpp"
#include "forces/triangle_membrane.hpp"
#include "integrator/system.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// Particles are numbered through all cloths, in the order of the scene.
class ClothSystem final : public integrator::System {
 public:
  ClothSystem(const scene::Scene& scene, const environment::Environment& environment);

  std::span<const double> masses() const override { return masses_; }
  void explicit_forces(const integrator::State& at, double h, bool extrapolated, std::span<Vec3> force) const override;
  void forces(const integrator::StagePoint& at, std::span<Vec3> force) const override;
  void linearise(const integrator::StagePoint& at, std::span<Vec3> force, solver::LinearSystem& system) const override;

  /// Contacts of the current step, or nullptr where the scene can have none. Must outlive the steps.
  void use_contacts(collision::ContactResponse* contacts) { contacts_ = contacts; }

  /// Gives cloths that are being sewn the rest shape that they have at time t [s].
  void sew(double t);

  /// What lasts from frame to frame: how far cloths are sewn.
  template <class Archive>
  void exchange(Archive& archive);

  /// Makes the next linearisation put the matrix together anew: what is computed from here on depends on positions and
  /// velocities alone.
  void forget() {
    linearised_at_.clear();
    latest_.clear();
  }

  /// An empty system with the pattern of this one.
  solver::LinearSystem make_linear_system() const;

  Index first_particle(std::size_t cloth) const { return first_[cloth]; }
  double elastic_energy(std::span<const Vec3> x) const;
  double kinetic_energy(std::span<const Vec3> v) const;
  /// Of gravity, zero at the origin [J].
  double potential_energy(std::span<const Vec3> x, const Vec3& gravity) const;
  double max_strain(std::span<const Vec3> x) const;
  /// Largest strain of the edges at each particle of one cloth.
  std::vector<float> strain_per_particle(std::size_t cloth, std::span<const Vec3> x) const;

 private:
  void prepare_base(double rate) const;
  bool is_stale(std::size_t cloth, std::span<const Vec3> x) const;
  void add_cloth_forces(std::size_t cloth, const integrator::StagePoint& at, std::span<Vec3> force,
                        solver::BlockMatrix* matrix) const;
  void add_quad_forces(std::size_t cloth, const mesh::Grid& grid, const scene::Material& material,
                       const scene::Physics& physics);
  void add_triangle_forces(std::size_t cloth, const mesh::Sheet& sheet, const scene::Cloth& of,
                           const scene::Physics& physics);
  void take_weight_off(std::span<Vec3> force) const;
  void cut_groups(const environment::Environment& environment);

  std::vector<Index> first_;  // per cloth, and the total at the end
  std::vector<double> masses_;
  std::vector<std::vector<std::unique_ptr<forces::Force>>> forces_;  // per cloth, all of the stiff ones
  std::vector<const forces::Membrane*> membranes_;                   // of them, one per cloth
  std::vector<forces::Air> air_;
  /// A cloth while it is sewn.
  struct Sewing {
    std::size_t cloth;
    double duration;    // [s]
    double share = -1;  // of the way to the pattern
    forces::TriangleMembrane* membrane;
    forces::Bands* bands;  // nullptr where it has none

    void use_share(double new_share);
  };
  std::vector<Sewing> sewing_;
  Vec3 gravity_;
  collision::ContactResponse* contacts_ = nullptr;
  std::vector<solver::Grouping> groupings_;  // of the preconditioner

  // rate² M plus the constant part of the bending, kept as long as the step does not change.
  mutable solver::BlockMatrix base_;
  mutable double base_rate_ = 0;
  // The forces within each cloth where they were last evaluated: most cloths of a scene are solved, and do not move,
  // while one goes on.
  struct Evaluated {
    std::vector<Vec3> x, v, force;
  };
  mutable std::vector<Evaluated> latest_;
  mutable std::vector<Vec3> evaluated_;  // scratch
  // Where each cloth's rows of the matrix were last put together: cloth at rest does with those it has.
  double spacing_ = std::numeric_limits<double>::infinity();  // least, of all cloths [m]
  mutable std::vector<Vec3> linearised_at_;
  mutable double linearised_rate_ = 0;
  mutable const solver::LinearSystem* linearised_into_ = nullptr;
};

}  // namespace weft::simulation
