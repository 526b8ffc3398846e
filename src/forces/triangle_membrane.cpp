#include "forces/triangle_membrane.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace weft::forces {

using solver::packed_outer;
using solver::packed_scalar;
using solver::PackedBlock;

namespace {

// Below this stretch a thread has no direction any more: it pulls nowhere, and the matrix stays finite.
constexpr double kCollapsed = 1e-12;

double length_of(const Vec3& s) {
  return std::max(s.norm(), kCollapsed);
}

// k (‖s‖ − 1) s/‖s‖ with viscosity: the stress along a thread [N/m].
Vec3 tension(double k, double viscosity, const Vec3& s, const Vec3& rate) {
  const double length = length_of(s);
  const Vec3 n = s / length;
  return (k * (length - 1) + viscosity * n.dot(rate)) * n;
}

}  // namespace

TriangleMembrane::TriangleMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                                   const ShearParameters& shear)
    : stretch_(stretch), shear_(shear), first_(first) {
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    Element element;
    for (std::size_t k = 0; k < 3; ++k) element.particles[k] = first + sheet.triangles[t][k];
    const auto& m = sheet.material[t];
    Eigen::Matrix2d sides;
    sides << m[1] - m[0], m[2] - m[0];
    element.area = 0.5 * sides.determinant();
    const Eigen::Matrix2d inverse = sides.inverse();
    use_rest(inverse, element);
    elements_.push_back(element);
    if (!sheet.sewn) continue;
    Gradient s{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = sheet.rest[sheet.triangles[t][k]];
      s.u += element.gradients[k].x() * x;
      s.v += element.gradients[k].y() * x;
    }
    starts_.push_back({inverse, stretch_of(s) - Eigen::Matrix2d::Identity()});
  }
}

// U of the polar decomposition: the square root of the metric, in closed form for 2 × 2.
Eigen::Matrix2d TriangleMembrane::stretch_of(const Gradient& s) {
  Eigen::Matrix2d metric;
  metric << s.u.dot(s.u), s.u.dot(s.v), s.u.dot(s.v), s.v.dot(s.v);
  const double area = s.u.cross(s.v).norm();
  return (metric + area * Eigen::Matrix2d::Identity()) / std::sqrt(metric.trace() + 2 * area);
}

// From the inverse of the matrix with two sides as columns.
void TriangleMembrane::use_rest(const Eigen::Matrix2d& inverse, Element& element) {
  element.gradients[1] = inverse.row(0);
  element.gradients[2] = inverse.row(1);
  element.gradients[0] = -(element.gradients[1] + element.gradients[2]);
}

void TriangleMembrane::rest_between_start_and_pattern(double share) {
  for (std::size_t e = 0; e < starts_.size(); ++e) {
    const auto& [inverse, excess] = starts_[e];
    const Eigen::Matrix2d stretch = Eigen::Matrix2d::Identity() + (1 - share) * excess;
    use_rest(share == 1 ? inverse : Eigen::Matrix2d(inverse * stretch.inverse()), elements_[e]);
  }
}

void TriangleMembrane::couple(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Element& e : elements_)
    for (std::size_t k = 0; k < 3; ++k) pairs.emplace_back(e.particles[k], e.particles[(k + 1) % 3]);
}

void TriangleMembrane::attach(const solver::BlockMatrix& matrix) {
  slots_.resize(elements_.size());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        slots_[e][3 * a + b] = matrix.slot(elements_[e].particles[a], elements_[e].particles[b]);
}

// By differences to the first corner, so that only they are rounded.
TriangleMembrane::Gradient TriangleMembrane::gradient(const Element& element, std::span<const Vec3> x) {
  const auto& [a, b, c] = element.particles;
  const Vec3& origin = x[a];
  const Vec3 p = x[b] - origin, q = x[c] - origin;
  const Vec2 &gp = element.gradients[1], &gq = element.gradients[2];
  return {gp.x() * p + gq.x() * q, gp.y() * p + gq.y() * q};
}

void TriangleMembrane::add(const Evaluation& at) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const Element& element = elements_[e];
    const Gradient s = gradient(element, at.x), rate = gradient(element, at.v);
    // ½ μ ⟨s_u, s_v⟩ with viscosity, the shear stress.
    const double stress =
        0.5 * (shear_.modulus * s.u.dot(s.v) + shear_.viscosity * (rate.u.dot(s.v) + s.u.dot(rate.v)));
    const Vec3 along_u = element.area * (tension(stretch_.weft, stretch_.viscosity, s.u, rate.u) + stress * s.v);
    const Vec3 along_v = element.area * (tension(stretch_.warp, stretch_.viscosity, s.v, rate.v) + stress * s.u);
    for (std::size_t k = 0; k < 3; ++k)
      at.force[element.particles[k]] -= element.gradients[k].x() * along_u + element.gradients[k].y() * along_v;
    if (at.matrix == nullptr) continue;

    add_blocks(element, slots_[e], hessian(s, rate, at), *at.matrix);
  }
}

TriangleMembrane::Hessian TriangleMembrane::hessian(const Gradient& s, const Gradient& rate,
                                                    const Evaluation& at) const {
  Hessian h;
  h.uu = stretch_hessian(stretch_.weft, s.u, rate.u, at);
  h.vv = stretch_hessian(stretch_.warp, s.v, rate.v, at);
  add_shear_hessian(s, rate, at, h);
  return h;
}

