#include "simulation/step_problem.hpp"

#include <algorithm>
#include <limits>

namespace weft::simulation {
namespace {

// Motion of a particle since the last linearisation, in spacings, up to which the matrix is good enough to find the way
// with; residuals are exact always.
constexpr double kStaleMotion = 0.005;

// Iterations of Newton's method after which compressed edges go into its matrix with the absolute value of their
// stiffness. Where cloth folds it overshoots without: a swing with threads of 1e8 N/m takes twice the iterations,
// sphere_drape a fifth more. From the first on, cloth that rests takes four iterations a step in place of one
// (multi_sheet).
constexpr int kPlainIterations = 4;

}  // namespace

StepProblem::StepProblem(ClothSystem& cloth) : cloth_(cloth) {
  memory_.system = cloth.make_linear_system();
  memory_.base = memory_.system.matrix;
  memory_.v.resize(masses().size());
  memory_.force.resize(masses().size());
  forget();
}

void StepProblem::forget() {
  memory_.linearised_at.clear();
  memory_.x.assign(masses().size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));  // equals nothing
}

void StepProblem::begin_step(double t, std::span<const integrator::HeldParticle> pinned, std::span<const Pull> pulls) {
  pulls_ = pulls;
  if (cloth_.sew(t)) forget();
  if (cloth_.hold(pinned)) {
    forget();
    memory_.rate = 0;  // what the matrix begins with has changed too
  }
  memory_.contacts = {};
}

void StepProblem::forces(const integrator::StagePoint& at, std::span<Vec3> force) {
  add_cloth_forces(at, force);
  add_pulls(at, force);
  if (contacts_ != nullptr) contacts_->add_forces(at.x_end, memory_.contacts, force);
}

void StepProblem::linear_forces(const integrator::StagePoint& at, std::span<Vec3> force) {
  add_cloth_forces(at, force);
  add_pulls(at, force);
  if (contacts_ != nullptr) contacts_->add_linear_forces(at.x_end, memory_.contacts, force);
}

void StepProblem::linearise(const integrator::StagePoint& at, int iteration, std::span<Vec3> force) {
  solver::LinearSystem& system = memory_.system;
  use_rate(at.rate);
  const bool all = memory_.linearised_at.empty();
  if (all) memory_.linearised_at.assign(at.x.begin(), at.x.end());
  for (std::size_t c = 0; c < cloth_.cloths(); ++c)
    if (all || is_stale(c, at.x)) put_together(c, at, iteration);
  add_cloth_forces(at, force);
  add_pulls(at, force);
  system.terms.clear();
  system.diagonal_terms.clear();
  for (const Pull& pull : pulls_)
    system.diagonal_terms.push_back(
        {pull.particle, (at.end_rate * pull.stiffness + at.rate * pull.damping) * Mat3::Identity()});
  if (contacts_ == nullptr) return;
  contacts_->update(at.x_end, memory_.contacts);
  contacts_->linearise(at.x_end, at.end_rate, memory_.contacts, force, system);
}

void StepProblem::add_pulls(const integrator::StagePoint& at, std::span<Vec3> force) const {
  for (const Pull& pull : pulls_)
    force[pull.particle] +=
        pull.stiffness * (pull.x - at.x_end[pull.particle]) + pull.damping * (pull.v - at.v[pull.particle]);
}

void StepProblem::add_cloth_forces(const integrator::StagePoint& at, std::span<Vec3> force) {
  for (std::size_t c = 0; c < cloth_.cloths(); ++c)
    if (!is_known(c, at)) evaluate(c, at, nullptr, forces::Linearisation::definite);
  for (std::size_t i = 0; i < memory_.force.size(); ++i) force[i] += memory_.force[i];
}

void StepProblem::use_rate(double rate) {
  if (rate == memory_.rate) return;
  cloth_.fill_base(rate, memory_.base);
  memory_.linearised_at.clear();
  memory_.rate = rate;
}

// Whether the forces within a cloth are those that were evaluated last.
bool StepProblem::is_known(std::size_t cloth, const integrator::StagePoint& at) const {
  const solver::Part& part = memory_.system.parts[cloth];
  const auto same = [&](std::span<const Vec3> a, const std::vector<Vec3>& b) {
    return std::equal(a.begin() + part.begin, a.begin() + part.end, b.begin() + part.begin);
  };
  return same(at.x, memory_.x) && same(at.v, memory_.v);
}

// Evaluates the forces within a cloth; their Jacobian goes into the matrix, if there is one.
void StepProblem::evaluate(std::size_t cloth, const integrator::StagePoint& at, solver::BlockMatrix* matrix,
                           forces::Linearisation form) {
  const solver::Part& part = memory_.system.parts[cloth];
  const Index count = part.end - part.begin;
  std::fill_n(memory_.force.begin() + part.begin, count, Vec3::Zero());
  cloth_.add_forces(cloth, {at.x, at.v, memory_.force, matrix, at.rate, form});
  std::copy_n(at.x.begin() + part.begin, count, memory_.x.begin() + part.begin);
  std::copy_n(at.v.begin() + part.begin, count, memory_.v.begin() + part.begin);
}

// Whether a cloth has moved too far from where its rows of the matrix were put together.
bool StepProblem::is_stale(std::size_t cloth, std::span<const Vec3> x) const {
  const solver::Part& part = memory_.system.parts[cloth];
  const double most = kStaleMotion * cloth_.spacing();
  for (auto i = part.begin; i < part.end; ++i)
    if (!((x[i] - memory_.linearised_at[i]).squaredNorm() <= most * most)) return true;
  return false;
}

// Puts the rows of a cloth together anew.
void StepProblem::put_together(std::size_t cloth, const integrator::StagePoint& at, int iteration) {
  solver::Part& part = memory_.system.parts[cloth];
  std::copy_n(at.x.begin() + part.begin, part.end - part.begin, memory_.linearised_at.begin() + part.begin);
  memory_.system.matrix.copy_rows(memory_.base, part.begin, part.end);
  ++part.version;
  evaluate(cloth, at, &memory_.system.matrix,
           iteration < kPlainIterations ? forces::Linearisation::definite : forces::Linearisation::abs_projected);
}

}  // namespace weft::simulation
