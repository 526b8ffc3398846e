// The part of Reader that converts single TOML values to checked values.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "core/input_file.hpp"
#include "film/scene/reader.hpp"

namespace weft::scene {

Value Reader::read_value(const toml::node& node, const Rule& rule, const std::string& path) {
  switch (rule.type) {
    case Type::boolean:
      if (const auto* flag = node.as_boolean()) return flag->get();
      return refuse_type(node, rule, path);
    case Type::color:
      return read_color(node, rule, path);
    case Type::number:
      if (!rule.choices.empty() && node.is_string()) return read_text(node, rule, path);
      return read_numbers(node, rule, path);
    case Type::texts:
      return read_texts(node, rule, path);
    case Type::points:
      return read_points(node, rule, path);
    default:
      return read_text(node, rule, path);
  }
}

Value Reader::read_text(const toml::node& node, const Rule& rule, const std::string& path) {
  const auto* string = node.as_string();
  if (string == nullptr) {
    return refuse_type(node, rule, path);
  }
  const std::string& text = string->get();
  if (rule.type == Type::text && rule.need == Need::required && text.empty())
    return refuse(node, path, fmt::format("expected {}, got an empty one", expectation(rule)));
  if (rule.type == Type::file) return check_file(node, text, path);
  if (!rule.choices.empty() && std::find(rule.choices.begin(), rule.choices.end(), text) == rule.choices.end()) {
    return refuse(
        node, path,
        fmt::format("expected {}, got {}{}", expectation(rule), in_quotes(text), suggestion(text, rule.choices)));
  }
  if (rule.type == Type::name && !is_name(text)) {
    return refuse(node, path, fmt::format("expected {}, got {}", expectation(rule), in_quotes(text)));
  }
  return text;
}

Value Reader::read_texts(const toml::node& node, const Rule& rule, const std::string& path) {
  std::vector<std::string> texts;
  if (const auto* string = node.as_string()) texts.push_back(string->get());
  const auto* array = node.as_array();
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const auto* string = array->get(i)->as_string();
    if (string == nullptr) return refuse_type(*array->get(i), rule, path);
    texts.push_back(string->get());
  }
  if (texts.empty()) return refuse_type(node, rule, path);
  if (std::ranges::any_of(texts, &std::string::empty))
    return refuse(node, path, fmt::format("expected {}, got an empty one", expectation(rule)));
  return texts;
}

bool Reader::read_number(const toml::node& node, const Rule& rule, const std::string& path, double& number) {
  const auto* integer = node.as_integer();
  const auto* real = node.as_floating_point();
  if (integer == nullptr && real == nullptr) {
    refuse_type(node, rule, path);
    return false;
  }
  number = integer != nullptr ? static_cast<double>(integer->get()) : real->get();
  const auto& [low, high, low_open] = rule.range;
  const bool inside = std::isfinite(number) && number <= high && (low_open ? number > low : number >= low);
  if (!inside) {
    refuse(node, path, fmt::format("expected {}, got {}", violated_bound(rule, number), describe_node(node)));
    return false;
  }
  if (rule.whole && number != std::floor(number)) {
    refuse(node, path, fmt::format("expected a whole number, got {}", describe_node(node)));
    return false;
  }
  return true;
}

Value Reader::read_numbers(const toml::node& node, const Rule& rule, const std::string& path) {
  const auto* array = node.as_array();
  const bool single = rule.components.empty() || (rule.single_fills_all && array == nullptr);
  if (single) {
    double number = 0;
    if (!read_number(node, rule, path, number)) return {};
    return std::vector<double>(std::max<std::size_t>(1, rule.components.size()), number);
  }
  if (array == nullptr || array->size() != rule.components.size()) {
    return refuse_type(node, rule, path);
  }
  std::vector<double> numbers(array->size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    // Report only the first wrong number, because a key has at most one mistake.
    if (!read_number(*array->get(i), rule, path, numbers[i])) return {};
  }
  if (rule.nonzero && std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::abs(x) < kRoundoff; })) {
    return refuse(node, path, "expected at least one number that is not 0, got 0 in all");
  }
  return numbers;
}

Value Reader::read_points(const toml::node& node, const Rule& rule, const std::string& path) {
  const auto* array = node.as_array();
  if (array == nullptr || array->empty()) return refuse_type(node, rule, path);
  std::vector<double> all;
  for (const toml::node& point : *array) {
    const Value numbers = read_numbers(point, rule, path);
    if (std::holds_alternative<std::monostate>(numbers)) return {};
    const auto& own = std::get<std::vector<double>>(numbers);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

Value Reader::read_color(const toml::node& node, const Rule& rule, const std::string& path) {
  const auto* string = node.as_string();
  if (string == nullptr) return read_numbers(node, rule, path);

  const std::string& text = string->get();
  const auto is_hex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  if (text.size() != 7 || text[0] != '#' || !std::all_of(text.begin() + 1, text.end(), is_hex)) {
    return refuse_type(node, rule, path);
  }
  std::vector<double> rgb(3);
  for (std::size_t i = 0; i < 3; ++i) rgb[i] = std::stoi(text.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
  return rgb;
}

Value Reader::check_file(const toml::node& node, const std::string& text, const std::string& path) {
  const auto missing = [&](const std::string& why) {
    return refuse(node, path, fmt::format("expected a readable file, got {}: {}", in_quotes(text), why));
  };
  if (text.empty() || text.find('\0') != std::string::npos) return missing("not a file name");
  const std::filesystem::path full = std::filesystem::absolute(folder_ / text).lexically_normal();
  std::error_code error;
  const auto status = std::filesystem::status(full, error);
  if (!std::filesystem::exists(status)) return missing(fmt::format("there is no {}", full.string()));
  if (!std::filesystem::is_regular_file(status)) return missing(fmt::format("{} is not a file", full.string()));
  // The text is UTF-8, as TOML is.
  if (!is_utf8(full.string()))
    return missing("the path of the scene's folder is not UTF-8, but the effective scene must be; rename the folder");
  try {
    check_is_file(full);
  } catch (const std::runtime_error& problem) {
    return missing(fmt::format("{} cannot be opened: {}", full.string(), problem.what()));
  }
  return full.string();
}

}  // namespace weft::scene
