// Nesting depth of TOML and JSON, checked before any parser or destructor recurses.
#pragma once

#include <string_view>

namespace weft {

/// Maximum nesting depth of JSON, and of one header or one key with its value of TOML: lists, tables, and the
/// components of a dotted key. No scene has more than ten. Each level takes less than 1 kB of a stack of 8 MB.
inline constexpr int kMaxDepth = 128;

/// Whether TOML or JSON text nests deeper than kMaxDepth. Behind the first mistake of a text, where the parser stops,
/// the result is arbitrary. A TOML document that passes is at most about three times as deep as kMaxDepth, for two
/// reasons. A key counts without the header above it. Each component of a header may be a list of tables, which has two
/// levels.
bool nests_too_deep(std::string_view text);

}  // namespace weft
