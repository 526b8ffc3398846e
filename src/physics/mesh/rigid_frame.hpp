// Four particles that represent the mass, the inertia and the vertices of a rigid body.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::mesh {

/// Four particles, each with a quarter of the mass of a body of uniform density, that together have
/// the centre of mass and the moments of inertia of the body. They are at c + R diag(s) t_k: c is
/// the centre of mass, the columns of R are the principal axes, s are the standard deviations of
/// the mass along them, and t_k = corner(k). Every point of an affine body (Lan et al., "Affine
/// Body Dynamics", 2022) is a weighted sum of the four particles, so the body and the four
/// particles have exactly the same inertia.
class RigidFrame {
 public:
  static constexpr std::size_t kParticles = 4;
  using Weights = std::array<double, kParticles>;  ///< weights of the particles for one vertex; sum 1

  /// Corner k of the regular tetrahedron with coordinates ±1.
  static Vec3 corner(std::size_t k);

  /// The body is the volume inside a closed mesh. Throws std::invalid_argument if the mesh is empty, has a border, has
  /// triangles with different orientations or walls inside, or encloses no volume.
  RigidFrame(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

  double volume() const { return volume_; }               ///< [m³]
  const Vec3& deviations() const { return deviations_; }  ///< s [m]
  const Vec3& centre() const { return centre_; }          ///< centre of mass, in the coordinates of the mesh [m]
  const std::array<Vec3, kParticles>& particles() const { return particles_; }  ///< in the coordinates of the mesh [m]
  const std::vector<Weights>& weights() const { return weights_; }              ///< per vertex of the mesh

  /// Computes the positions of the vertices from the positions `frame` of the particles.
  void place(std::span<const Vec3> frame, std::span<Vec3> vertices) const;

 private:
  double volume_ = 0;
  Vec3 centre_, deviations_;
  std::array<Vec3, kParticles> particles_;
  std::vector<Weights> weights_;
};

}  // namespace weft::mesh