// Σ gradients[a] gradients[b] h over the pairs of corners. Those with the first corner follow from the others: where
// all three move alike, nothing changes.
void TriangleMembrane::add_blocks(const Element& element, const std::array<solver::Slot, 9>& slots, const Hessian& h,
                                  solver::BlockMatrix& matrix) {
  const Vec2 p = element.area * element.gradients[1], q = element.area * element.gradients[2];
  const Vec2 &gp = element.gradients[1], &gq = element.gradients[2];
  const PackedBlock p_u = p.x() * h.uu + p.y() * h.vu, p_v = p.x() * h.uv + p.y() * h.vv;
  const PackedBlock q_u = q.x() * h.uu + q.y() * h.vu, q_v = q.x() * h.uv + q.y() * h.vv;
  const PackedBlock pp = gp.x() * p_u + gp.y() * p_v, pq = gq.x() * p_u + gq.y() * p_v;
  const PackedBlock qp = gp.x() * q_u + gp.y() * q_v, qq = gq.x() * q_u + gq.y() * q_v;
  const PackedBlock op = -(pp + qp), oq = -(pq + qq), po = -(pp + pq), qo = -(qp + qq);
  matrix.add(slots[0], -(op + oq));
  matrix.add(slots[1], op);
  matrix.add(slots[2], oq);
  matrix.add(slots[3], po);
  matrix.add(slots[4], pp);
  matrix.add(slots[5], pq);
  matrix.add(slots[6], qo);
  matrix.add(slots[7], qp);
  matrix.add(slots[8], qq);
}

// ∂/∂s + rate ∂/∂ṡ of the tension; see Stretch::stiffness, whose edge of unit length this is.
PackedBlock TriangleMembrane::stretch_hessian(double k, const Vec3& s, const Vec3& rate, const Evaluation& at) const {
  const double length = length_of(s);
  const Vec3 n = s / length;
  double lateral = 1 - 1 / length;
  if (at.linearisation == Linearisation::definite) lateral = std::max(lateral, 0.0);
  if (at.linearisation == Linearisation::abs_projected) lateral = std::min(std::abs(lateral), 1.0);
  PackedBlock hessian =
      packed_outer((k * (1 - lateral) + at.rate * stretch_.viscosity) * n, n) + packed_scalar(k * lateral);
  if (at.linearisation == Linearisation::exact && stretch_.viscosity > 0) {
    const double along = n.dot(rate), size = stretch_.viscosity / length;
    hessian = hessian + packed_outer(size * n, rate - 2 * along * n) + packed_scalar(size * along);
  }
  return hessian;
}

// As Shear: exactly, or of the second derivative 2 ⟨δs_u, δs_v⟩ = ½ (‖δs_u + δs_v‖² − ‖δs_u − δs_v‖²) the half whose
// sign agrees with the stress.
void TriangleMembrane::add_shear_hessian(const Gradient& s, const Gradient& rate, const Evaluation& at,
                                         Hessian& h) const {
  const double outer = 0.5 * (shear_.modulus + at.rate * shear_.viscosity);
  const double elastic = 0.5 * shear_.modulus * s.u.dot(s.v);
  h.uu = h.uu + packed_outer(outer * s.v, s.v);
  h.uv = packed_outer(outer * s.v, s.u);
  h.vu = packed_outer(outer * s.u, s.v);
  h.vv = h.vv + packed_outer(outer * s.u, s.u);
  if (at.linearisation != Linearisation::exact) {
    h.uu = h.uu + packed_scalar(0.5 * std::abs(elastic));
    h.vv = h.vv + packed_scalar(0.5 * std::abs(elastic));
    h.uv = h.uv + packed_scalar(0.5 * elastic);
    h.vu = h.vu + packed_scalar(0.5 * elastic);
    return;
  }
  const double viscosity = 0.5 * shear_.viscosity;
  const double stress = elastic + viscosity * (rate.u.dot(s.v) + s.u.dot(rate.v));
  h.uu = h.uu + packed_outer(viscosity * s.v, rate.v);
  h.uv = h.uv + packed_outer(viscosity * s.v, rate.u) + packed_scalar(stress);
  h.vu = h.vu + packed_outer(viscosity * s.u, rate.v) + packed_scalar(stress);
  h.vv = h.vv + packed_outer(viscosity * s.u, rate.u);
}

double TriangleMembrane::energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const Element& element : elements_) {
    const Gradient s = gradient(element, x);
    const double weft = s.u.norm() - 1, warp = s.v.norm() - 1, c = s.u.dot(s.v);
    sum += element.area *
           (0.5 * stretch_.weft * weft * weft + 0.5 * stretch_.warp * warp * warp + 0.25 * shear_.modulus * c * c);
  }
  return sum;
}

double TriangleMembrane::strain(std::size_t triangle, std::span<const Vec3> x) const {
  const Gradient s = gradient(elements_[triangle], x);
  return std::max(std::abs(s.u.norm() - 1), std::abs(s.v.norm() - 1));
}

double TriangleMembrane::max_strain(std::span<const Vec3> x) const {
  double largest = 0;
  for (std::size_t t = 0; t < elements_.size(); ++t) largest = std::max(largest, strain(t, x));
  return largest;
}

void TriangleMembrane::strain_per_particle(std::span<const Vec3> x, std::span<float> heat) const {
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const auto largest = static_cast<float>(strain(t, x));
    for (Index p : elements_[t].particles) {
      float& value = heat[p - first_];
      value = std::max(value, largest);
    }
  }
}

}  // namespace weft::forces
