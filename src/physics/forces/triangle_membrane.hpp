// Stretch and shear of cloth made of triangles, elastic and viscous.
#pragma once

#include <array>

#include "physics/forces/shear.hpp"
#include "physics/forces/stretch.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::forces {

/// The continuum of Stretch and Shear on triangles of constant strain. The derivatives s_u and s_v of the positions
/// along weft and warp are constant in each triangle (the elements of Baraff & Witkin, "Large Steps in Cloth
/// Simulation", 1998, but with the energy of the continuum). The energy density is
///
///     ½ k1 (‖s_u‖ − 1)² + ½ k2 (‖s_v‖ − 1)² + ¼ μ ⟨s_u, s_v⟩²
///
/// The dissipation has the same form in the rates. If the positions are linear in u and v, the
/// stress is exactly that of the continuum, for any orientation of the triangles.
class TriangleMembrane : public Membrane {
 public:
  /// A triangle; s_u and s_v are linear in its corners.
  struct Element {
    std::array<Index, 3> particles;
    std::array<Vec2, 3> gradients;  // s_u = Σ gradients[k].x() x_k, s_v likewise [1/m]
    double area;                    // [m²], times Reinforcement::stretch
  };

  TriangleMembrane(const mesh::Sheet& sheet, Index first, const StretchParameters& stretch,
                   const ShearParameters& shear);

  void append_couplings(std::vector<std::pair<Index, Index>>& pairs) const override;
  void attach(const solver::Assembly& assembly) override;
  void partition(std::span<const Index> bounds) override;
  void add(const Evaluation& at) const override;
  void add_jacobian(std::span<const Vec3> x, std::span<const Vec3> v, double rate,
                    solver::BlockMatrix& jacobian) const override;
  double energy(std::span<const Vec3> x) const override;
  /// For sewn sheets: interpolates the rest shape of each triangle between its shape at the start (progress 0; the
  /// start has no stress) and that in the pattern (progress 1). The deformation from the pattern to the start has a
  /// right stretch tensor U in the axes of weft and warp; this function interpolates linearly between U and the
  /// identity. A triangle that accept_rest_shape() has stopped keeps its rest shape. A triangle that
  /// was stopped earlier progresses at twice the speed until it has caught up with `progress`.
  void interpolate_rest_shape(double progress);
  /// For sewn sheets, after each step: stops the triangles whose threads are extended by more than
  /// `max_extension` with corners at x [m], until the next call. Thus cloth whose pattern is too
  /// narrow for a body stays wide enough. Threads that are shorter at the start than in the pattern
  /// do not count, because further sewing releases them. Returns whether the progress has become 1
  /// in this step. `elapsed`: length of the step relative to the duration of the sewing. After the
  /// step in which the progress becomes 1, each call advances triangles that lag and are not stopped
  /// by `elapsed`; call interpolate_rest_shape(1) afterwards.
  bool accept_rest_shape(std::span<const Vec3> x, double max_extension, double elapsed);
  /// Whether the next accept_rest_shape() advances triangles: the progress is 1, and a triangle that
  /// is not stopped lags.
  bool is_catching_up() const;
  /// The particle around which the cloth is wider than in the pattern by the largest fraction of its width: all of its
  /// triangles are at least as wide. Single wide triangles, as at the tip of a dart, do not show.
  struct Widening {
    double fraction = 0;  ///< 0 if every particle has a triangle with its shape in the pattern
    Index particle = 0;
  };
  Widening widening() const;
  /// Saves or restores which triangles were stopped. Call interpolate_rest_shape(`progress`), with
  /// the progress of the last accepted step, after restoring.
  template <class Archive>
  void serialize_rest_shape(Archive& archive, double progress);
  /// Copies what serialize_rest_shape() saves from `other`, a membrane of the same sheet.
  void copy_rest_state(const TriangleMembrane& other);
  std::span<const Element> elements() const { return elements_; }

 protected:
  /// Derivatives along weft and warp, of positions or of velocities.
  struct Gradient {
    Vec3 u, v;
  };
  /// Gradient in a triangle with corners at a, b and c. Differences to a corner make rounding errors proportional to
  /// the size of the triangle, not to its distance from the origin.
  static Gradient gradient(const Element& element, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 p = b - a, q = c - a;
    const Vec2 &gp = element.gradients[1], &gq = element.gradients[2];
    return {gp.x() * p + gq.x() * q, gp.y() * p + gq.y() * q};
  }
  /// The larger relative change of length of a triangle along weft or warp, in absolute value.
  virtual double strain(std::size_t triangle, std::span<const Vec3> x) const;

  StretchParameters stretch_;
  ShearParameters shear_;

 private:
  void for_each_strain(std::span<const Vec3> x, const VisitStrain& visit) const override;
  /// Four triangles, each with its corners in ascending order of particle numbers.
  struct Triangles {
    std::array<IndexLanes, 3> corners{};
    std::array<IndexLanes, 3> blocks{};  // of the pairs 01, 02, 12
    std::array<Lanes, 3> along, across;  // x and y of the gradients
    Lanes area{};
  };
  struct GradientLanes {
    VecLanes u, v;
  };
  static void set_rest_shape(const Eigen::Matrix2d& inverse, Element& element);
  static Eigen::Matrix2d stretch_of(const Gradient& s);
  static Gradient gradient(const Element& element, std::span<const Vec3> x);
  template <class Points>
  static GradientLanes gradient(const Triangles& triangles, Points x);
  /// ‖s_u‖, ‖s_v‖ and ⟨s_u, s_v⟩
  static VecLanes strains_of(const GradientLanes& s);
  void pack();
  void add_stiffness(const Triangles& triangles, const GradientLanes& s, const Lanes& length_u, const Lanes& length_v,
                     const Lanes& shear, const Evaluation& at) const;
  Mat3 stretch_hessian(double k, const Vec3& s, const Vec3& speed, double rate) const;

  std::vector<Element> elements_;
  /// For sewn sheets: the inverse of the matrix of a triangle's sides in the pattern, and U − I (see
  /// interpolate_rest_shape).
  struct SewnTriangle {
    Eigen::Matrix2d inverse, excess;
    double lag = 0;           // progress at the last accepted step, minus that of this triangle
    bool is_stopped = false;  // whether the triangle keeps its rest shape until the next accepted step
  };
  double progress_of(const SewnTriangle& triangle, double progress) const;
  std::vector<SewnTriangle> sewn_triangles_;
  double progress_ = 0, accepted_progress_ = 0;  // of the last interpolate_rest_shape(), of the last accepted step
  std::vector<Triangles> packs_;
  Ranges ranges_;  // of packs
};

}  // namespace weft::forces
