#include "film/garment/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.hpp"

namespace weft::garment {
namespace {

// Height of the hip joints as a fraction of the body height, for wearers that lack the joints of a leg.
constexpr double kHipHeightRatio = 0.52;
// Limits of the heights at which parts of the trunk are searched, above the hip joints, as fractions of the height from
// hip joints to neck. The armpits have a limit because sections above them include the shoulders.
constexpr double kLowestHip = -0.1, kLowestWaist = 0.2, kHighestWaist = 0.55, kHighestArmpit = 0.75;
// Maximum change of the girth per height at the waist: 2π, which is that of a cone with an inclination of 45 degrees.
constexpr double kMaxGirthSlope = 2 * std::numbers::pi;
// Minimum ratio of the wearer's hip girth to the waist girth of a garment at which the garment does not slide down. In
// simulations, garments slide down at a ratio of 1.05 and stay at 1.16.
constexpr double kMinHipToWaistRatio = 1.1;

// Parts around which a garment that hangs from the waist has no panels.
constexpr std::array kAboveWaist{Around::neck, Around::head, Around::left_arm, Around::right_arm};

// Height of the armpits: the lowest vertex at which skin of an arm joins skin of the trunk; infinite if there is none.
double armpit_height(const Wearer& wearer) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& triangle : wearer.triangles) {
    const auto is_arm = [&](Index v) {
      return wearer.regions[v] == Region::left_arm || wearer.regions[v] == Region::right_arm;
    };
    const auto is_trunk = [&](Index v) { return wearer.regions[v] == Region::trunk; };
    if (std::ranges::any_of(triangle, is_arm) && std::ranges::any_of(triangle, is_trunk))
      for (const Index v : triangle) lowest = std::min(lowest, wearer.skin[v].z());
  }
  return lowest;
}

