#include "physics/forces/triangle_membrane.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/archive.hpp"

namespace weft::forces {

namespace {

// ‖s‖, at least kMinStretch
Lanes length_of(const VecLanes& s) {
  return max(sqrt(dot(s, s)), lanes_of(kMinStretch));
}

}  // namespace

TriangleMembrane::TriangleMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                                   const ShearParameters& shear)
    : Membrane(first), stretch_(stretch), shear_(shear) {
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    Element element;
    for (std::size_t k = 0; k < 3; ++k) element.particles[k] = first + sheet.triangles[t][k];
    const auto& m = sheet.material[t];
    Eigen::Matrix2d sides;
    sides << m[1] - m[0], m[2] - m[0];
    element.area = 0.5 * sides.determinant();
    if (!sheet.reinforcements.empty()) element.area *= sheet.reinforcements[t].stretch;
    const Eigen::Matrix2d inverse = sides.inverse();
    set_rest_shape(inverse, element);
    elements_.push_back(element);
    if (!sheet.sewn) continue;
    Gradient s{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = sheet.rest[sheet.triangles[t][k]];
      s.u += element.gradients[k].x() * x;
      s.v += element.gradients[k].y() * x;
    }
    sewn_triangles_.push_back({inverse, stretch_of(s) - Eigen::Matrix2d::Identity()});
  }
  pack();
}

void TriangleMembrane::pack() {
  packs_.resize(packs_of(elements_.size()));
  for (std::size_t p = 0; p < packs_.size(); ++p)
    for_each_lane(elements_.size(), p, [&](std::size_t e, std::size_t lane, bool is_used) {
      const Element& element = elements_[e];
      std::array<std::size_t, 3> order{0, 1, 2};
      std::ranges::sort(order, {}, [&](std::size_t k) { return element.particles[k]; });
      for (std::size_t k = 0; k < 3; ++k) {
        packs_[p].corners[k][lane] = element.particles[order[k]];
        packs_[p].along[k][lane] = element.gradients[order[k]].x();
        packs_[p].across[k][lane] = element.gradients[order[k]].y();
      }
      packs_[p].area[lane] = is_used ? element.area : 0;
    });
}

// U of the polar decomposition: the square root of the metric tensor, whose entries are s_u·s_u, s_u·s_v and s_v·s_v.
Eigen::Matrix2d TriangleMembrane::stretch_of(const Gradient& s) {
  Eigen::Matrix2d metric;
  metric << s.u.dot(s.u), s.u.dot(s.v), s.u.dot(s.v), s.v.dot(s.v);
  const double area = s.u.cross(s.v).norm();
  return (metric + area * Eigen::Matrix2d::Identity()) / std::sqrt(metric.trace() + 2 * area);
}

// `inverse`: inverse of the matrix whose columns are the sides of the triangle at rest, from its
// first corner.
void TriangleMembrane::set_rest_shape(const Eigen::Matrix2d& inverse, Element& element) {
  element.gradients[1] = inverse.row(0);
  element.gradients[2] = inverse.row(1);
  element.gradients[0] = -(element.gradients[1] + element.gradients[2]);
}

double TriangleMembrane::progress_of(const SewnTriangle& triangle, double progress) const {
  const double since = progress - accepted_progress_;
  return progress - std::max(0.0, triangle.is_stopped ? triangle.lag + since : triangle.lag - since);
}

void TriangleMembrane::interpolate_rest_shape(double progress) {
  progress_ = progress;
  for (std::size_t e = 0; e < sewn_triangles_.size(); ++e) {
    const double own = progress_of(sewn_triangles_[e], progress);
    const Eigen::Matrix2d &inverse = sewn_triangles_[e].inverse,
                          stretch = Eigen::Matrix2d::Identity() + (1 - own) * sewn_triangles_[e].excess;
    set_rest_shape(own == 1 ? inverse : Eigen::Matrix2d(inverse * stretch.inverse()), elements_[e]);
  }
  if (!sewn_triangles_.empty()) pack();
}

bool TriangleMembrane::accept_rest_shape(std::span<const Vec3> x, double max_extension, double elapsed) {
  const bool was_sewn = accepted_progress_ == 1;
  for (std::size_t e = 0; e < sewn_triangles_.size(); ++e) {
    SewnTriangle& triangle = sewn_triangles_[e];
    if (was_sewn && triangle.lag == 0) continue;
    if (!was_sewn)
      triangle.lag = progress_ - progress_of(triangle, progress_);
    else if (!triangle.is_stopped)
      triangle.lag = std::max(0.0, triangle.lag - elapsed);
    // Only threads that are longer at the start than in the pattern can stop a triangle. Further sewing shortens these,
    // but reduces the tension of all others.
    const Gradient s = gradient(elements_[e], x);
    const double longest = 1 + max_extension;
    triangle.is_stopped =
        (s.u.norm() > longest && triangle.excess(0, 0) > 0) || (s.v.norm() > longest && triangle.excess(1, 1) > 0);
  }
  accepted_progress_ = progress_;
  return !was_sewn && progress_ == 1;
}

