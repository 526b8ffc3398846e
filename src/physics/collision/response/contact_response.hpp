// Contacts as springs inside the implicit solve or, for single particles against obstacles, velocity constraints.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/archive.hpp"
#include "core/types.hpp"
#include "physics/collision/response/contact_set.hpp"
#include "physics/collision/response/velocity_constraints.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::collision {

enum class ResponseForm { springs, velocity_constraints };

/// The contacts of one step in the form that the solver uses. With velocity constraints, a contact between an obstacle
/// and a single particle in front of it (at a positive distance along the contact normal at the start of the step) is a
/// wall (see VelocityConstraints): revise() sets and releases walls between the solves of a step. All other contacts
/// are springs.
class ContactResponse {
 public:
  /// `masses`: of the particles [kg]. `stick_speed`: as in ContactSet::set_step() [m/s].
  ContactResponse(ResponseForm form, std::vector<double> masses, double stick_speed = numerics.contact.stick_velocity);

  ResponseForm form() const { return walls_ ? ResponseForm::velocity_constraints : ResponseForm::springs; }

  /// Call before adding the contacts of a step over h [s].
  void begin_step(double h);
  void add(const Contact& contact, std::span<const Vec3> x_t0);
  /// Adds the contact as a wall if it is between an obstacle and a single particle in front of it;
  /// ignores the contact otherwise. Call only with velocity constraints.
  void add_wall(const Contact& contact, std::span<const Vec3> x_t0);
  /// As VelocityConstraints::predict_wall_contacts; false with springs.
  bool predict_wall_contacts(std::span<const Vec3> x_t1, double by, std::vector<Vec3>& predicted) const {
    return walls_ && walls_->predict_wall_contacts(x_t1, by, predicted);
  }
  /// Call before the first solve, after the contacts have been added. Chooses the walls that hold
  /// particles in this solve.
  void prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);

  /// Particles that the walls constrain in the next solve.
  std::span<const PrescribedParticle> prescribed() const;
  /// After a solve that led to x_end: sets and releases walls. Returns how many particles need another solve; 0 with
  /// springs.
  int revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end, const VelocityConstraints::ForceOn& force_on);
  /// Keeps the state of the walls for the next step. Call when the step is accepted.
  void accept();

  /// As the functions of ContactSet. Forces and derivatives include the friction of the walls. update(), add_impacts()
  /// and count_active() concern springs only.
  void update(std::span<const Vec3> x_end, ContactStates& states) const { springs_.update(x_end, states); }
  void add_forces(ForceLaw law, std::span<const Vec3> x_end, const ContactStates& states, std::span<Vec3> force) const;
  bool add_impacts(std::span<const Vec3> x_end, const ContactStates& states, const StepStart& start,
                   std::span<Vec3> right_side, solver::LinearSystem& system) const {
    return springs_.add_impacts(x_end, states, start, right_side, system);
  }
  void add_normal_and_friction_forces(std::span<const Vec3> x_end, const ContactStates& states, std::span<Vec3> push,
                                      std::span<Vec3> friction, std::span<double> normal_force,
                                      std::span<double> limit) const;
  void linearise(std::span<const Vec3> x_end, double end_rate, const ContactStates& states, std::span<Vec3> force,
                 solver::LinearSystem& system) const;
  int count_active(std::span<const Vec3> x_end) const { return springs_.count_active(x_end); }

  std::span<const Contact> springs() const { return springs_.contacts(); }
  /// Whether there is no contact of either form.
  bool empty() const { return springs_.contacts().empty() && (!walls_ || walls_->empty()); }

  /// Saves or restores what accept() keeps. Throws std::runtime_error if restored data do not fit these particles.
  template <class Archive>
  void serialize(Archive& archive) {
    if (walls_) return walls_->serialize(archive);
    std::size_t none = 0;
    archive.value(none);
    if constexpr (Archive::kReads) require(none == 0, "no walls");
  }

 private:
  ContactSet springs_;
  double stick_speed_;
  std::optional<VelocityConstraints> walls_;
};

}  // namespace weft::collision
