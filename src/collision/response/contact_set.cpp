#include "collision/response/contact_set.hpp"

#include <algorithm>
#include <cmath>

namespace weft::collision {
namespace {

Vec3 weighted_sum(const Contact& contact, std::span<const Vec3> x) {
  Vec3 sum = contact.weights[0] * x[static_cast<std::size_t>(contact.particles[0])];
  for (int k = 1; k < 4; ++k) sum += contact.weights[k] * x[static_cast<std::size_t>(contact.particles[k])];
  return sum;
}

}  // namespace

void ContactSet::set_step(double h) {
  stick_slip_ = kStickSpeed * h;
  first_ = true;
}

void ContactSet::add(const Contact& contact) {
  contacts_.push_back(contact);
  contacts_.back().load =
      std::max(0.0, contact.stiffness * (contact.range - contact.normal.dot(contact.relative_start)));
}

ContactSet::Response ContactSet::respond(const Contact& contact, std::span<const Vec3> x_end) const {
  const Vec3 relative = weighted_sum(contact, x_end) + contact.obstacle_end;
  const double gap = contact.normal.dot(relative);
  Response response;
  if (gap >= contact.range) return response;

  response.active = true;
  response.load = contact.stiffness * (contact.range - gap);
  response.force = response.load * contact.normal;
  if (contact.friction > 0 && contact.load > 0) {
    Vec3 slip = relative - contact.relative_start;
    slip -= contact.normal.dot(slip) * contact.normal;
    const double size = slip.norm();
    // Force over slip: 2/ε − s/ε² while sticking, 1/s while sliding; continuous with its first derivative.
    const double over_slip = size < stick_slip_ ? (2 - size / stick_slip_) / stick_slip_ : 1 / size;
    response.sliding = contact.friction * contact.load * over_slip;
    response.force -= response.sliding * slip;
  }
  return response;
}

void ContactSet::add_forces(std::span<const Vec3> x_end, std::span<Vec3> force) const {
  for (const Contact& contact : contacts_) {
    const Response response = respond(contact, x_end);
    if (!response.active) continue;
    for (int k = 0; k < 4; ++k)
      force[static_cast<std::size_t>(contact.particles[k])] += contact.weights[k] * response.force;
  }
}

void ContactSet::linearise(std::span<const Vec3> x_end, double end_rate, std::span<Vec3> force,
                           solver::LinearSystem& system) {
  for (Contact& contact : contacts_) {
    if (!first_) contact.load = respond(contact, x_end).load;
    const Response response = respond(contact, x_end);
    if (!response.active) continue;
    int involved = 0, last = 0;
    for (int k = 0; k < 4; ++k) {
      force[static_cast<std::size_t>(contact.particles[k])] += contact.weights[k] * response.force;
      if (contact.weights[k] != 0) ++involved, last = k;
    }
    const Mat3 along = contact.normal * contact.normal.transpose();
    const Mat3 stiffness = end_rate * (contact.stiffness * along + response.sliding * (Mat3::Identity() - along));
    if (involved == 1) {
      // A single particle on an obstacle couples with nothing: its block goes into the diagonal, at no cost per
      // iteration.
      const double w = contact.weights[last];
      system.matrix.add(system.matrix.diagonal(contact.particles[last]), w * w * stiffness);
    } else {
      system.terms.push_back({contact.particles, contact.weights, stiffness});
    }
  }
  first_ = false;
}

int ContactSet::active(std::span<const Vec3> x_end) const {
  int count = 0;
  for (const Contact& contact : contacts_) count += respond(contact, x_end).active ? 1 : 0;
  return count;
}

}  // namespace weft::collision
