// Four particles that carry a rigid body: its mass, its inertia and the places of its vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "mesh/topology.hpp"

namespace weft::mesh {

/// Four particles of equal mass that have the mass, the centre and the moments of inertia of a body: with the standard
/// deviations s of its mass along its principal axes R they are at c + R diag(s) t_k, t_k being the corners
/// (±1, ±1, ±1) of a regular tetrahedron. Every point of an affine body (Lan et al., "Affine Body Dynamics", 2022) is a
/// weighted sum of the four, so that its inertia is exactly theirs.
class RigidFrame {
 public:
  static constexpr std::size_t kParticles = 4;
  using Weights = std::array<double, kParticles>;  ///< sum to 1

  /// t_k.
  static Vec3 corner(std::size_t k);

  /// Of the volume inside a closed mesh of outward triangles. Throws std::invalid_argument if the mesh has a border, or
  /// no volume.
  RigidFrame(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

  double volume() const { return volume_; }               ///< [m³]
  const Vec3& deviations() const { return deviations_; }  ///< s [m]
  const Vec3& centre() const { return centre_; }          ///< of mass, in the coordinates of the mesh [m]
  const std::array<Vec3, kParticles>& particles() const { return particles_; }  ///< likewise
  const std::vector<Weights>& weights() const { return weights_; }              ///< of each vertex

  /// Writes where the vertices are if the four particles are at `frame`.
  void place(std::span<const Vec3> frame, std::span<Vec3> vertices) const;

 private:
  double volume_ = 0;
  Vec3 centre_, deviations_;
  std::array<Vec3, kParticles> particles_;
  std::vector<Weights> weights_;
};

}  // namespace weft::mesh
