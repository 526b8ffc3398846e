// Parses and writes JSON. Only json.cpp instantiates the parser and the writer of nlohmann::json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace weft {

/// Parses JSON. Throws an exception derived from std::exception if the text is not JSON, nests deeper than kMaxDepth
/// (nesting.hpp), or has too many keys in its objects. The depth is limited because nlohmann::json copies, compares and
/// writes values recursively. The number of keys is limited because nlohmann::ordered_json compares each key with all
/// earlier keys of its object.
template <class Json = nlohmann::ordered_json>
Json parse_json(std::string_view text);

extern template nlohmann::ordered_json parse_json(std::string_view);
extern template nlohmann::json parse_json(std::string_view);

/// Returns the value of a key; or `otherwise` if `json` is not an object, lacks the key, or has a value that is not a
/// T. T is std::string, double or int (values within the range of int). Use this function instead of
/// nlohmann::json::value(), which throws if `json` is not an object or the type differs.
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
    // Reading an unsigned number of 2^63 or more as std::int64_t would give a negative number.
    fits = found->is_number_unsigned()
               ? std::in_range<int>(found->template get<std::uint64_t>())
               : found->is_number_integer() && std::in_range<int>(found->template get<std::int64_t>());
  }
  return fits ? found->template get<T>() : otherwise;
}

/// Contents of a JSON file; null if the file cannot be read, is larger than kMaxTextBytes, or is not JSON.
nlohmann::ordered_json read_json_or_null(const std::filesystem::path& file);

enum class JsonLetters { all, ascii };

/// JSON as text, on one line if `indent` is negative. Bytes that are not UTF-8, such as in names of files, become
/// U+FFFD, because JSON cannot represent them. JsonLetters::ascii escapes all letters beyond ASCII.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1, JsonLetters letters = JsonLetters::all);

/// As json_text(), for JSON with sorted keys.
std::string sorted_json_text(const nlohmann::json& json, int indent = -1);

}  // namespace weft
