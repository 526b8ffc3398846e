#include "physics/simulation/rigid_vertices.hpp"

#include <algorithm>

namespace weft::simulation {
namespace {

constexpr std::size_t kParticles = mesh::RigidFrame::kParticles;

// Adds `weight` to the weight of a particle in a term that has `count` particles so far.
void add_weight(Index particle, double weight, std::size_t& count, solver::WideTerm& term) {
  std::size_t k = 0;
  while (k < count && term.particles[k] != particle) ++k;
  if (k == count) term.particles[count++] = particle;
  term.weights[k] += weight;
}

}  // namespace

void RigidVertices::add(const mesh::RigidFrame& frame, Index first_of_frame) {
  bodies_.push_back({&frame, first_of_frame, end()});
  body_of_vertex_.insert(body_of_vertex_.end(), frame.weights().size(), bodies_.size() - 1);
}

// Calls visit(particle, weight) for each frame particle of the body of a vertex.
template <class Visit>
void RigidVertices::for_each_weight(Index vertex, const Visit& visit) const {
  const Body& body = bodies_[body_of_vertex_[static_cast<std::size_t>(vertex - first_)]];
  const mesh::RigidFrame::Weights& weights =
      body.frame->weights()[static_cast<std::size_t>(vertex - body.first_vertex)];
  for (std::size_t k = 0; k < kParticles; ++k) visit(body.first_of_frame + static_cast<Index>(k), weights[k]);
}

void RigidVertices::place(std::span<Vec3> x) const {
  for (const Body& body : bodies_)
    body.frame->place(x.subspan(static_cast<std::size_t>(body.first_of_frame), kParticles),
                      x.subspan(static_cast<std::size_t>(body.first_vertex), body.frame->weights().size()));
}

void RigidVertices::gather(std::span<const Vec3> of_all, std::span<Vec3> force) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(first_); ++i) force[i] += of_all[i];
  for (Index v = first_; v < end(); ++v) {
    const Vec3& of_vertex = of_all[static_cast<std::size_t>(v)];
    if (of_vertex == Vec3::Zero()) continue;
    for_each_weight(v, [&](Index i, double weight) { force[static_cast<std::size_t>(i)] += weight * of_vertex; });
  }
}

void RigidVertices::gather(std::span<const double> of_all, std::span<double> magnitudes) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(first_); ++i) magnitudes[i] += of_all[i];
  for (Index v = first_; v < end(); ++v)
    if (const double of_vertex = of_all[static_cast<std::size_t>(v)]; of_vertex != 0)
      for_each_weight(v, [&](Index i, double w) { magnitudes[static_cast<std::size_t>(i)] += w * of_vertex; });
}

double RigidVertices::mass_of(Index vertex, std::span<const double> masses) const {
  double mass = 0;
  for_each_weight(vertex, [&](Index i, double) { mass += masses[static_cast<std::size_t>(i)]; });
  return mass;
}

void RigidVertices::spread(solver::LinearSystem& system) const {
  const auto has_vertex = [&](const solver::StencilTerm& term) {
    for (std::size_t k = 0; k < term.particles.size(); ++k)
      if (term.weights[k] != 0 && is_vertex(term.particles[k])) return true;
    return false;
  };
  const auto add = [&](Index i, double weight, std::size_t& count, solver::WideTerm& wide) {
    if (is_vertex(i))
      for_each_weight(i, [&](Index j, double of_frame) { add_weight(j, weight * of_frame, count, wide); });
    else
      add_weight(i, weight, count, wide);
  };
  for (const solver::StencilTerm& term : system.terms) {
    if (!has_vertex(term)) continue;
    solver::WideTerm& wide = system.wide_terms.emplace_back();
    wide.stiffness = term.stiffness;
    std::size_t count = 0;
    for (std::size_t k = 0; k < term.particles.size(); ++k)
      if (term.weights[k] != 0) add(term.particles[k], term.weights[k], count, wide);
  }
  std::erase_if(system.terms, has_vertex);
  for (const solver::DiagonalTerm& term : system.diagonal_terms) {
    if (!is_vertex(term.particle)) continue;
    solver::WideTerm& wide = system.wide_terms.emplace_back();
    wide.stiffness = term.stiffness;
    std::size_t count = 0;
    add(term.particle, 1, count, wide);
  }
  std::erase_if(system.diagonal_terms, [&](const solver::DiagonalTerm& term) { return is_vertex(term.particle); });
}

}  // namespace weft::simulation
