#include "film/garment/wearer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/error.hpp"

namespace weft::garment {
namespace {

// In this fraction of the upper arm, next to the shoulder, sections would cut the skin obliquely. The nearest section
// farther down the arm replaces them.
constexpr double kShoulderFraction = 0.25;
// Length by which the tube of an arm extends beyond the wrist, as a fraction of the forearm.
constexpr double kWristExtension = 0.3;
// The widest section of the head is searched down to this fraction of the distance from the crown to the neck.
constexpr double kHeadFraction = 0.6;
// Dome at the upper end of the head's tube: height of its top above the crown of a person [m], and ratio of its
// narrowest section to the widest.
constexpr double kDomeHeight = 0.08, kMinDomeScale = 0.3;
// Maximum length of a tube [m]. A body that is longer comes from a file in another unit, such as millimetres.
constexpr double kMaxLength = 100;
// Height of the people for whom lengths are chosen [m]; see size_factor().
constexpr double kPersonHeight = 1.7;
// Minimum number of crossings of triangle sides with the plane of a section (a side shared by two triangles counts
// twice). With fewer crossings, there is no section.
constexpr std::size_t kMinSectionPoints = 6;

double radians(int direction, int directions) {
  return 2 * std::numbers::pi * direction / directions;
}

/// An axis made of straight lines between its corners, from the low end to the high end.
struct Axis {
  std::vector<Vec3> corners;
  double first = 0;            // coordinate s (see Tube) of the first corner [m]
  double corner_blend = 0.06;  // length on each side of a corner over which the direction changes [m]

  double length() const {
    double sum = 0;
    for (std::size_t k = 1; k < corners.size(); ++k) sum += (corners[k] - corners[k - 1]).norm();
    return sum;
  }
  /// Point and direction at the distance `length` from the low end [m]. The direction is averaged over corner_blend
  /// on both sides, so that it changes gradually at corners.
  std::pair<Vec3, Vec3> at(double length) const {
    Vec3 along = Vec3::Zero(), point = corners.front();
    double from = 0;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const Vec3 side = corners[k] - corners[k - 1];
      const double to = from + side.norm();
      const bool last = k + 1 == corners.size();
      if (length >= from && (length <= to || last)) point = corners[k - 1] + (length - from) * side.normalized();
      const double overlap = std::min(last ? length + corner_blend : to, length + corner_blend) -
                             std::max(k == 1 ? length - corner_blend : from, length - corner_blend);
      if (overlap > 0) along += overlap * side.normalized();
      from = to;
    }
    return {point, along.normalized()};
  }
};

// Heights of the lowest and of the highest vertex of the skin [m].
std::pair<double, double> heights_of(const Wearer& wearer) {
  double floor = std::numeric_limits<double>::infinity(), crown = -floor;
  for (const Vec3& x : wearer.skin) floor = std::min(floor, x.z()), crown = std::max(crown, x.z());
  return {floor, crown};
}

const Limb& limb(const std::optional<Limb>& limb, const std::string& name, const char* joints) {
  if (limb) return *limb;
  throw Error(ExitCode::scene_invalid,
              "expected a wearer with the joints {} for panels around {}, got one without; [[character.joint]] names "
              "them",
              joints, name);
}

}  // namespace

Around mirrored(Around part) {
  switch (part) {
    case Around::left_arm:
      return Around::right_arm;
    case Around::right_arm:
      return Around::left_arm;
    case Around::left_leg:
      return Around::right_leg;
    case Around::right_leg:
      return Around::left_leg;
    default:
      return part;
  }
}

double nearest_power_of_two(double ratio) {
  return ratio > 0 ? std::exp2(std::round(std::log2(ratio))) : 1;
}

double size_factor(const Wearer& wearer) {
  const auto [floor, crown] = heights_of(wearer);
  return nearest_power_of_two((crown - floor) / kPersonHeight);
}

std::optional<Tube::Section> Tube::cut(const Wearer& wearer, const std::vector<mesh::Triangle>& skin,
                                       const Section& plane) const {
  std::vector<Vec2> points;
  for (const mesh::Triangle& t : skin)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = wearer.skin[t[k]] - plane.centre, b = wearer.skin[t[(k + 1) % 3]] - plane.centre;
      const double ha = a.dot(plane.along), hb = b.dot(plane.along);
      if ((ha < 0) == (hb < 0)) continue;
      const Vec3 p = a + ha / (ha - hb) * (b - a);
      points.emplace_back(p.dot(plane.front), p.dot(plane.left));
    }
  if (points.size() < kMinSectionPoints) return std::nullopt;
  Section section = plane;
  Vec2 low = points[0], high = points[0];
  for (const Vec2& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec2 middle = 0.5 * (low + high);
  section.centre += middle.x() * plane.front + middle.y() * plane.left;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = radians(k, kDirections);
    const Vec2 n(std::cos(angle), std::sin(angle));
    double support = -std::numeric_limits<double>::infinity();
    for (const Vec2& p : points) support = std::max(support, n.dot(p - middle));
    section.support[static_cast<std::size_t>(k)] = support;
  }
  return section;
}

