// The known name closest to a misspelt one, for messages such as "did you mean mass?".
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft {

/// Minimum number of edits that turn one text into the other. An edit inserts, deletes or replaces
/// a byte, or swaps two neighbouring bytes; no byte is edited twice (Damerau, "A technique for
/// computer detection and correction of spelling errors", 1964).
int edit_distance(std::string_view from, std::string_view to);

/// Considers the names in `known` whose edit distance from `name` is less than half the length of the
/// longer one of the two names. Returns the first name with the smallest distance; empty if there is none.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace weft
