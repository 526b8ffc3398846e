#include "scene/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scene/reader.hpp"

namespace weft::scene {

namespace {

/// toml++ limits how deep values nest, but not dotted keys, and takes the stack to free what is nested too deep.
constexpr int kMaxDots = 128;

/// Whether some key may be dotted deeper than kMaxDots: counts the dots between characters that end a key.
bool has_deep_key(std::string_view text) {
  int dots = 0;
  for (const char c : text) {
    if (c == '.') {
      if (++dots > kMaxDots) return true;
    } else if (std::strchr(",=[]{}\n#", c) != nullptr && c != '\0') {
      dots = 0;
    }
  }
  return false;
}

/// The parser's words; what it says of a key that is there twice, in ours.
std::string explain(std::string_view description) {
  const std::string_view redefined = "cannot redefine existing ";
  const auto found = description.find(redefined);
  const auto begin = description.find('\'', found == std::string_view::npos ? 0 : found);
  const auto end = description.find('\'', begin + 1);
  if (found == std::string_view::npos || end == std::string_view::npos) return fmt::format("not TOML: {}", description);
  return fmt::format("expected each key once, got {} again", in_quotes(description.substr(begin + 1, end - begin - 1)));
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
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return refuse(std::string("a file that cannot be opened: ") + std::strerror(errno));
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (stream.bad()) return refuse("a file that cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
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
  if (has_deep_key(text)) {
    findings.report("", {}, fmt::format("expected at most {} dots in a key, got more", kMaxDots));
    return std::nullopt;
  }
  try {
    return toml::parse(text, std::string_view{});
  } catch (const toml::parse_error& error) {
    findings.report("", place_of(error.source()), explain(error.description()));
    return std::nullopt;
  }
}

}  // namespace weft::scene
