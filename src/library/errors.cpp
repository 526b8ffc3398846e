#include <regex>

#include "library/data.hpp"

namespace weft::library {

// "scenes/a.toml:12:8: cloth.band: expected ...": the place stands in the text, if the scene names one.
void throw_public(const Error& error) {
  const std::string text = error.what();
  static const std::regex kPlace(R"(([^\n]+?):(?:(\d+):(\d+):)? (?:([a-z_]+\.[^\s:]+): )?([^]*))");
  Mistake mistake;
  mistake.text = text;
  if (std::smatch match; std::regex_match(text, match, kPlace)) {
    const auto number = [&](std::size_t k) { return match[k].matched ? std::stoi(match[k]) : 0; };
    mistake = {match[1], number(2), number(3), "", match[4], match[5]};
  }
  switch (error.code()) {
    case ExitCode::scene_invalid:
      throw SceneError(text, {mistake});
    case ExitCode::asset_unreadable:
      throw FileError(text, {mistake});
    case ExitCode::simulation_failed:
      throw SimulationError(text);
    default:
      throw std::runtime_error(text);
  }
}

}  // namespace weft::library
