// The one way to JSON from text, and back. json.cpp alone instantiates the parser and the writer of nlohmann::json.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace weft {

/// Throws std::exception for what is no JSON, nests too deep (nlohmann::json copies, compares and writes by recursion),
/// or has too many keys in one object (nlohmann::ordered_json compares each key with all those before it).
template <class Json = nlohmann::ordered_json>
Json parse_json(std::string_view text);

extern template nlohmann::ordered_json parse_json(std::string_view);
extern template nlohmann::json parse_json(std::string_view);

/// What a file holds; null for what cannot be read.
nlohmann::ordered_json read_json_or_null(const std::filesystem::path& file);

enum class JsonLetters { all, ascii };

/// Text from outside, such as names of files, may not be UTF-8, which JSON cannot hold: it is replaced. With an indent
/// below 0 it is one line.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1, JsonLetters letters = JsonLetters::all);

/// The same of JSON whose keys are sorted.
std::string sorted_json_text(const nlohmann::json& json, int indent = -1);

}  // namespace weft
