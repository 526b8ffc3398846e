// From the body that a pattern is drawn for to another: how much wider and longer.
#pragma once

#include <string>

#include "garment/pattern.hpp"
#include "garment/wearer.hpp"

namespace weft::garment {

/// All measures of a body as it stands: with a tape around its trunk, without the arms. The waist is the narrowest
/// place between hips and armpits, hip and chest are the widest below and above it.
Measures measure(const Wearer& wearer);

/// Factors on lengths across and up: across the largest ratio of a girth that both have, so that the garment is nowhere
/// tighter than drawn; up that of the heights. What is not named on one side of a pattern does not change, and a height
/// alone counts for both. `where` names what asks for it. Throws Error(scene_invalid) where a pattern names no
/// measures.
Vec2 fit_factors(const Pattern& pattern, const Wearer& wearer, const std::string& where);

/// What is to be told of a garment that hangs from the waist alone, of a wearer whose hips are hardly wider than it is
/// there with `factors` on its drawing; empty: they hold it.
std::string doubt_that_hips_hold(const Pattern& pattern, const Vec2& factors, const Wearer& wearer);

}  // namespace weft::garment
