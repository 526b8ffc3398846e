#include "physics/simulation/step_problem.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/numerics.hpp"
#include "core/parallel.hpp"

namespace weft::simulation {
namespace {

std::size_t size_of(const solver::DiagonalBlock& block) {
  return static_cast<std::size_t>(block.end - block.begin);
}

}  // namespace

StepProblem::StepProblem(ClothSystem& cloth) : cloth_(cloth) {
  memory_.system = cloth.make_linear_system();
  memory_.assembly = solver::Assembly(memory_.system.matrix);
  memory_.v.resize(masses().size());
  memory_.force.resize(masses().size());
  is_active_.resize(cloth.parts());
  reset_memory();
}

// begin_step() calls this function, so that the step depends only on its start state, and equal steps have the same
// bits at any frame rate.
void StepProblem::reset_memory() {
  memory_.linearised_at.clear();
  const double nowhere = std::numeric_limits<double>::quiet_NaN();  // unequal to any number
  memory_.x.assign(masses().size(), solver::padded(nowhere, nowhere, nowhere));
}

void StepProblem::begin_step(double t, std::span<const Vec3> x, std::span<const integrator::HeldParticle> pinned,
                             std::span<const PinSpring> pulls) {
  pulls_ = pulls;
  reset_memory();
  const bool lengths_change = cloth_.update_rest_shapes(t);
  cloth_.update_enclosed_air(t, x);
  if (cloth_.set_held_particles(pinned) || lengths_change)
    memory_.rate = 0;  // the constant part of the matrix has changed
  memory_.contacts = {};
  cloth_.begin_locks(x, memory_.locks);
}

void StepProblem::set_air_velocity(SolveMemory::PaddedVec3s air) {
  air_ = std::move(air);
}

// The given positions or velocities of the particles, followed by those of the vertices of dynamic bodies.
std::vector<Vec3> StepProblem::with_vertices(std::span<const Vec3> of_particles) const {
  std::vector<Vec3> of_all(static_cast<std::size_t>(vertices_->end()));
  std::ranges::copy(of_particles.first(masses().size()), of_all.begin());
  vertices_->place(of_all);
  return of_all;
}

// Calls add(x, force) with the positions of particles and vertices of dynamic bodies, and distributes the forces on
// vertices to the frame particles.
template <class Add>
void StepProblem::add_contact_forces(std::span<const Vec3> x_end, std::span<Vec3> force, const Add& add) {
  if (vertices_ == nullptr) return add(x_end, force);
  std::vector<Vec3> of_all(static_cast<std::size_t>(vertices_->end()), Vec3::Zero());
  add(with_vertices(x_end), of_all);
  vertices_->gather(of_all, force);
}

void StepProblem::add_forces(collision::ForceLaw law, const integrator::StagePoint& at, std::span<Vec3> force) {
  add_cloth_forces(at, force);
  if (law == collision::ForceLaw::tangent && !memory_.locks.empty())
    cloth_.add_lock_differences(at.x, memory_.locks, force);
  cloth_.inflation().add_forces(at.x, force);
  add_pulls(at, force);
  if (contacts_ == nullptr) return;
  add_contact_forces(at.x_end, force, [&](std::span<const Vec3> x, std::span<Vec3> of_all) {
    contacts_->add_forces(law, x, memory_.contacts, of_all);
  });
}

void StepProblem::linearise(const integrator::StagePoint& at, int iteration, std::span<Vec3> force) {
  solver::LinearSystem& system = memory_.system;
  use_rate(at.rate);
  const bool all = memory_.linearised_at.empty();
  if (all) memory_.linearised_at.assign(at.x.begin(), at.x.end());
  for (std::size_t c = 0; c < cloth_.parts(); ++c) is_active_[c] = all || is_stale(c, at.x);
  if (!memory_.locks.empty()) cloth_.update_locks(at.x, iteration == 0, memory_.locks);
  assemble_rows(at);
  add_cloth_forces(at, force);
  if (!memory_.locks.empty()) cloth_.add_lock_differences(at.x, memory_.locks, force);
  cloth_.inflation().linearise(at.x, force, system);
  add_pulls(at, force);
  restart_terms(at);
  if (contacts_ == nullptr) return;
  add_contact_forces(at.x_end, force, [&](std::span<const Vec3> x, std::span<Vec3> of_all) {
    contacts_->update(x, memory_.contacts);
    contacts_->linearise(x, at.end_rate, memory_.contacts, of_all, system);
  });
  if (vertices_ != nullptr) vertices_->spread(system);
}

bool StepProblem::contact_forces(const integrator::StagePoint& at, std::span<Vec3> push, std::span<Vec3> friction,
                                 std::span<double> normal_force, std::span<double> limit) const {
  if (contacts_ == nullptr || contacts_->empty()) return false;
  if (vertices_ == nullptr) {
    contacts_->add_normal_and_friction_forces(at.x_end, memory_.contacts, push, friction, normal_force, limit);
    return true;
  }
  const auto all = static_cast<std::size_t>(vertices_->end());
  std::vector<Vec3> push_of_all(all, Vec3::Zero()), friction_of_all = push_of_all;
  std::vector<double> normal_force_of_all(all, 0), limit_of_all = normal_force_of_all;
  contacts_->add_normal_and_friction_forces(with_vertices(at.x_end), memory_.contacts, push_of_all, friction_of_all,
                                            normal_force_of_all, limit_of_all);
  vertices_->gather(push_of_all, push);
  vertices_->gather(friction_of_all, friction);
  vertices_->gather(normal_force_of_all, normal_force);
  vertices_->gather(limit_of_all, limit);
  return true;
}

bool StepProblem::find_impacts(const integrator::StagePoint& at, const StepStart& start, std::span<Vec3> right_side) {
  if (contacts_ == nullptr || contacts_->empty()) return false;
  solver::LinearSystem& system = memory_.system;
  restart_terms(at);
  if (vertices_ == nullptr) return contacts_->add_impacts(at.x_end, memory_.contacts, start, right_side, system);
  const std::vector<Vec3> x = with_vertices(start.x), v = with_vertices(start.v);
  std::vector<Vec3> v_before, x_before;
  if (start.h_before > 0) x_before = with_vertices(start.x_before), v_before = with_vertices(start.v_before);
  std::vector<Vec3> of_all(x.size(), Vec3::Zero());
  const bool any = contacts_->add_impacts(with_vertices(at.x_end), memory_.contacts,
                                          {start.h, x, v, start.h_before, x_before, v_before}, of_all, system);
  vertices_->gather(of_all, right_side);
  vertices_->spread(system);
  return any;
}

// Replaces all terms of the system by those of pins and attachments; the caller then adds those of contacts.
void StepProblem::restart_terms(const integrator::StagePoint& at) {
  solver::LinearSystem& system = memory_.system;
  system.terms.clear();
  system.wide_terms.clear();
  system.diagonal_terms.clear();
  for (const PinSpring& pull : pulls_)
    system.diagonal_terms.push_back({pull.particle, (pull.stiffness + at.rate * pull.damping) * Mat3::Identity()});
  if (attachments_ != nullptr) attachments_->add_terms(at.x_end, at.end_rate, system);
}

void StepProblem::add_pulls(const integrator::StagePoint& at, std::span<Vec3> force) const {
  if (attachments_ != nullptr) attachments_->add_forces(at.x_end, force);
  const bool at_middle = at.end_rate != 1;  // the midpoint rule; with other methods, the stage is the end of the step
  for (const PinSpring& pull : pulls_) {
    const Vec3 away = at_middle ? pull.x_middle - at.x[pull.particle] : pull.x - at.x_end[pull.particle];
    force[pull.particle] +=
        pull.stiffness * away + pull.damping * ((at_middle ? pull.v_middle : pull.v) - at.v[pull.particle]);
  }
}

void StepProblem::add_cloth_forces(const integrator::StagePoint& at, std::span<Vec3> force) {
  parallel_for(cloth_.parts(), 1, [&](std::size_t c, std::size_t) { is_active_[c] = update_positions(c, at); });
  evaluate(at, false);
  parallel_for(force.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) force[i] += solver::vec3_of(memory_.force[i]);
  });
}

