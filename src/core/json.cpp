#include "core/json.hpp"

#include <array>
#include <cstddef>
#include <exception>
#include <stdexcept>

#include "core/input_file.hpp"
#include "core/nesting.hpp"

namespace weft {

template <class Json>
Json parse_json(std::string_view text) {
  if (nests_too_deep(text)) throw std::runtime_error("expected at most 128 levels of lists and objects, got more");
  constexpr std::size_t kMaxKeyComparisons = 200'000'000;  // the statistics of 100,000 frames need 40 million
  std::size_t comparisons = 0;
  std::array<std::size_t, kMaxDepth + 2> key_counts{};  // number of keys so far in the current object of each depth
  return Json::parse(text, [&](int depth, nlohmann::json::parse_event_t event, Json&) {
    using Event = nlohmann::json::parse_event_t;
    const auto level = static_cast<std::size_t>(depth);
    if (event == Event::object_start) key_counts.at(level + 1) = 0;
    if (event == Event::key && (comparisons += key_counts.at(level)++) > kMaxKeyComparisons)
      throw std::runtime_error("expected fewer keys in its objects");
    return true;
  });
}

template nlohmann::ordered_json parse_json(std::string_view);
template nlohmann::json parse_json(std::string_view);

nlohmann::ordered_json read_json_or_null(const std::filesystem::path& file) {
  try {
    return parse_json(read_bytes(file, kMaxTextBytes));
  } catch (const std::exception&) {
    return nullptr;
  }
}

std::string json_text(const nlohmann::ordered_json& json, int indent, JsonLetters letters) {
  return json.dump(indent, ' ', letters == JsonLetters::ascii, nlohmann::ordered_json::error_handler_t::replace);
}

std::string sorted_json_text(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace weft
