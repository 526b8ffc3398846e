// Fits a pattern to a wearer, by ratios of body measures.
#pragma once

#include <string>

#include "film/garment/pattern.hpp"
#include "film/garment/wearer.hpp"

namespace weft::garment {

/// Measures a wearer in its pose. Its neck must be above its hip joints. Girths are those of convex sections of the
/// body without the arms; the limits of their heights are in fit.cpp.
/// - Waist: the narrowest section between kLowestWaist and kHighestWaist. Sections whose girth changes fast with height
///   do not count, except the lowest one.
/// - Chest: the widest section from the waist to the armpits. The armpits are the lowest place at which skin of an arm
///   joins the trunk, but at most kHighestArmpit.
/// - Hip: the widest section from kLowestHip to the waist.
/// - Arm: the narrowest section in the middle of both upper arms; absent if an arm lacks joints or is flat.
/// - Height: that of the crown, rounded down to a multiple of Tube::spacing().
/// Throws Error(scene_invalid) if Tube refuses the body without the arms.
Measures measure(const Wearer& wearer);

/// Change of a pattern for a wearer: the arguments of shorten_below_armholes() and, after it, of Pattern::scale_by().
struct Fit {
  Vec2 factors{1, 1};         ///< on lengths of the pattern, across and up
  double below_armholes = 1;  ///< factor on lengths up below the armholes, in addition to `factors`
  double rise = 0;            ///< of start positions that were multiplied by `factors` [m]
  /// Height of the wearer's neck or, for garments that hang from the waist, of its waist [m]: a further scale leaves
  /// the garment there. 0 if the pattern states no height.
  double anchor = 0;
  /// Factor on Pattern::gap: the ratio of the heights, rounded to a power of two, so that garments for people start as
  /// far from the skin as their patterns say. 1 if the pattern states no height.
  double gap = 1;
};

/// Factors on the lengths of a pattern. Across: the largest ratio wearer's girth / drawn girth among the girths that
/// the pattern states, so that the garment is nowhere tighter than drawn. Up: wearer's neck height / neck height of the
/// drawn body (kNeckHeightRatio of its height), or the ratio of the arms if that is larger, since armholes are drawn
/// along the body. In the second case, the ratio of the neck heights applies below the armholes, if find_armholes()
/// (fit.cpp) finds any. A garment hangs from the waist if none of its panels starts nearer to the neck of the drawn
/// body than to its waist, or around neck, head or arms: then the ratio up is that of the heights of the waists, and
/// chest and arms do not count. 1 if the pattern states no height. Neck heights are compared, since the height of the
/// head varies much between bodies. If the pattern states only a height, both factors are the ratio of neck heights.
/// The rise puts the neck of the drawn body, multiplied by the factor up, at the height of the wearer's. `where` names
/// the scene entry for messages. Throws Error(scene_invalid) if the pattern states no measures, if the wearer's neck is
/// not above its hip joints, if hips or heights are compared and a thigh is nearer to level than to upright, or if Tube
/// refuses the body without the arms.
Fit fit(const Pattern& pattern, const Wearer& wearer, const std::string& where);

/// Multiplies heights of outlines below the armholes by `factor`. What is above keeps its shape, and all panels keep
/// their start positions. The armhole ends at the lowest corner at which a panel of the trunk is sewn to one around an
/// arm, or, if the sleeve is cut in one with the trunk, at the corner between side seam and under seam. A panel around
/// an arm is shortened below its cap. Panels without such a corner are shortened below the height at which the lowest
/// one starts; panels around neck and head are not shortened. Both edges of a seam stay equally long if the armholes of
/// their panels start at the same height.
void shorten_below_armholes(Pattern& pattern, double factor);

/// Returns a warning if the wearer's hip girth is less than kMinHipToWaistRatio (fit.cpp) times the
/// waist girth of the garment after scaling by `factors`: the garment would slide down. Otherwise
/// returns an empty string. Checks only garments that hang from the waist, if the pattern states its girth, and only
/// wearers that stand upright.
std::string warn_if_hips_do_not_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer);

}  // namespace weft::garment
