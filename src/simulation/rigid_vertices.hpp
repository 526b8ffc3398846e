// Vertices of bodies that forces move: weighted sums of the particles of their frames.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "mesh/rigid_frame.hpp"
#include "solver/linear_system.hpp"

namespace weft::simulation {

/// They stand behind all particles in arrays of positions. Contacts act on them as on particles; here what contacts
/// make of that is passed on to the frames.
class RigidVertices {
 public:
  /// `first`: the first vertex, which is the number of particles.
  explicit RigidVertices(Index first) : first_(first) {}

  /// Appends the vertices of a body whose frame has this first particle. The frame must outlive this.
  void add(const mesh::RigidFrame& frame, Index first_of_frame);

  bool empty() const { return bodies_.empty(); }
  Index first() const { return first_; }
  Index end() const { return first_ + static_cast<Index>(of_vertex_.size()); }

  /// Writes the vertices, from the frames in the same array.
  void place(std::span<Vec3> x) const;
  /// force[frame] += weight · of_all[vertex] for all vertices.
  void gather(std::span<const Vec3> of_all, std::span<Vec3> force) const;
  /// The same by absolute weights.
  void gather(std::span<const double> of_all, std::span<double> limit) const;
  /// Mass of the body of a vertex [kg], from those of the particles. Contacts are as stiff as for all of it: with the
  /// part that a corner moves at once, a stack of ten boxes sways for ten seconds.
  double mass_of(Index vertex, std::span<const double> masses) const;
  /// Terms of vertices become wide terms of frames, behind those that are there.
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
  std::vector<std::size_t> of_vertex_;  // body of each
};

}  // namespace weft::simulation
