#include "film/scene/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace weft::scene {

Place place_of(const toml::source_region& source) {
  if (source.path && !source.path->empty()) {
    const std::size_t space = source.path->find(' ');
    return {0, 0, std::stoi(source.path->substr(space + 1)), std::stoi(source.path->substr(0, space))};
  }
  return {static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

int Findings::add_override(const std::string& text) {
  overrides_.push_back(text);
  return static_cast<int>(overrides_.size());
}

Place Findings::place(std::string key) const {
  for (;;) {
    if (const auto found = places_.find(key); found != places_.end()) return found->second;
    const auto dot = key.rfind('.');
    if (dot == std::string::npos) return {1, 1};
    key.resize(dot);
  }
}

Place Findings::place_in_file(std::string key) const {
  for (;;) {
    const Place nearest = place(key);
    const auto dot = key.rfind('.');
    if (nearest.override_number == 0) return nearest;
    if (dot == std::string::npos) return {1, 1};
    key.resize(dot);
  }
}

void Findings::report(const std::string& key, Place place, std::string text) {
  has_mistake_.insert(key);
  std::string override_text = place.override_number > 0 ? "--set " + overrides_[place.override_number - 1] : "";
  mistakes_.push_back({place.line, place.column, key, std::move(text), std::move(override_text)});
  if (mistakes_.size() >= 2 * kMaxMistakes) keep_first();
}

void Findings::report(const std::string& key, std::string text) {
  if (!has_mistake(key)) report(key, place(key), std::move(text));
}

void Findings::keep_first() {
  const auto order = [](const Mistake& m) { return std::tuple(!m.override_text.empty(), m.line, m.column); };
  std::stable_sort(mistakes_.begin(), mistakes_.end(),
                   [&](const Mistake& a, const Mistake& b) { return order(a) < order(b); });
  if (mistakes_.size() <= kMaxMistakes) return;
  dropped_ += mistakes_.size() - kMaxMistakes;
  mistakes_.resize(kMaxMistakes);
}

std::vector<Mistake> Findings::take_mistakes() {
  keep_first();
  if (dropped_ > 0) mistakes_.push_back({0, 0, {}, fmt::format("{} further mistakes are not listed", dropped_), {}});
  dropped_ = 0;
  return std::exchange(mistakes_, {});
}

}  // namespace weft::scene
