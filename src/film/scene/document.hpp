// Builds one TOML document from a scene file and overrides of the command line; Reader checks it later.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "film/scene/findings.hpp"

namespace weft::scene {

/// Maximum size of a scene file [bytes]; a scene with ten thousand key frames has about one megabyte.
inline constexpr std::uintmax_t kMaxFileSize = 16 << 20;

/// Reads a scene file. Reports a mistake without a place and returns nothing if the file is no regular file, too large
/// or unreadable.
std::optional<std::string> read_file(const std::filesystem::path& file, Findings& findings);

/// Parses TOML text. Reports a mistake and returns nothing if the text is empty or not TOML.
std::optional<toml::table> parse(std::string_view text, Findings& findings);

/// Sets a value in the document, given as "path.to.key=value". The path names entries of lists by name or index. A
/// plain word that is no TOML value counts as text.
void apply_override(const std::string& override_text, toml::table& document, Findings& findings);

}  // namespace weft::scene
