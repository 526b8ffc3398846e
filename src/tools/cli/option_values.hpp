// Converts texts of the command line to checked values. If a text is invalid, the functions that parse or check it
// throw Error(usage), which says what was expected.
#pragma once

#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace weft::cli {

/// "; did you mean X?", or empty if no known name is similar.
std::string did_you_mean(const std::string& name, std::span<const std::string> known);

template <class Value>
using Choice = std::pair<const char*, Value>;

template <class Value, std::size_t N>
Value parse_choice(const char* option, const std::string& text, const std::array<Choice<Value>, N>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) {
    if (text == name) return value;
    names.emplace_back(name);
  }
  throw Error(ExitCode::usage, "{}: expected {}, got {}{}", option, fmt::join(names, " or "), text,
              did_you_mean(text, names));
}

/// The number that is the whole text; nullopt if it is none.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

int parse_integer(const char* option, const std::string& text, int low, int high);
/// A number from 0 to 1.
double parse_fraction(const char* option, const std::string& text);
/// A factor from 0.01 to 100.
double parse_factor(const char* option, const std::string& text);
/// A length in metres, from a nanometre to a metre.
double parse_length(const char* option, const std::string& text);
double parse_fps(const std::string& text);

/// Parses `0.5,1,2` into ascending values without duplicates.
template <class Value, class Parse>
std::vector<Value> parse_list(const char* option, const std::string& text, const Parse& parse) {
  std::set<Value> values;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (begin == end) throw Error(ExitCode::usage, "{}: expected numbers such as 1,2,4, got {}", option, text);
    values.insert(parse(option, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return {values.begin(), values.end()};
}

/// Checks the form `key=value` and returns the text unchanged.
std::string check_override(const std::string& text);

}  // namespace weft::cli