bool TriangleMembrane::is_catching_up() const {
  return accepted_progress_ == 1 && std::ranges::any_of(sewn_triangles_, [](const SewnTriangle& start) {
           return start.lag > 0 && !start.is_stopped;
         });
}

TriangleMembrane::Widening TriangleMembrane::widening() const {
  std::map<Index, double> least;  // by particle: smallest fraction of its triangles
  for (std::size_t e = 0; e < sewn_triangles_.size(); ++e) {
    const SewnTriangle& triangle = sewn_triangles_[e];
    const Eigen::Matrix2d excess = (1 - accepted_progress_ + triangle.lag) * triangle.excess;
    const double fraction = triangle.lag == 0 ? 0 : std::max(excess(0, 0), excess(1, 1));
    for (const Index particle : elements_[e].particles) {
      double& of_particle = least.try_emplace(particle, fraction).first->second;
      of_particle = std::min(of_particle, fraction);
    }
  }
  Widening widest;
  for (const auto& [particle, fraction] : least)
    if (fraction > widest.fraction) widest = {fraction, particle};
  return widest;
}

template <class Archive>
void TriangleMembrane::serialize_rest_shape(Archive& archive, double progress) {
  for (SewnTriangle& triangle : sewn_triangles_) {
    archive.value(triangle.lag);
    archive.value(triangle.is_stopped);
    require(triangle.lag >= 0 && triangle.lag <= 1, "a progress of sewing");
  }
  accepted_progress_ = progress;
}

template void TriangleMembrane::serialize_rest_shape(ByteWriter&, double);
template void TriangleMembrane::serialize_rest_shape(ByteReader&, double);

void TriangleMembrane::copy_rest_state(const TriangleMembrane& other) {
  for (std::size_t e = 0; e < sewn_triangles_.size(); ++e) {
    sewn_triangles_[e].lag = other.sewn_triangles_[e].lag;
    sewn_triangles_[e].is_stopped = other.sewn_triangles_[e].is_stopped;
  }
  accepted_progress_ = other.accepted_progress_;
}

void TriangleMembrane::append_couplings(std::vector<std::pair<Index, Index>>& pairs) const {
  for (const Element& e : elements_) append_pairs_of(e.particles, pairs);
}

void TriangleMembrane::attach(const solver::Assembly& assembly) {
  for (Triangles& t : packs_) find_pairs(t.corners, t.blocks, [&](Index i, Index j) { return assembly.block(i, j); });
}

TriangleMembrane::Gradient TriangleMembrane::gradient(const Element& element, std::span<const Vec3> x) {
  const auto& [a, b, c] = element.particles;
  return gradient(element, x[a], x[b], x[c]);
}

template <class Points>
TriangleMembrane::GradientLanes TriangleMembrane::gradient(const Triangles& t, Points x) {
  const VecLanes origin = gather(x, t.corners[0]);
  const VecLanes p = gather(x, t.corners[1]) - origin, q = gather(x, t.corners[2]) - origin;
  return {t.along[1] * p + t.along[2] * q, t.across[1] * p + t.across[2] * q};
}

VecLanes TriangleMembrane::strains_of(const GradientLanes& s) {
  return {length_of(s.u), length_of(s.v), dot(s.u, s.v)};
}

void TriangleMembrane::partition(std::span<const Index> bounds) {
  cut_packs(
      bounds, packs_, [](const Triangles& t) { return std::span(t.corners); }, ranges_);
}

void TriangleMembrane::add(const Evaluation& at) const {
  const bool viscous = stretch_.viscosity > 0 || shear_.viscosity > 0;
  ranges_.for_each(at.range, packs_.size(), [&](std::size_t p) {
    const Triangles& t = packs_[p];
    const GradientLanes s = gradient(t, at.x);
    const VecLanes strains = strains_of(s);
    const auto& [length_u, length_v, shear] = strains;
    // Tensions k (‖s‖ − 1) and shear stress ½ μ ⟨s_u, s_v⟩, both with viscosity [N/m].
    Lanes tension_u = stretch_.weft * (length_u - 1), tension_v = stretch_.warp * (length_v - 1);
    Lanes stress = 0.5 * shear_.modulus * shear;
    if (viscous) {
      const auto by_velocity = [&]() -> VecLanes {
        const GradientLanes rate = gradient(t, at.v);
        return {dot(s.u, rate.u) / strains.x, dot(s.v, rate.v) / strains.y, dot(rate.u, s.v) + dot(s.u, rate.v)};
      };
      const VecLanes rate = at.rate_of(
          strains, [&](std::span<const Vec3> x) { return strains_of(gradient(t, x)); }, by_velocity);
      tension_u += stretch_.viscosity * rate.x;
      tension_v += stretch_.viscosity * rate.y;
      stress += 0.5 * shear_.viscosity * rate.z;
    }
    const VecLanes along = t.area * (tension_u / length_u * s.u + stress * s.v),
                   across = t.area * (tension_v / length_v * s.v + stress * s.u);
    for (std::size_t k = 0; k < 3; ++k) subtract(at.force, t.corners[k], t.along[k] * along + t.across[k] * across);
    if (at.assembly) add_stiffness(t, s, length_u, length_v, shear, at);
  });
}