Tube::Tube(const Wearer& wearer, Around part) {
  const auto [floor, crown] = heights_of(wearer);
  const double size = size_factor(wearer), dome_height = kDomeHeight * size;
  spacing_ *= size;
  const std::string& name = kAroundNames[static_cast<std::size_t>(part)];
  Axis axis{{Vec3(0, 0, floor), Vec3(0, 0, part == Around::head ? crown + dome_height : crown)}, floor};
  axis.corner_blend *= size;
  const bool arm = is_arm(part);
  const bool leg = part == Around::left_leg || part == Around::right_leg;
  const bool left = part == Around::left_arm || part == Around::left_leg;
  if (arm) {
    const Limb& joints = limb(left ? wearer.left_arm : wearer.right_arm, name, "UpperArm, LowerArm and Hand");
    const Vec3 end = joints[2] + kWristExtension * (joints[2] - joints[1]);
    axis.corners = {end, joints[1], joints[0]};
    axis.first = -axis.length();
  } else if (leg) {
    const Limb& joints = limb(left ? wearer.left_leg : wearer.right_leg, name, "UpperLeg, LowerLeg and Foot");
    axis.corners = {Vec3(joints[2].x(), joints[2].y(), floor), joints[2], joints[1], joints[0],
                    Vec3(joints[0].x(), joints[0].y(), wearer.neck)};
    axis.first = floor;
  }
  if (!(axis.length() <= kMaxLength))
    throw Error(ExitCode::scene_invalid,
                "expected at most {:g} m along {} of the wearer, got {:.4g} m; scale of its character says how many "
                "metres a unit of its file has",
                kMaxLength, name, axis.length());

  // Selects the skin that the tube encloses.
  std::vector<mesh::Triangle> skin;
  for (const mesh::Triangle& t : wearer.triangles) {
    const auto is = [&](Region region) {
      return (wearer.regions[t[0]] == region) + (wearer.regions[t[1]] == region) + (wearer.regions[t[2]] == region) >=
             2;
    };
    const bool on_side = (wearer.skin[t[0]] + wearer.skin[t[1]] + wearer.skin[t[2]]).x() * (left ? 1 : -1) > 0;
    bool belongs = true;
    if (arm) {
      belongs = is(left ? Region::left_arm : Region::right_arm);
    } else if (leg) {
      belongs = is(left ? Region::left_leg : Region::right_leg) || (is(Region::trunk) && on_side);
    } else if (part != Around::body) {
      belongs = !is(Region::left_arm) && !is(Region::right_arm);
    }
    if (belongs) skin.push_back(t);
  }

  const auto count = static_cast<int>(axis.length() / spacing_) + 1;
  first_ = axis.first;
  std::vector<std::optional<Section>> cuts;
  for (int i = 0; i < count; ++i) {
    const auto [point, along] = axis.at(i * spacing_);
    Section plane;
    plane.centre = point, plane.along = along;
    plane.front = (-Vec3::UnitY() + along.y() * along).normalized();
    plane.left = along.cross(plane.front);
    cuts.push_back(cut(wearer, skin, plane));
    const double s = first_ + i * spacing_;
    if (arm && -s < kShoulderFraction * (axis.corners[2] - axis.corners[1]).norm()) cuts.back() = std::nullopt;
  }
  // A hood hangs from the widest section of the head. Keeps only this section.
  double widest = first_;
  if (part == Around::head) {
    const auto girth_of = [](const std::optional<Section>& section) {
      return section ? std::accumulate(section->support.begin(), section->support.end(), 0.0) : 0.0;
    };
    const double low = crown - kHeadFraction * (crown - wearer.neck);
    const auto first = cuts.begin() + std::clamp(static_cast<int>((low - first_) / spacing_), 0, count - 1);
    const auto found = std::ranges::max_element(first, cuts.end(), {}, girth_of);
    const std::optional<Section> section = *found;
    std::ranges::fill(cuts, std::nullopt);
    *found = section;
    widest = first_ + static_cast<double>(found - cuts.begin()) * spacing_;
  }
  // Where there is no section, uses the nearest section, moved along the axis.
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < cuts.size(); ++i)
    if (cuts[i]) known.push_back(i);
  if (known.empty())
    throw Error(ExitCode::scene_invalid, "expected a wearer with skin around {} for the panels there, got none", name);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto above = std::ranges::lower_bound(known, i);
    std::size_t nearest = above == known.end() ? known.back() : *above;
    if (above != known.begin() && above != known.end() && i - *(above - 1) < nearest - i) nearest = *(above - 1);
    Section section = *cuts[nearest];
    section.centre +=
        axis.at(static_cast<double>(i) * spacing_).first - axis.at(static_cast<double>(nearest) * spacing_).first;
    sections_.push_back(section);
  }
  // Above the widest section, narrows the tube to a dome, so that seams that end at the crown of a hood start near the
  // crown of the head.
  if (part == Around::head)
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      const double height =
          std::clamp((first_ + static_cast<double>(i) * spacing_ - widest) / (crown + dome_height - widest), 0.0, 1.0);
      const double scale = std::max(std::sqrt(1 - height * height), kMinDomeScale);
      sections_[i].scale = scale;
      for (double& support : sections_[i].support) support *= scale;
    }
  // A cloak hangs from the widest section above. Widens each section so that it contains the section above.
  if (part == Around::body)
    for (std::size_t i = sections_.size() - 1; i-- > 0;) {
      const Section& above = sections_[i + 1];
      const Vec3 shift = above.centre - sections_[i].centre;
      for (int k = 0; k < kDirections; ++k) {
        const double angle = radians(k, kDirections);
        double& support = sections_[i].support[static_cast<std::size_t>(k)];
        support =
            std::max(support, above.support[static_cast<std::size_t>(k)] + std::cos(angle) * shift.dot(above.front) +
                                  std::sin(angle) * shift.dot(above.left));
      }
    }
}

