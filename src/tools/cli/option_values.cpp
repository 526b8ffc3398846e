#include "tools/cli/option_values.hpp"

#include "core/nearest.hpp"

namespace weft::cli {

std::string did_you_mean(const std::string& name, std::span<const std::string> known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

int parse_integer(const char* option, const std::string& text, int low, int high) {
  const auto value = number_in<int>(text);
  if (!value || *value < low || *value > high)
    throw Error(ExitCode::usage, "{}: expected a whole number from {} to {}, got {}", option, low, high, text);
  return *value;
}

double parse_fraction(const char* option, const std::string& text) {
  const auto value = number_in<double>(text);
  if (!value || !(*value >= 0 && *value <= 1))
    throw Error(ExitCode::usage, "{}: expected a number from 0 to 1, got {}", option, text);
  return *value;
}

double parse_factor(const char* option, const std::string& text) {
  constexpr double kMost = 100;
  const auto value = number_in<double>(text);
  if (!value || !(*value >= 1 / kMost && *value <= kMost))
    throw Error(ExitCode::usage, "{}: expected numbers from {:g} to {:g}, got {}", option, 1 / kMost, kMost, text);
  return *value;
}

double parse_length(const char* option, const std::string& text) {
  constexpr double kLeast = 1e-9, kMost = 1;
  const auto value = number_in<double>(text);
  if (!value || !(*value >= kLeast && *value <= kMost))
    throw Error(ExitCode::usage, "{}: expected lengths from {:g} to {:g} m, got {}", option, kLeast, kMost, text);
  return *value;
}

double parse_fps(const std::string& text) {
  constexpr double kMost = 1000;
  const auto value = number_in<double>(text);
  if (!value || !(*value > 0 && *value <= kMost))
    throw Error(ExitCode::usage, "--fps: expected a number of frames a second, above 0 and up to {}, got {}", kMost,
                text);
  return *value;
}

std::string check_override(const std::string& text) {
  if (text.find('=') == std::string::npos || text.front() == '=')
    throw Error(ExitCode::usage, "--set: expected path.to.key=value such as cloth.band.material.stretch=1e6, got {}",
                text);
  return text;
}

}  // namespace weft::cli
