#include "tools/cli/diff_limits.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <optional>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/toml.hpp"
#include "film/scene/document.hpp"
#include "tools/cli/option_values.hpp"

namespace weft::cli {
namespace {

std::string place_of(const std::filesystem::path& file, const toml::source_region& where) {
  return fmt::format("{}:{}:{}", file.string(), where.begin.line, where.begin.column);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const toml::source_region& where, const std::string& text) {
  throw Error(ExitCode::asset_unreadable, "{}: {}", place_of(file, where), text);
}

toml::table parse(const std::filesystem::path& file) {
  try {
    return parse_toml(read_file(file, scene::kMaxFileSize), file.string());
  } catch (const toml::parse_error& error) {
    refuse(file, error.source(), std::string(error.description()));
  }
}

using Rules = DiffLimits::Rules;

std::function<void(Rules&)> change(const std::filesystem::path& file, const std::string& key, const toml::node& node) {
  if (key == "pixel_tolerance") {
    const auto levels = node.value<std::int64_t>();
    if (!node.is_integer() || *levels < 0 || *levels > 255)
      refuse(file, node.source(), "pixel_tolerance: expected a whole number from 0 to 255");
    return [levels](Rules& rules) { rules.limits.pixel_tolerance = static_cast<int>(*levels); };
  }
  if (key == "mask") {
    const auto name = node.value<std::string>();
    if (!name || name->empty()) refuse(file, node.source(), "mask: expected a picture, such as \"masks/front.png\"");
    const std::filesystem::path mask = file.parent_path() / *name;
    if (!std::filesystem::is_regular_file(mask))
      refuse(file, node.source(), "mask: " + mask.string() + " does not exist");
    return [mask](Rules& rules) { rules.mask = mask; };
  }
  const std::vector<std::pair<std::string, std::optional<double> compare::Limits::*>> shares{
      {"pixel_budget", &compare::Limits::pixel_budget},
      {"max_flip", &compare::Limits::flip},
      {"max_spot", &compare::Limits::spot}};
  for (const auto& [name, member] : shares) {
    if (key != name) continue;
    const auto share = node.value<double>();
    if (!share || !(*share >= 0 && *share <= 1)) refuse(file, node.source(), key + ": expected a number from 0 to 1");
    return [member = member, share](Rules& rules) { rules.limits.*member = *share; };
  }
  const std::vector<std::string> known{"name", "pixel_tolerance", "pixel_budget", "max_flip", "max_spot", "mask"};
  refuse(file, node.source(), fmt::format("unknown key {}{}", key, did_you_mean(key, known)));
}

}  // namespace

DiffLimits::DiffLimits(const compare::Limits& all, const std::filesystem::path& file) : all_{all, {}} {
  if (file.empty()) return;
  const toml::table table = parse(file);
  for (const auto& [key, node] : table) {
    const toml::array* pictures = node.as_array();
    if (key.str() != "picture" || pictures == nullptr || !pictures->is_array_of_tables())
      refuse(file, node.source(), fmt::format("expected tables [[picture]], got {}", key.str()));
    for (const toml::node& picture : *pictures) {
      const toml::table& values = *picture.as_table();
      const auto name = values["name"].value<std::string>();
      if (!name) refuse(file, picture.source(), "expected a name, such as \"front/*.png\"");
      Entry& entry = entries_.emplace_back(Entry{*name, place_of(file, picture.source()), {}});
      for (const auto& [k, value] : values)
        if (k.str() != "name") entry.changes.push_back(change(file, std::string(k.str()), value));
    }
  }
}

bool DiffLimits::Entry::fits(const std::string& name) const {
  return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

void DiffLimits::check_used(const std::vector<std::string>& names) const {
  for (const Entry& entry : entries_)
    if (std::ranges::none_of(names, [&](const std::string& name) { return entry.fits(name); }))
      throw Error(ExitCode::asset_unreadable,
                  "{}: name: expected a name or pattern of a picture that is compared, got \"{}\", which fits none of "
                  "{}{}",
                  entry.place, entry.pattern, names.size(), did_you_mean(entry.pattern, names));
}

Rules DiffLimits::of(const std::string& name) const {
  Rules rules = all_;
  for (const Entry& entry : entries_)
    if (entry.fits(name))
      for (const auto& apply : entry.changes) apply(rules);
  return rules;
}

}  // namespace weft::cli
