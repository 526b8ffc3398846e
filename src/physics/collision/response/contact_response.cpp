#include "physics/collision/response/contact_response.hpp"

#include <algorithm>
#include <cmath>

#include "core/numerics.hpp"

namespace weft::collision {
namespace {

// If the contact is with an obstacle and one particle has the whole weight of its side: the index
// of this particle in Contact::particles. Otherwise −1.
int single_particle(const Contact& contact) {
  if (!contact.against_obstacle) return -1;
  const auto found = std::ranges::find_if(contact.weights, [](double w) { return std::abs(w) >= 1 - kRoundoff; });
  return found == contact.weights.end() ? -1 : static_cast<int>(found - contact.weights.begin());
}

// Adds the contact as a wall if it concerns a single particle in front of an obstacle. Returns whether it did. A
// particle behind the obstacle is pinched and gets no wall, which would hold it there.
bool add_wall_of(const Contact& contact, std::span<const Vec3> x_t0, VelocityConstraints& walls) {
  const int place = single_particle(contact);
  if (place < 0) return false;
  const double side = contact.weights[place] > 0 ? 1 : -1;
  const Vec3 normal = side * contact.normal;
  const Vec3 point_t0 = -side * contact.obstacle_start, point_t1 = -side * contact.obstacle_end;
  const double distance = normal.dot(x_t0[contact.particles[place]] - point_t0);
  if (distance <= 0) return false;
  walls.add(contact.particles[place], normal, distance, contact.range, point_t1 - point_t0, contact.friction,
            contact.static_friction);
  return true;
}

}  // namespace

ContactResponse::ContactResponse(ResponseForm form, std::vector<double> masses, double stick_speed)
    : stick_speed_(stick_speed) {
  if (form == ResponseForm::velocity_constraints) walls_.emplace(std::move(masses));
}

void ContactResponse::begin_step(double h) {
  springs_.clear();
  springs_.set_step(h, stick_speed_);
  if (walls_) walls_->begin_step(h);
}

void ContactResponse::add(const Contact& contact, std::span<const Vec3> x_t0) {
  if (!walls_ || !add_wall_of(contact, x_t0, *walls_)) springs_.add(contact);
}

void ContactResponse::add_wall(const Contact& contact, std::span<const Vec3> x_t0) {
  add_wall_of(contact, x_t0, *walls_);
}

void ContactResponse::prepare(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  if (walls_) walls_->prepare(x_t0, x_t1);
}

std::span<const PrescribedParticle> ContactResponse::prescribed() const {
  return walls_ ? walls_->prescribed() : std::span<const PrescribedParticle>();
}

int ContactResponse::revise(std::span<const Vec3> x_t0, std::span<const Vec3> x_end,
                            const VelocityConstraints::ForceOn& force_on) {
  return walls_ ? walls_->revise(x_t0, x_end, force_on) : 0;
}

void ContactResponse::accept() {
  if (walls_) walls_->accept();
}

void ContactResponse::add_forces(ForceLaw law, std::span<const Vec3> x_end, const ContactStates& states,
                                 std::span<Vec3> force) const {
  springs_.add_forces(law, x_end, states, force);
  if (walls_) walls_->add_forces(x_end, force);
}

void ContactResponse::add_normal_and_friction_forces(std::span<const Vec3> x_end, const ContactStates& states,
                                                     std::span<Vec3> push, std::span<Vec3> friction,
                                                     std::span<double> normal_force, std::span<double> limit) const {
  springs_.add_normal_and_friction_forces(x_end, states, push, friction, normal_force, limit);
  if (walls_) walls_->add_normal_and_friction_forces(x_end, push, friction, normal_force, limit);
}

void ContactResponse::linearise(std::span<const Vec3> x_end, double end_rate, const ContactStates& states,
                                std::span<Vec3> force, solver::LinearSystem& system) const {
  springs_.linearise(x_end, end_rate, states, force, system);
  if (walls_) walls_->linearise(x_end, end_rate, force, system);
}

}  // namespace weft::collision
