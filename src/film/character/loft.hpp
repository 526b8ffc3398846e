// Smooth bodies lofted from cross-sections: the implicit surfaces that make up the mannequin.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace weft::character {

/// A cross-section of a loft: the superellipse |u / side|^n + |v / depth|^n = 1 about its centre. n is `exponent`; the
/// depth is `front` for v > 0, else `back`. All lengths are in metres.
struct Section {
  double at = 0;        ///< position along the axis
  double u = 0, v = 0;  ///< centre
  double side = 0;      ///< half width
  double front = 0;     ///< depth for v > 0, measured from the centre
  double back = 0;      ///< depth for v < 0, measured from the centre
  double exponent = 2;  ///< 2: an ellipse; larger: closer to a rectangle
};

/// Placement of a loft: its origin, its axis, and the directions of u and v. The three directions may form a
/// left-handed system.
struct LoftFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 along = Vec3::UnitZ(), u = Vec3::UnitX(), v = -Vec3::UnitY();
};

/// A surface through sections: cubic splines (twice continuously differentiable, zero slope at both ends) join the
/// sections, and half ellipsoids close the ends. A single section makes an ellipsoid.
class Loft {
 public:
  /// `sections`: in ascending order of `at`. `first_cap`, `last_cap`: lengths of the half ellipsoids beyond the first
  /// and the last section, > 0 [m].
  Loft(const LoftFrame& frame, const std::vector<Section>& sections, double first_cap, double last_cap);

  /// Distance from p to the surface [m], negative inside. It is measured along the ray through p from the centre of the
  /// cross-section at p or, beyond an end, from the centre of the section at this end.
  double value(const Vec3& p) const;

  const Box3& bounds() const { return bounds_; }

 private:
  static constexpr std::size_t kSizes = 6;
  using Sizes = std::array<double, kSizes>;  ///< members of a Section: u, v, side, front, back, exponent

  Sizes sizes_at(double t) const;

  LoftFrame frame_;
  double first_cap_, last_cap_;
  std::vector<double> at_;
  std::vector<Sizes> sizes_;
  std::vector<Sizes> slopes_;  ///< spline slopes at the sections
  Box3 bounds_;
};

/// Minimum of two values of fields, smoothed if these differ by less than `width` [m].
double smooth_min(double a, double b, double width);

/// Smooth union of lofts. Each loft is blended into the preceding ones over its own width [m], so that no crease
/// remains.
class BlendedBody {
 public:
  /// A scalar field [m] that cuts a part; negative where the part remains.
  using Cut = std::function<double(const Vec3&)>;

  /// Begins a group: the parts that follow, up to the next group, are near each other. Groups do not affect the field.
  /// The parts of a group that is far from a point are skipped together.
  void begin_group() { groups_.push_back({.end = parts_.size()}); }

  /// Adds a part. A paired part exists twice, mirrored at x = 0. If `cut` is given, the part exists only where `cut` is
  /// negative, with an edge that is rounded over the width `blend` [m].
  void add(Loft part, double blend, bool paired, Cut cut = {}) {
    append({std::move(part), blend, paired, false, std::move(cut)});
  }

  /// Subtracts a shape from all preceding parts, with an edge that is rounded over the width `blend` [m].
  void carve(Loft part, double blend, bool paired) { append({std::move(part), blend, paired, true, {}}); }

  /// Value of the field at p [m], negative inside.
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
  struct Group {
    std::size_t end = 0;   ///< index after its last part
    Box3 bounds = {};      ///< of its parts, without mirror images
    double max_blend = 0;  ///< largest blend width of its parts
    bool paired = false;   ///< whether it has paired parts
  };

  void append(Part part);

  std::vector<Part> parts_;
  std::vector<Group> groups_;
};

}  // namespace weft::character
