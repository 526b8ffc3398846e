// The one way to JSON from text, and back. json.cpp alone instantiates the parser and the writer of nlohmann::json.
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>

namespace weft {

/// Throws std::exception for what is no JSON, nests too deep (nlohmann::json copies, compares and writes by recursion),
/// or has too many keys in one object (nlohmann::ordered_json compares each key with all those before it).
template <class Json = nlohmann::ordered_json>
Json parse_json(std::string_view text);

extern template nlohmann::ordered_json parse_json(std::string_view);
extern template nlohmann::json parse_json(std::string_view);

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
nlohmann::ordered_json read_json_or_null(const std::filesystem::path& file);

enum class JsonLetters { all, ascii };

/// Text from outside, such as names of files, may not be UTF-8, which JSON cannot hold: it is replaced. With an indent
/// below 0 it is one line.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1, JsonLetters letters = JsonLetters::all);

/// The same of JSON whose keys are sorted.
std::string sorted_json_text(const nlohmann::json& json, int indent = -1);

}  // namespace weft