// The tube around a part. Absent if the part lacks joints, or if sections through its skin are too small.
std::optional<Tube> find_tube(const Wearer& wearer, Around part) {
  try {
    return Tube(wearer, part);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// Girth of the upper arms: that of the narrowest section in the middle of both. Other sections may contain skin of the
// shoulder, of a bent forearm, or of an object in the hand. Absent if an arm has no tube (find_tube).
std::optional<double> arm_girth(const Wearer& wearer) {
  constexpr double kBegin = 0.3, kEnd = 0.7;  // fractions of the upper arm
  double narrowest = std::numeric_limits<double>::infinity();
  for (const bool left : {true, false}) {
    const std::optional<Limb>& limb = left ? wearer.left_arm : wearer.right_arm;
    const std::optional<Tube> arm = find_tube(wearer, left ? Around::left_arm : Around::right_arm);
    if (!limb || !arm) return std::nullopt;
    const double length = ((*limb)[1] - (*limb)[0]).norm();
    for (double s = -kEnd * length; s <= -kBegin * length; s += arm->spacing())
      narrowest = std::min(narrowest, arm->girth(s, 0));
  }
  return narrowest;
}

// The body without the arms.
struct Trunk {
  Tube tube;
  double hips, neck;  // heights of the joints [m]

  explicit Trunk(const Wearer& wearer) : Trunk(wearer, Tube(wearer, Around::torso)) {}
  Trunk(const Wearer& wearer, Tube torso) : tube(std::move(torso)), neck(wearer.neck) {
    hips = kHipHeightRatio * tube.high();
    if (wearer.left_leg && wearer.right_leg) hips = 0.5 * ((*wearer.left_leg)[0].z() + (*wearer.right_leg)[0].z());
  }
  // Heights are those of body parts only if the wearer stands upright.
  bool is_upright() const { return neck > hips; }
  double at(double fraction) const { return hips + fraction * (neck - hips); }
  double girth(double s) const { return tube.girth(s, 0); }
  double max_girth(double low, double high) const {
    double largest = 0;
    for (double s = low; s <= high; s += tube.spacing()) largest = std::max(largest, girth(s));
    return largest;
  }
  // Height of the waist: of the narrowest section at which the skin is steep enough to hold a waistband. It is not
  // where the girth changes faster than kMaxGirthSlope with height, such as at the end of the ball that joins chest and
  // hips of a puppet.
  double waist() const {
    const double spacing = tube.spacing();
    const auto is_steep = [&](double s) {
      return std::max(std::abs(girth(s + spacing) - girth(s)), std::abs(girth(s) - girth(s - spacing))) <=
             kMaxGirthSlope * spacing;
    };
    double waist = at(kLowestWaist);
    for (double s = waist; s <= at(kHighestWaist); s += spacing)
      if (girth(s) < girth(waist) && is_steep(s)) waist = s;
    return waist;
  }
  double hip_girth() const { return max_girth(at(kLowestHip), waist()); }
};

// Whether a garment hangs from the waist, as skirts and trousers do: if its highest point starts nearer to the waist of
// the drawn body than to its neck. Where this height is unknown, because the pattern states no height or seams place a
// panel, the measures decide.
bool hangs_from_waist(const Pattern& pattern) {
  const Measures& drawn = pattern.measures;
  const bool bent = pattern.has_bent_panels();
  bool is_known = drawn.height && !pattern.panels.empty();
  double top = -std::numeric_limits<double>::infinity();
  for (const Panel& panel : pattern.panels) {
    if (std::ranges::find(kAboveWaist, panel.around) != kAboveWaist.end()) return false;
    is_known = is_known && (panel.position || !bent);
    const Eigen::Rotation2Dd turn(panel.rotation * kDegree);
    const Vec2 origin = panel.position.value_or(Vec2(0, 0));
    for (const PanelEdge& edge : panel.edges)
      for (const Curve& curve : edge.curves)
        for (const Vec2& p : curve.control)
          top = std::max(top, origin.y() + Vec2(turn * Vec2(panel.scale.cwiseProduct(p))).y());
  }
  if (!is_known) return drawn.waist && !drawn.chest;
  return (drawn.waist || drawn.hip) && top < 0.5 * (kWaistHeightRatio + kNeckHeightRatio) * *drawn.height;
}

// For each panel, the height of its lowest corner at an armhole, in the drawing as it is turned at the start [m]:
// - on the trunk, the lowest end of an edge that is sewn to a panel around an arm;
// - on a panel around an arm, the lowest end of an edge that is sewn to a panel elsewhere;
// - if a sleeve is cut in one with a panel of the trunk, the corner at which the side seam and the under seam of the
//   sleeve meet. Both are sewn to the same panel. The under seam ends at the opening of the sleeve, an edge without a
//   seam that is farther from the middle of the wearer.
// Absent if the panel has no such corner.
std::vector<std::optional<double>> find_armholes(const Pattern& pattern) {
  std::vector<std::vector<Index>> sewn_to;  // by panel and edge: index of the other panel; −1: none
  for (const Panel& panel : pattern.panels) sewn_to.emplace_back(panel.edges.size(), -1);
  for (const Seam& seam : pattern.seams) {
    const auto [p, e] = pattern.find(seam.a);
    const auto [q, f] = pattern.find(seam.b);
    sewn_to[p][e] = static_cast<Index>(q);
    sewn_to[q][f] = static_cast<Index>(p);
  }
  std::vector<std::optional<double>> lowest(pattern.panels.size());
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    const std::vector<Index>& partners = sewn_to[p];
    const std::size_t count = panel.edges.size();
    const Eigen::Rotation2Dd turn(panel.rotation * kDegree);
    const auto turned_start = [&](std::size_t e) { return Vec2(turn * panel.edges[e % count].curves.front().start()); };
    const auto add = [&](const Vec2& corner) { lowest[p] = std::min(lowest[p].value_or(corner.y()), corner.y()); };
    for (std::size_t e = 0; e < count; ++e)
      if (partners[e] >= 0 && is_arm(pattern.panels[at(partners[e])].around) != is_arm(panel.around))
        add(turned_start(e)), add(turned_start(e + 1));
    if (lowest[p] || is_arm(panel.around)) continue;
    const double origin = panel.position.value_or(Vec2(0, 0)).x();
    for (std::size_t e = 0; e < count; ++e) {
      const std::size_t next = (e + 1) % count;
      if (partners[e] < 0 || at(partners[e]) == p || partners[next] != partners[e]) continue;
      const Vec2 corner = turned_start(next);
      // Seen from the corner, the opening follows one of both edges.
      for (const std::size_t opening : {(e + 2) % count, (e + count - 1) % count}) {
        const Vec2 a = turned_start(opening), b = turned_start(opening + 1);
        const bool is_outside =
            std::min(std::abs(origin + a.x()), std::abs(origin + b.x())) > std::abs(origin + corner.x());
        if (partners[opening] < 0 && is_outside && corner.y() < std::max(a.y(), b.y())) add(corner);
      }
    }
  }
  return lowest;
}

// Whether a thigh is nearer to level than to upright, as of a wearer that sits. Sections at the hips then contain it.
bool raises_thigh(const Wearer& wearer) {
  const auto is_raised = [](const std::optional<Limb>& leg) {
    return leg && ((*leg)[1] - (*leg)[0]).head<2>().norm() > (*leg)[0].z() - (*leg)[1].z();
  };
  return is_raised(wearer.left_leg) || is_raised(wearer.right_leg);
}

}  // namespace

