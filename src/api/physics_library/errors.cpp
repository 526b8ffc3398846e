#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <string_view>

#include "api/physics_library/data.hpp"

namespace weft::library {
namespace {

// Removes a suffix such as ":12" from a text, and returns its number. If there is no such suffix,
// or its number is below 1, changes nothing and returns nothing.
std::optional<int> take_number(std::string_view& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const char *const begin = text.data() + colon + 1, *const end = text.data() + text.size();
  int number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stop != end || number < 1) return std::nullopt;
  text.remove_suffix(text.size() - colon);
  return number;
}

// Whether a text has the form of a key, such as "cloth.band".
bool is_key(std::string_view text) {
  const auto fits = [](char c) { return std::isspace(static_cast<unsigned char>(c)) == 0 && c != ':'; };
  return text.find('.') != std::string_view::npos && std::ranges::all_of(text, fits) &&
         std::islower(static_cast<unsigned char>(text.front())) != 0;
}

// Splits a message such as "scenes/a.toml:12:8: cloth.band: expected ..." into file, line, column, key and text. The
// message may lack line and column, or all parts before the text.
Mistake mistake_of(std::string_view text) {
  const std::string_view first_line = text.substr(0, text.find('\n'));
  std::size_t end = first_line.find(": ");
  Mistake mistake;
  mistake.text = text;
  if (end == std::string_view::npos || end == 0) return mistake;
  mistake.file = first_line.substr(0, end);
  // Names of folders may contain ": ". If the message has line and column, they end the name of the file.
  for (std::size_t next = end; next != std::string_view::npos; next = first_line.find(": ", next + 2)) {
    std::string_view file = first_line.substr(0, next);
    const std::optional<int> column = take_number(file), line = column ? take_number(file) : std::nullopt;
    if (!line) continue;
    mistake.file = file;
    mistake.line = *line, mistake.column = *column;
    end = next;
    break;
  }
  std::string_view rest = text.substr(end + 2);
  end = rest.find(": ");
  if (end != std::string_view::npos && end > 0 && is_key(rest.substr(0, end))) {
    mistake.key = rest.substr(0, end);
    rest.remove_prefix(end + 2);
  }
  mistake.text = rest;
  return mistake;
}

}  // namespace

void throw_public(const Error& error) {
  const std::string text = error.what();
  switch (error.code()) {
    case ExitCode::scene_invalid:
      throw SceneError(text, {mistake_of(text)});
    case ExitCode::asset_unreadable:
      throw FileError(text, {mistake_of(text)});
    case ExitCode::simulation_failed:
      throw SimulationError(text);
    default:
      throw std::runtime_error(text);
  }
}

}  // namespace weft::library
