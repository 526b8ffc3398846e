// Vertices of dynamic bodies, as weighted sums of the particles of each body's mesh::RigidFrame.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/rigid_frame.hpp"
#include "physics/solver/linear_system.hpp"

namespace weft::simulation {

/// In arrays of positions, the vertices of dynamic bodies come after all particles. Contacts act on these vertices as
/// on particles; this class distributes the resulting forces and terms to the frame particles.
class RigidVertices {
 public:
  /// `first`: index of the first vertex, equal to the number of all particles.
  explicit RigidVertices(Index first) : first_(first) {}

  /// Appends the vertices of a body. `first_of_frame`: first particle of its frame. The frame must outlive this object.
  void add(const mesh::RigidFrame& frame, Index first_of_frame);

  bool empty() const { return bodies_.empty(); }
  Index first() const { return first_; }
  Index end() const { return first_ + static_cast<Index>(body_of_vertex_.size()); }

  /// Computes the vertices in x from the frame particles in x.
  void place(std::span<Vec3> x) const;
  /// force[particle] += of_all[particle], for all particles; force[frame particle] += weight · of_all[vertex], for all
  /// vertices.
  void gather(std::span<const Vec3> of_all, std::span<Vec3> force) const;
  /// As above for magnitudes of forces. The sum over a frame is that over the vertices of its body, which the weights,
  /// with a sum of 1, preserve; single entries may be negative.
  void gather(std::span<const double> of_all, std::span<double> magnitudes) const;
  /// Mass of the whole body of a vertex [kg]; `masses`: of the particles. Contacts derive their stiffness from it.
  /// (Measured: with the effective mass of a corner instead, a stack of ten boxes sways for ten seconds.)
  double mass_of(Index vertex, std::span<const double> masses) const;
  /// Replaces the terms of `system` that involve vertices by wide terms (solver::WideTerm) on frame particles.
  void spread(solver::LinearSystem& system) const;

 private:
  struct Body {
    const mesh::RigidFrame* frame;
    Index first_of_frame, first_vertex;
  };
  bool is_vertex(Index i) const { return i >= first_; }
  template <class Visit>
  void for_each_weight(Index vertex, const Visit& visit) const;

  Index first_;
  std::vector<Body> bodies_;
  std::vector<std::size_t> body_of_vertex_;  // index of the body of each vertex
};

}  // namespace weft::simulation
