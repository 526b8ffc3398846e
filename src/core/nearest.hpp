// "Did you mean": the known name closest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn one text into the other (Damerau, "A
/// technique for computer detection and correction of spelling errors", 1964; each position edited once).
int edit_distance(std::string_view from, std::string_view to);

/// The closest of `known`, the first of several; empty if half of the letters or more would have to be edited.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace weft
