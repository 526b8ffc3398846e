// Builds one TOML document from a scene file and overrides. Reader checks the keys and values of the document later.
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

/// The bytes of a scene file. Reports a mistake without a place if it is no regular file, too large or unreadable.
std::optional<std::string> read_file(const std::filesystem::path& file, Findings& findings);

/// Parses TOML text; reports a mistake and returns nothing if it is not TOML.
std::optional<toml::table> parse(std::string_view text, Findings& findings);

/// Inserts "path.to.key=value" into the document; list entries are addressed by name or index. A value that is a plain
/// word and not TOML counts as text.
void apply_override(const std::string& override_text, toml::table& document, Findings& findings);

}  // namespace weft::scene
