// From a file and overrides to one TOML document, before anything is known of its meaning.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/findings.hpp"

namespace weft::scene {

/// Largest scene file that is read [bytes]; a scene with ten thousand key frames has about one megabyte.
inline constexpr std::uintmax_t kMaxFileSize = 16 << 20;

/// The bytes of a scene file, or nothing and a mistake without place. Looks at kind and size before it reads.
std::optional<std::string> read_file(const std::filesystem::path& file, Findings& findings);

/// Parses TOML text, or reports why it is none.
std::optional<toml::table> parse(std::string_view text, Findings& findings);

/// Puts "path.to.key=value" into the document; list entries go by name or index. A value that is no TOML but a plain
/// word is taken as text.
void apply_override(const std::string& override_text, toml::table& document, Findings& findings);

}  // namespace weft::scene
