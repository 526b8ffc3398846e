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

/// Maximum size of a scene file [bytes]. For comparison: a scene with ten thousand key frames has about one megabyte.
inline constexpr std::uintmax_t kMaxFileSize = 16 << 20;

/// Reads a scene file. If `file` is not a regular file, is larger than kMaxFileSize or cannot be read, reports a
/// mistake without a place and returns nothing.
std::optional<std::string> read_file(const std::filesystem::path& file, Findings& findings);

/// Parses TOML text. If the text is empty or not TOML, reports a mistake and returns nothing.
std::optional<toml::table> parse(std::string_view text, Findings& findings);

/// Sets a value in the document. `override_text`: "path.to.key=value". In the path, a name or an index selects an entry
/// of a list or array, also as its last part. Creates missing tables. A plain word that is not a TOML value counts as
/// text. If the path or the value is not valid, reports a mistake and changes no value. `batch`: see Place.
void apply_override(const std::string& override_text, int batch, toml::table& document, Findings& findings);

}  // namespace weft::scene
