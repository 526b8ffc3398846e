// Parses TOML.
#pragma once

#include <toml++/toml.h>

#include <string_view>

#include "core/nesting.hpp"

namespace weft {

/// Parses TOML. Throws toml::parse_error if the text is not TOML or nests_too_deep() is true.
/// `source`: path of the file, for error messages.
inline toml::table parse_toml(std::string_view text, std::string_view source = {}) {
  if (nests_too_deep(text))
    throw toml::parse_error("expected at most 128 levels of lists, tables and dotted keys, got more",
                            toml::source_position{1, 1});
  return toml::parse(text, source);
}

}  // namespace weft