Measures measure(const Wearer& wearer) {
  const Trunk trunk(wearer);
  const double waist = trunk.waist();
  const double armpits =
      std::clamp(armpit_height(wearer), std::max(waist, trunk.at(kHighestWaist)), trunk.at(kHighestArmpit));
  return {trunk.max_girth(waist, armpits), trunk.girth(waist), trunk.hip_girth(), arm_girth(wearer), trunk.tube.high()};
}

Fit fit(const Pattern& pattern, const Wearer& wearer, const std::string& where) {
  const Measures& drawn = pattern.measures;
  if (!drawn.chest && !drawn.waist && !drawn.hip && !drawn.arm && !drawn.height)
    throw Error(ExitCode::scene_invalid,
                "{}.fit: expected a pattern that names the measures it is drawn for, as [measures] with chest, waist, "
                "hip, arm or height, got none in {}",
                where, pattern.file.string());
  const Trunk trunk = [&] {
    try {
      return Trunk(wearer);
    } catch (const Error& error) {
      throw Error(error.code(), "{}.fit: {}", where, error.what());
    }
  }();
  if (!trunk.is_upright())
    throw Error(ExitCode::scene_invalid,
                "{}.fit: expected a wearer that stands upright, got one with its neck {:.2f} m and its hips {:.2f} m "
                "above its lowest point; turn it, or leave out fit",
                where, trunk.neck, trunk.hips);
  if ((drawn.hip || drawn.height) && raises_thigh(wearer))
    throw Error(ExitCode::scene_invalid,
                "{}.fit: expected a wearer that stands, got one with a thigh nearer to level than to upright; let it "
                "stand at first, as with stance = \"rest\" and dressing, or leave out fit",
                where);
  const Measures own = measure(wearer);
  const bool from_waist = hangs_from_waist(pattern);
  double across = 0, up = 1, below_armholes = 1, rise = 0, anchor = 0, gap = 1;
  for (const auto girth : {&Measures::chest, &Measures::waist, &Measures::hip, &Measures::arm}) {
    if (from_waist && (girth == &Measures::chest || girth == &Measures::arm)) continue;
    if (drawn.*girth && own.*girth) across = std::max(across, *(own.*girth) / *(drawn.*girth));
  }
  if (drawn.height && from_waist) {
    anchor = trunk.waist();
    up = anchor / (kWaistHeightRatio * *drawn.height);
    gap = nearest_power_of_two(up);
  } else if (drawn.height) {
    const double neck = kNeckHeightRatio * *drawn.height, of_necks = wearer.neck / neck;
    up = of_necks;
    gap = nearest_power_of_two(of_necks);
    if (drawn.arm && own.arm) up = std::max(up, *own.arm / *drawn.arm);
    if (up > of_necks && std::ranges::any_of(find_armholes(pattern), [](const auto& a) { return a.has_value(); }))
      below_armholes = of_necks / up;
    anchor = wearer.neck;
    rise = anchor - up * neck;
  }
  return {{across > 0 ? across : up, up}, below_armholes, rise, anchor, gap};
}