Tube::Section Tube::section(double s) const {
  const double place = (s - first_) / spacing_;
  const double last = static_cast<double>(sections_.size() - 1);
  const double inside = std::clamp(place, 0.0, last);
  // A limb that is shorter than spacing_ has only one section. Then `below` is 0, and both sections below are the same.
  const auto below = std::min(static_cast<std::size_t>(inside), std::max<std::size_t>(sections_.size(), 2) - 2);
  const double fraction = inside - static_cast<double>(below);
  const Section &a = sections_[below], &b = sections_[std::min(below + 1, sections_.size() - 1)];
  Section mixed = a;
  mixed.centre = (1 - fraction) * a.centre + fraction * b.centre;
  mixed.along = ((1 - fraction) * a.along + fraction * b.along).normalized();
  mixed.front = (-Vec3::UnitY() + mixed.along.y() * mixed.along).normalized();
  mixed.left = mixed.along.cross(mixed.front);
  for (std::size_t k = 0; k < mixed.support.size(); ++k)
    mixed.support[k] = (1 - fraction) * a.support[k] + fraction * b.support[k];
  mixed.scale = (1 - fraction) * a.scale + fraction * b.scale;
  mixed.centre += (place - inside) * spacing_ * mixed.along;
  return mixed;
}

// Points on the boundary of a section. The boundary of a convex region with the support function h(φ) is h n + h' t,
// with the unit vectors n in the direction φ and t in the direction φ + 90°.
Tube::Ring Tube::ring(const Section& section, double outward) {
  Ring points;
  const double step = 2 * std::numbers::pi / kDirections;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = radians(k, kDirections), h = section.support[static_cast<std::size_t>(k)] + outward;
    const double slope = (section.support[static_cast<std::size_t>((k + 1) % kDirections)] -
                          section.support[static_cast<std::size_t>((k + kDirections - 1) % kDirections)]) /
                         (2 * std::sin(step));
    const double f = h * std::cos(angle) - slope * std::sin(angle), l = h * std::sin(angle) + slope * std::cos(angle);
    points[static_cast<std::size_t>(k)] = section.centre + f * section.front + l * section.left;
  }
  return points;
}

double Tube::length(const Ring& points) {
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) sum += (points[(k + 1) % points.size()] - points[k]).norm();
  return sum;
}

double Tube::girth(double s, double outward) const {
  const Section here = section(s);
  return length(ring(here, here.scale * outward)) / here.scale;
}

Vec3 Tube::at(double s, double angle, double length, double outward) const {
  const Section here = section(s);
  const Ring points = ring(here, here.scale * outward);
  const auto n = static_cast<long>(points.size());
  const auto point = [&](long k) -> const Vec3& { return points[static_cast<std::size_t>(((k % n) + n) % n)]; };
  // Follows the ring from the direction `angle`, forward or backward.
  const double place = angle / (2 * std::numbers::pi) * kDirections;
  auto k = static_cast<long>(std::floor(place));
  double fraction = place - std::floor(place);
  const double total = Tube::length(points);
  if (!(total > 0)) return here.centre;
  length = std::remainder(here.scale * length, total);
  length += fraction * (point(k + 1) - point(k)).norm();
  while (length < 0) --k, length += (point(k + 1) - point(k)).norm();
  while (length > (point(k + 1) - point(k)).norm()) length -= (point(k + 1) - point(k)).norm(), ++k;
  const double side = (point(k + 1) - point(k)).norm();
  fraction = side > 0 ? length / side : 0;
  return (1 - fraction) * point(k) + fraction * point(k + 1);
}

Vec3 Tube::along(double s) const {
  return section(s).along;
}

}  // namespace weft::garment