void StepProblem::use_rate(double rate) {
  if (rate == memory_.rate) return;
  cloth_.fill_constant(rate, memory_.assembly);
  memory_.linearised_at.clear();
  memory_.rate = rate;
}

// Copies the positions and velocities of a part into the memory. Returns whether any of them has changed.
bool StepProblem::update_positions(std::size_t part, const integrator::StagePoint& at) {
  const solver::DiagonalBlock& block = memory_.system.blocks[part];
  return parallel_sum(size_of(block), kGrainSize, [&](std::size_t begin, std::size_t end) {
           bool moved = false;
           for (std::size_t k = begin; k < end; ++k) {
             const auto i = static_cast<std::size_t>(block.begin) + k;
             const auto x = solver::padded<double>(at.x[i]), v = solver::padded<double>(at.v[i]);
             auto &own_x = memory_.x[i], &own_v = memory_.v[i];
             for (int axis = 0; axis < 3; ++axis) moved |= x[axis] != own_x[axis] || v[axis] != own_v[axis];
             own_x = x;
             own_v = v;
           }
           return static_cast<int>(moved);
         }) > 0;
}

// Evaluates forces within the active parts at the positions in the memory; with `assemble`, also their matrix rows.
void StepProblem::evaluate(const integrator::StagePoint& at, bool assemble) {
  const auto ranges = cloth_.ranges();
  // LoopCounts (core/parallel.hpp) is measured on one thread, where each part is one range. To
  // estimate the time on many threads, this loop counts as many chunks as there would be ranges on
  // them.
  const CountedLoop counted(cloth_.largest_range_count());
  parallel_for(ranges.size(), 1, [&](std::size_t r, std::size_t) {
    const auto& [part, begin, end, number] = ranges[r];
    if (!is_active_[part]) return;
    forces::Evaluation evaluation{memory_.x, memory_.v, forces::ForceRows(memory_.force, begin, end)};
    evaluation.rate = at.rate;
    evaluation.past = at.past;
    evaluation.range = number;
    evaluation.air_velocity = air_;
    if (assemble) {
      if (part < memory_.locks.size()) evaluation.locks = &memory_.locks[part];
      evaluation.assembly = solver::AssemblyRows(memory_.assembly, memory_.system.matrix, begin, end);
      memory_.assembly.start(begin, end, memory_.system.matrix);
    }
    std::fill(memory_.force.begin() + begin, memory_.force.begin() + end, solver::PaddedVec3<double>{});
    cloth_.add_forces(part, evaluation);
  });
}

