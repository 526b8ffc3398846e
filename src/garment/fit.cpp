#include "garment/fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"

namespace weft::garment {
namespace {

// Height of the hip joints of a wearer without legs, in heights of the body.
constexpr double kHips = 0.52;
// In heights from hip joints to neck: where the hips begin, the lowest and the highest waist, and armpits. Above them
// the sections go over shoulders.
constexpr double kLowestHip = -0.1, kLowestWaist = 0.2, kHighestWaist = 0.55, kArmpits = 0.75;
// Apart of sections that are measured [m].
constexpr double kSpacing = 0.01;
// Least girth of the hips, in waists of a garment, over which it stays up: one of 1.05 fell, 1.16 and more held.
constexpr double kHolds = 1.1;

}  // namespace

Measures measure(const Wearer& wearer) {
  const Tube torso(wearer, Around::torso);
  const double height = torso.high();
  double hips = kHips * height;
  if (wearer.left_leg && wearer.right_leg) hips = 0.5 * ((*wearer.left_leg)[0].z() + (*wearer.right_leg)[0].z());
  const auto at = [&](double share) { return hips + share * (wearer.neck - hips); };
  const auto girth = [&](double s) { return torso.girth(s, 0); };
  double waist = at(kLowestWaist);
  for (double s = waist; s <= at(kHighestWaist); s += kSpacing)
    if (girth(s) < girth(waist)) waist = s;
  const auto widest = [&](double low, double high) {
    double most = 0;
    for (double s = low; s <= high; s += kSpacing) most = std::max(most, girth(s));
    return most;
  };
  return {widest(waist, at(kArmpits)), girth(waist), widest(at(kLowestHip), waist), height};
}

Vec2 fit_factors(const Pattern& pattern, const Wearer& wearer, const std::string& where) {
  const Measures& drawn = pattern.measures;
  if (!drawn.chest && !drawn.waist && !drawn.hip && !drawn.height)
    throw Error(ExitCode::scene_invalid,
                "{}.fit: expected a pattern that names the measures it is drawn for, as [measures] with chest, waist, "
                "hip or height, got none in {}",
                where, pattern.file.string());
  const Measures own = measure(wearer);
  double across = 0, up = 1;
  for (const auto girth : {&Measures::chest, &Measures::waist, &Measures::hip})
    if (drawn.*girth) across = std::max(across, *(own.*girth) / *(drawn.*girth));
  if (drawn.height) up = *own.height / *drawn.height;
  return {across > 0 ? across : up, up};
}

std::string doubt_that_hips_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer) {
  const Measures& drawn = pattern.measures;
  if (!drawn.waist || drawn.chest) return {};
  const double waist = *drawn.waist * factors.x(), hips = *measure(wearer).hip;
  if (hips >= kHolds * waist) return {};
  return fmt::format(
      "its waist is {:.2f} m around and the hips of its wearer {:.2f} m, which do not hold it up: pin its waist, as in "
      "pin = [{{ edge = \"{}\", follow = \"WEARER.torso\" }}]",
      waist, hips, pattern.panels.empty() ? "PANEL.EDGE" : pattern.panels.front().name + ".EDGE");
}

}  // namespace weft::garment
