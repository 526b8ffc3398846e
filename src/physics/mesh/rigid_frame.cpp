#include "physics/mesh/rigid_frame.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "physics/mesh/geometry.hpp"

namespace weft::mesh {
namespace {

// Integrals over a solid: ∫1, ∫x, ∫x xᵀ. Each is the sum over the tetrahedra between the origin and
// the surface triangles.
struct Moments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

// Adds the tetrahedron (0, a, b, c): V = det(a b c) / 6, ∫x = V (a + b + c) / 4, ∫x xᵀ = V / 20 (Σ v vᵀ + (Σ v)(Σ v)ᵀ),
// sums over v = a, b, c.
void add_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, Moments& moments) {
  const double volume = a.dot(b.cross(c)) / 6;
  const Vec3 sum = a + b + c;
  moments.volume += volume;
  moments.first += 0.25 * volume * sum;
  moments.second += volume / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
}

// Whether the triangles traverse each edge as often in one direction as in the other. Otherwise, the surface has a
// border, different orientations or a wall inside, and its Moments depend on the origin.
bool is_closed(std::span<const Triangle> triangles) {
  std::map<std::array<Index, 2>, int> balance;  // per edge, lower vertex first
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      balance[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

Vec3 RigidFrame::corner(std::size_t k) {
  return {k == 0 || k == 1 ? 1.0 : -1.0, k == 0 || k == 2 ? 1.0 : -1.0, k == 0 || k == 3 ? 1.0 : -1.0};
}

RigidFrame::RigidFrame(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  if (triangles.empty() || !is_closed(triangles))
    throw std::invalid_argument("a closed surface whose triangles face the same way");
  Moments moments;
  const Vec3 origin = vertices[triangles.front()[0]];  // near the body, to keep rounding errors small
  for (const Triangle& t : triangles)
    add_tetrahedron(vertices[t[0]] - origin, vertices[t[1]] - origin, vertices[t[2]] - origin, moments);
  if (!(std::abs(moments.volume) > largest_flat_volume(triangles, vertices)))
    throw std::invalid_argument("a surface around some volume");
  const Vec3 middle = moments.first / moments.volume;
  const Mat3 covariance = moments.second / moments.volume - middle * middle.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(covariance);
  Mat3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  if (!(principal.eigenvalues()[0] > 0)) throw std::invalid_argument("a surface around some volume");
  volume_ = std::abs(moments.volume);
  centre_ = origin + middle;
  deviations_ = principal.eigenvalues().cwiseSqrt();
  for (std::size_t k = 0; k < kParticles; ++k) particles_[k] = centre_ + axes * deviations_.cwiseProduct(corner(k));
  for (const Vec3& x : vertices) {
    const Vec3 place = (axes.transpose() * (x - centre_)).cwiseQuotient(deviations_);
    Weights& weights = weights_.emplace_back();
    for (std::size_t k = 0; k < kParticles; ++k) weights[k] = 0.25 * (1 + corner(k).dot(place));
  }
}

void RigidFrame::place(std::span<const Vec3> frame, std::span<Vec3> vertices) const {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Weights& w = weights_[v];
    vertices[v] = w[0] * frame[0] + w[1] * frame[1] + w[2] * frame[2] + w[3] * frame[3];
  }
}

}  // namespace weft::mesh
