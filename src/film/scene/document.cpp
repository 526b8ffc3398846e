#include "film/scene/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/input_file.hpp"
#include "core/toml.hpp"
#include "film/scene/reader.hpp"

namespace weft::scene {

namespace {

/// Text of a parse error for the user. Replaces the parser's own texts about a repeated key and about a key in two
/// forms, such as [cloth] and [[cloth]].
std::string explain(std::string_view description) {
  const std::string_view redefined = "cannot redefine existing ";
  const auto found = description.find(redefined);
  const auto begin = description.find('\'', found == std::string_view::npos ? 0 : found);
  const auto end = description.find('\'', begin + 1);
  if (found == std::string_view::npos || end == std::string_view::npos) return fmt::format("not TOML: {}", description);
  const std::string name = in_quotes(description.substr(begin + 1, end - begin - 1));
  if (description.substr(end + 1).starts_with(" as "))
    return fmt::format("expected {} in one form, in [ ], in [[ ]] or as a value, got two; entries of a list need [[ ]]",
                       name);
  return fmt::format("expected each key once, got {} again", name);
}

}  // namespace

std::optional<std::string> read_file(const std::filesystem::path& file, Findings& findings) {
  const auto refuse = [&](const std::string& got) -> std::optional<std::string> {
    findings.report("", {}, "expected a scene file, got " + got);
    return std::nullopt;
  };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return refuse("no such file");
  if (std::filesystem::is_directory(status)) return refuse("a folder");
  if (!std::filesystem::is_regular_file(status)) return refuse("a device or pipe");

  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return refuse(error.message());
  if (size > kMaxFileSize) {
    findings.report("", {}, fmt::format("expected at most {} MB, got {} MB", kMaxFileSize >> 20, size >> 20));
    return std::nullopt;
  }
  try {
    return read_bytes(file, kMaxFileSize);
  } catch (const std::exception& problem) {
    return refuse(std::string("a file that cannot be read: ") + problem.what());
  }
}

std::optional<toml::table> parse(std::string_view text, Findings& findings) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    findings.report("", {}, "expected a scene, got an empty file");
    return std::nullopt;
  }
  if (const auto zero = text.find('\0'); zero != std::string_view::npos) {
    findings.report("", {}, fmt::format("expected text, got binary data (byte 0 at offset {})", zero));
    return std::nullopt;
  }
  try {
    return parse_toml(text);
  } catch (const toml::parse_error& error) {
    findings.report("", place_of(error.source()), explain(error.description()));
    return std::nullopt;
  }
}

}  // namespace weft::scene
