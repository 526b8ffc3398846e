#include "physics/simulation/energy_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/numerics.hpp"
#include "physics/simulation/collision_stage.hpp"

namespace weft::simulation {
namespace {

// Whether pins alone drive the cloth, and FrameReport::pin_work includes all work of the pins.
bool is_driven_by_pins_alone(const model::Model& model) {
  for (const model::Cloth& cloth : model.cloths) {
    if (cloth.sewing > 0) return false;                // sewing does work
    if (!cloth.over.empty()) return false;             // this cloth, with its energy, is added later
    if (cloth.pressure.keys.size() > 1) return false;  // pumping does work
    if (cloth.rope && cloth.rope->keys.size() > 1) return false;
    // A button or zip does work when it closes.
    const auto closes = [](const mesh::Tie& tie) { return std::isfinite(tie.closed); };
    if (std::ranges::any_of(cloth.sheet.ties, closes)) return false;
    // A pin with a strength is a spring, whose energy is not measured. It brings none if it begins slack at a fixed
    // place: its cloth starts where it was made, and no pin moves the particles that they share.
    const auto moves = [](const model::Pin& pin) { return !pin.motion.keys.empty() || pin.body; };
    const auto is_spring = [](const model::Pin& pin) { return pin.strength.has_value(); };
    if (std::ranges::any_of(cloth.pins, is_spring) && (cloth.untangle || std::ranges::any_of(cloth.pins, moves)))
      return false;
  }
  for (const model::Body& body : model.bodies) {
    if (body.deforms() || (body.collide && body.may_move)) return false;
    // A body that gets a velocity at its release gains energy then.
    if (body.dynamics && body.dynamics->release > model.start_time() &&
        (body.dynamics->velocity != Vec3::Zero() || body.dynamics->angular_velocity != Vec3::Zero()))
      return false;
  }
  // Attachments that contract to a given length, or whose target moves, do work that is not measured.
  for (const model::Attachment& attachment : model.attachments)
    if (attachment.length || (attachment.to_body && model.bodies[*attachment.to_body].may_move)) return false;
  const std::vector<model::PhysicsKey>& keys = model.physics.keys;
  if (keys.size() > 1 || !model.fans.empty()) return false;
  const Vec3& wind = keys.empty() ? model.physics.wind : keys.front().wind;
  return model.physics.air_density == 0 || (wind == Vec3::Zero() && model.physics.gusts.speed == 0);
}

// Of gravity and enclosed air [J].
double potential_energy(const FrameReport& report) {
  return report.potential_energy + report.air_energy;
}

double mechanical_energy(const FrameReport& report) {
  return report.kinetic_energy + report.potential_energy + report.elastic_energy + report.air_energy;
}

}  // namespace

EnergyBound::EnergyBound(const model::Model& model, double mass, const FrameReport& start)
    : applies_(is_driven_by_pins_alone(model)),
      damped_contact_(CollisionStage::is_needed(model) &&
                      model.time.integrator != integrator::Method::implicit_midpoint),
      integrator_(model.time.integrator),
      negligible_energy_(mass * numerics.energy.negligible),
      start_energy_(mechanical_energy(start)),
      start_kinetic_(start.kinetic_energy),
      start_elastic_(start.elastic_energy),
      potential_low_(potential_energy(start)),
      potential_high_(potential_energy(start)) {}

std::vector<std::string> EnergyBound::check(const FrameReport& energies) {
  potential_low_ = std::min(potential_low_, potential_energy(energies));
  potential_high_ = std::max(potential_high_, potential_energy(energies));
  pin_work_ += energies.pin_work;
  pin_work_low_ = std::min(pin_work_low_, pin_work_);
  pin_work_high_ = std::max(pin_work_high_, pin_work_);
  solver_work_ += std::abs(energies.solver_work);
  highest_ = std::max(highest_, energies.kinetic_energy + energies.elastic_energy);
  is_exempt_ = is_exempt_ || energies.lagging_particles > 0;
  std::vector<std::string> warnings;
  for (std::optional<std::string> warning : {check_gain(energies), check_solver(energies.frame)})
    if (warning) warnings.push_back(*std::move(warning));
  return warnings;
}

double EnergyBound::energy_in_play() const {
  return start_kinetic_ + start_elastic_ + potential_high_ - potential_low_ + pin_work_high_ - pin_work_low_;
}

std::optional<std::string> EnergyBound::check_gain(const FrameReport& energies) {
  if (!applies_ || is_exempt_) return {};
  const double in_play = energy_in_play();
  const double gain = mechanical_energy(energies) - start_energy_ - pin_work_;
  const auto is_above = [&](double ratio) { return gain > ratio * in_play + negligible_energy_; };
  const bool refused = is_above(numerics.energy.failing_gain) && !damped_contact_;
  if (!refused && (warned_ || !is_above(numerics.energy.doubtful_gain))) return {};
  const std::string text = fmt::format(
      "frame {}: the cloth has {:.3g} J more than at the start{}, which nothing gave it (start, gravity, enclosed "
      "air and pins give it {:.3g} J in all), so the motion may be wrong; try a smaller time.step or "
      "solver.newton_tolerance{}",
      energies.frame, gain,
      pin_work_high_ > pin_work_low_ ? fmt::format(", besides {:.3g} J from its pins", pin_work_) : "", in_play,
      integrator_ == integrator::Method::implicit_midpoint
          ? ", or integrator = \"bdf2\": the midpoint rule damps nothing"
          : "");
  if (refused) throw Error(ExitCode::simulation_failed, "{}", text);
  warned_ = true;
  return text;
}

std::optional<std::string> EnergyBound::check_solver(int frame) {
  const double in_play = energy_in_play() + highest_;  // highest_: in this check, wind or bodies may drive the cloth
  if (warned_of_solver_ || solver_work_ <= numerics.energy.failing_gain * in_play + negligible_energy_) return {};
  warned_of_solver_ = true;
  return fmt::format(
      "frame {}: the solver has left forces in the cloth without balance, which did {:.3g} J of work (its motion has "
      "about {:.3g} J): the motion may be far off; try a smaller solver.newton_tolerance or time.step, or a softer "
      "material",
      frame, solver_work_, in_play);
}

}  // namespace weft::simulation
