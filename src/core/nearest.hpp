// "Did you mean": the known name closest to a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft {

/// Minimum number of insertions, deletions, replacements and swaps of neighbours that turn one text into the other
/// (Damerau, "A technique for computer detection and correction of spelling errors", 1964). No letter is edited twice.
int edit_distance(std::string_view from, std::string_view to);

/// Considers the names of `known` whose edit distance from `name` is less than half the length of the longer of the two
/// names. Returns the one with the smallest distance (the first of several); empty if there is none.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace weft
