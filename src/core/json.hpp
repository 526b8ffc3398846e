// The one way to JSON from text, and back.
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/input_file.hpp"
#include "core/nesting.hpp"

namespace weft {

/// Throws std::exception for what is no JSON, nests too deep (nlohmann::json copies, compares and writes by recursion),
/// or has too many keys in one object (nlohmann::ordered_json compares each key with all those before it).
template <class Json = nlohmann::ordered_json>
Json parse_json(std::string_view text) {
  if (nests_too_deep(text)) throw std::runtime_error("expected at most 128 levels of lists and objects, got more");
  constexpr std::size_t kMostComparisons = 200'000'000;  // of keys; statistics of 100,000 frames take 40 million
  std::size_t comparisons = 0;
  std::array<std::size_t, kMaxDepth + 2> keys{};  // so far, of the object that is read at each depth
  return Json::parse(text, [&](int depth, nlohmann::json::parse_event_t event, Json&) {
    using Event = nlohmann::json::parse_event_t;
    const auto level = static_cast<std::size_t>(depth);
    if (event == Event::object_start) keys.at(level + 1) = 0;
    if (event == Event::key && (comparisons += keys.at(level)++) > kMostComparisons)
      throw std::runtime_error("expected fewer keys in its objects");
    return true;
  });
}

/// The value of a key; `otherwise` where `json` is no object, lacks the key, or has a value of another type there.
/// nlohmann's own value() throws for the first and the last, which is an internal error unless somebody catches it.
template <class T, class Json>
T value_or(const Json& json, const char* key, T otherwise) {
  if (!json.is_object()) return otherwise;
  const auto found = json.find(key);
  if (found == json.end()) return otherwise;
  bool fits = false;
  if constexpr (std::is_same_v<T, std::string>) {
    fits = found->is_string();
  } else if constexpr (std::is_same_v<T, double>) {
    fits = found->is_number();
  } else {
    static_assert(std::is_same_v<T, int>);
    fits = found->is_number_integer() && *found >= std::numeric_limits<int>::min() &&
           *found <= std::numeric_limits<int>::max();
  }
  return fits ? found->template get<T>() : otherwise;
}

/// What a file holds; null for what cannot be read.
inline nlohmann::ordered_json read_json_or_null(const std::filesystem::path& file) {
  try {
    return parse_json(read_bytes(file, kLargestText));
  } catch (const std::exception&) {
    return nullptr;
  }
}

/// Text from outside, such as names of files, may not be UTF-8, which JSON cannot hold: it is replaced.
inline std::string json_text(const nlohmann::ordered_json& json, int indent = -1) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace weft
