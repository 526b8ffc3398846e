// Limits the nesting depth of TOML and JSON before a recursive parser or destructor could overflow the stack.
#pragma once

#include <string_view>

namespace weft {

/// Maximum number of nested levels: in JSON, of the whole text; in TOML, of one header, or of one
/// key with its value. Lists, tables and components of a dotted key count as levels. No shipped
/// scene has more than ten. A parser needs less than 1 kB of stack per level, and the stack usually
/// has 8 MB.
inline constexpr int kMaxDepth = 128;

/// Whether TOML or JSON text nests deeper than kMaxDepth. The count is meaningless from the first
/// syntax error on, where the parser stops. If this returns false, a TOML document nests at most
/// about 3 kMaxDepth levels: a key is counted without the header above it, and each component of a
/// header may be a list of tables, which has two levels.
bool nests_too_deep(std::string_view text);

}  // namespace weft