// Whether a particle of a part has moved too far from where the part's rows of the matrix were
// assembled: for a cloth, farther than Numerics::Newton::stale_motion; for a frame, at all.
bool StepProblem::is_stale(std::size_t part, std::span<const Vec3> x) const {
  const solver::DiagonalBlock& block = memory_.system.blocks[part];
  const double most = block.is_small ? 0 : numerics.newton.stale_motion * cloth_.spacing();
  for (auto i = block.begin; i < block.end; ++i)
    if (!((x[i] - memory_.linearised_at[i]).squaredNorm() <= most * most)) return true;
  return false;
}

void StepProblem::assemble_rows(const integrator::StagePoint& at) {
  for (std::size_t c = 0; c < cloth_.parts(); ++c) {
    if (!is_active_[c]) continue;
    solver::DiagonalBlock& block = memory_.system.blocks[c];
    std::copy_n(at.x.begin() + block.begin, block.end - block.begin, memory_.linearised_at.begin() + block.begin);
    update_positions(c, at);
    ++block.version;
  }
  evaluate(at, true);
  for (std::size_t c = 0; c < cloth_.parts(); ++c) {
    if (!is_active_[c]) continue;
    const solver::DiagonalBlock& block = memory_.system.blocks[c];
    const auto for_rows = [&](const auto& complete) {
      parallel_for(size_of(block), kFineGrainSize, [&](std::size_t begin, std::size_t end) {
        complete(block.begin + static_cast<Index>(begin), block.begin + static_cast<Index>(end));
      });
    };
    for_rows([&](Index begin, Index end) { memory_.assembly.complete_pairs(begin, end, memory_.system.matrix); });
    for_rows([&](Index begin, Index end) { memory_.assembly.complete_rows(begin, end, memory_.system.matrix); });
  }
}

}  // namespace weft::simulation