// Blocks of the pairs (a, b): gradients[a] gradients[b] times the second derivatives of the energy in s_u and s_v. The
// stretch terms are those of Stretch for an edge of rest length 1. The shear terms are those of Shear: the second
// derivative of ⟨s_u, s_v⟩ is 2 ⟨δs_u, δs_v⟩ = ½ (‖δs_u + δs_v‖² − ‖δs_u − δs_v‖²). After
// multiplication by the stress, one of these squares is positive and one negative. The matrix
// contains only the positive one.
void TriangleMembrane::add_stiffness(const Triangles& t, const GradientLanes& s, const Lanes& length_u,
                                     const Lanes& length_v, const Lanes& shear, const Evaluation& at) const {
  const auto lateral_of = [](const Lanes& length) { return max(1 - 1 / length, lanes_of(0.0)); };
  const Lanes lateral_u = lateral_of(length_u), lateral_v = lateral_of(length_v);
  const double viscous = at.rate * stretch_.viscosity;
  const Lanes shear_stress = 0.5 * shear_.modulus * t.area * shear;
  // Factors of s_u s_uᵀ in ∂²/∂s_u², of s_v s_vᵀ in ∂²/∂s_v², of the outer products in shear, and of the identity.
  const Lanes axial_u = t.area * (stretch_.weft * (1 - lateral_u) + viscous) / (length_u * length_u);
  const Lanes axial_v = t.area * (stretch_.warp * (1 - lateral_v) + viscous) / (length_v * length_v);
  const Lanes outer_shear = 0.5 * (shear_.modulus + at.rate * shear_.viscosity) * t.area;
  const Lanes identity_u = t.area * stretch_.weft * lateral_u + 0.5 * abs(shear_stress);
  const Lanes identity_v = t.area * stretch_.warp * lateral_v + 0.5 * abs(shear_stress);
  for (std::size_t a = 0, pair = 0; a < 3; ++a)
    for (std::size_t b = a + 1; b < 3; ++b, ++pair) {
      const Lanes xx = t.along[a] * t.along[b], yy = t.across[a] * t.across[b];
      const Lanes xy = t.along[a] * t.across[b], yx = t.across[a] * t.along[b];
      const VecLanes of_u = (xx * axial_u + yy * outer_shear) * s.u + xy * outer_shear * s.v;
      const VecLanes of_v = (yy * axial_v + xx * outer_shear) * s.v + yx * outer_shear * s.u;
      const Lanes identity_factor = xx * identity_u + yy * identity_v + 0.5 * (xy + yx) * shear_stress;
      forces::add(at.assembly, t.blocks[pair], outer(of_u, s.u, identity_factor) + outer(of_v, s.v));
    }
}

// Derivative ∂/∂s + rate ∂/∂ṡ of T s/‖s‖, where T is the tension along a thread and `speed` is ṡ.
Mat3 TriangleMembrane::stretch_hessian(double k, const Vec3& s, const Vec3& speed, double rate) const {
  const double length = std::max(s.norm(), kMinStretch), lateral = 1 - 1 / length;
  const Vec3 n = s / length;
  const double along = n.dot(speed), size = stretch_.viscosity / length;
  return (k * (1 - lateral) + rate * stretch_.viscosity) * n * n.transpose() + k * lateral * Mat3::Identity() +
         size * (n * (speed - 2 * along * n).transpose() + along * Mat3::Identity());
}

void TriangleMembrane::add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                                    solver::BlockMatrix& jacobian) const {
  for (const Element& element : elements_) {
    const Gradient s = gradient(element, x), w = gradient(element, v);
    const double outer = 0.5 * (shear_.modulus + rate * shear_.viscosity), viscosity = 0.5 * shear_.viscosity;
    const double stress = 0.5 * shear_.modulus * s.u.dot(s.v) + viscosity * (w.u.dot(s.v) + s.u.dot(w.v));
    const Mat3 uu = stretch_hessian(stretch_.weft, s.u, w.u, rate) + s.v * (outer * s.v + viscosity * w.v).transpose();
    const Mat3 vv = stretch_hessian(stretch_.warp, s.v, w.v, rate) + s.u * (outer * s.u + viscosity * w.u).transpose();
    const Mat3 uv = s.v * (outer * s.u + viscosity * w.u).transpose() + stress * Mat3::Identity();
    const Mat3 vu = s.u * (outer * s.v + viscosity * w.v).transpose() + stress * Mat3::Identity();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        const Vec2 &g = element.gradients[a], &h = element.gradients[b];
        jacobian.add(jacobian.slot(element.particles[a], element.particles[b]), element.area,
                     g.x() * h.x() * uu + g.x() * h.y() * uv + g.y() * h.x() * vu + g.y() * h.y() * vv);
      }
  }
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

void TriangleMembrane::for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const {
  for (std::size_t t = 0; t < elements_.size(); ++t) visit(strain(t, x), elements_[t].particles);
}

}  // namespace weft::forces