void shorten_below_armholes(Pattern& pattern, double factor) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::optional<double>> armholes = find_armholes(pattern);
  const bool bent = pattern.has_bent_panels();
  const auto start_height = [&](const Panel& panel) -> std::optional<double> {
    if (panel.position) return panel.position->y();
    return bent ? std::nullopt : std::optional(0.0);
  };
  // Panel::scale along the vertical axis of the drawing as it is turned at the start.
  const auto start_scale = [](const Panel& panel) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(panel.rotation * kDegree).toRotationMatrix();
    const Eigen::Matrix2d scale = turn * panel.scale.asDiagonal() * turn.transpose();
    return scale(1, 1);
  };
  // Heights at which the armholes start, on the trunk and on the arms [m].
  std::array<double, 2> levels{kInfinity, kInfinity};
  for (std::size_t p = 0; p < pattern.panels.size(); ++p)
    if (const Panel& panel = pattern.panels[p]; armholes[p] && start_height(panel)) {
      double& level = levels[is_arm(panel.around) ? 1 : 0];
      level = std::min(level, *start_height(panel) + start_scale(panel) * *armholes[p]);
    }
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    Panel& panel = pattern.panels[p];
    if (panel.around == Around::neck || panel.around == Around::head) continue;
    // Points of the drawing below `limit` approach the height `fixed`. A panel of which no height is known is wholly
    // below the armholes: its seams place it.
    double fixed = 0, limit = kInfinity;
    const double level = levels[is_arm(panel.around) ? 1 : 0];
    if (armholes[p])
      fixed = limit = *armholes[p];
    else if (const std::optional<double> start = start_height(panel); start && std::isfinite(level))
      fixed = limit = (level - *start) / start_scale(panel);
    const Eigen::Rotation2Dd turn(panel.rotation * kDegree);
    for (PanelEdge& edge : panel.edges)
      for (Curve& curve : edge.curves)
        for (Vec2& point : curve.control) {
          Vec2 turned = turn * point;
          if (turned.y() >= limit) continue;
          turned.y() = fixed + factor * (turned.y() - fixed);
          point = turn.inverse() * turned;
        }
  }
}

std::string warn_if_hips_do_not_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer) {
  const Measures& drawn = pattern.measures;
  if (!drawn.waist || !hangs_from_waist(pattern)) return {};
  std::optional<Tube> torso = find_tube(wearer, Around::torso);
  if (!torso) return {};
  const Trunk trunk(wearer, *std::move(torso));
  if (!trunk.is_upright()) return {};
  const double waist = *drawn.waist * factors.x(), hips = trunk.hip_girth();
  if (hips >= kMinHipToWaistRatio * waist) return {};
  return fmt::format(
      "its waist is {:.2f} m around and the hips of its wearer {:.2f} m, too narrow to hold it up: pin its waist, "
      "as in pin = [{{ edge = \"{}\", follow = \"WEARER.torso\" }}]",
      waist, hips, pattern.panels.empty() ? "PANEL.EDGE" : pattern.panels.front().name + ".EDGE");
}

}  // namespace weft::garment
