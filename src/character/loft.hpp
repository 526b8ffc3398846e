// Smooth bodies from cross-sections: the implicit surfaces of which the mannequin is made.
#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace weft::character {

/// A cross-section at a place along the axis of a loft: a superellipse, |u / side|^n + |v / depth|^n = 1, with
/// different depths to the front (v > 0) and to the back. Lengths in metres.
struct Section {
  double at = 0;        ///< along the axis
  double u = 0, v = 0;  ///< its middle
  double side = 0;      ///< half of its width
  double front = 0;     ///< depth from the middle
  double back = 0;
  double exponent = 2;  ///< 2: an ellipse; more: toward a rectangle
};

/// How a loft lies: its axis, and the directions of u and v. Right-handed or not: only lengths count.
struct LoftFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 along = Vec3::UnitZ(), u = Vec3::UnitX(), v = -Vec3::UnitY();
};

/// Sections joined by cubic splines (twice continuously differentiable, flat at both ends) and closed by two halves of
/// ellipsoids. One section alone makes an ellipsoid.
class Loft {
 public:
  /// Sections in ascending order; caps are lengths > 0 [m] beyond the first and the last one.
  Loft(const LoftFrame& frame, const std::vector<Section>& sections, double first_cap, double last_cap);

  /// Negative inside, 0 on the surface; the distance along the ray from the nearest point of the axis [m].
  double value(const Vec3& p) const;

  /// No surface outside of it.
  const Box3& bounds() const { return bounds_; }

 private:
  static constexpr std::size_t kSizes = 6;
  using Sizes = std::array<double, kSizes>;

  Sizes sizes_at(double t) const;

  LoftFrame frame_;
  double first_cap_, last_cap_;
  std::vector<double> at_;
  std::vector<Sizes> sizes_;
  std::vector<Sizes> slopes_;  ///< at the sections
  Box3 bounds_;
};

/// The minimum of two fields, rounded where they are closer than `width` [m].
double smooth_min(double a, double b, double width);

/// Union of lofts, each blended into those before it over a width of its own [m], so that no crease remains.
class BlendedBody {
 public:
  /// Negative where a part is kept [m].
  using Cut = std::function<double(const Vec3&)>;

  /// Paired parts are there twice, mirrored at x = 0. Of a part with a cut only what that keeps is there, with an edge
  /// that is as round as the blend is wide.
  void add(Loft part, double blend, bool paired, Cut cut = {}) {
    parts_.push_back({std::move(part), blend, paired, false, std::move(cut)});
  }

  /// Takes a shape away from all parts before it, with an edge that is rounded over a width [m].
  void carve(Loft part, double blend, bool paired) { parts_.push_back({std::move(part), blend, paired, true, {}}); }

  double operator()(const Vec3& p) const;
  Box3 bounds() const;

 private:
  struct Part {
    Loft shape;
    double blend;
    bool paired, carved;
    Cut cut;

    double value(const Vec3& p) const;
  };
  std::vector<Part> parts_;
};

}  // namespace weft::character
