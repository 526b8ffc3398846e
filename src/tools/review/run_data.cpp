#include "tools/review/run_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/toml.hpp"
#include "film/scene/scene_values.hpp"
#include "film/video/decoder.hpp"

namespace weft::review {
namespace {

// Rounds floating-point numbers to six significant digits, which suffice for plots, to make the
// data file of the page smaller. Keeps integers and booleans. Other values become null.
Json rounded(const Json& value) {
  if (!value.is_number_float()) return value.is_number() || value.is_boolean() ? value : Json(nullptr);
  const auto number = value.get<double>();
  if (number == 0 || !std::isfinite(number)) return number == 0 ? Json(0) : Json(nullptr);
  // std::stod() would throw for numbers below 2.2e-308.
  return std::strtod(fmt::format("{:.6g}", number).c_str(), nullptr);
}

Json effective_json(const RunFiles& run, std::vector<std::string>& problems) {
  if (run.effective.empty()) {
    problems.push_back("no effective scene: expected an .effective.toml of this name beside the video");
    return nullptr;
  }
  Json effective{{"text", ""}, {"values", Json::object()}};
  try {
    effective["text"] = read_file(run.effective, kMaxTextBytes);
    effective["values"] =
        scene_values(effective["text"].get_ref<const std::string&>(), run.effective.filename().string());
  } catch (const Error& error) {
    problems.push_back(error.what());
  }
  return effective;
}

/// Frames of a scene: begin, begin + step, ... below `end`.
struct Frames {
  long long begin = 0, end = 0, step = 1;

  bool contains(long long frame) const { return frame >= begin && frame < end && (frame - begin) % step == 0; }
};

/// Reads from its metadata which frames a video shows, such as 0:19:2; nullopt if the metadata do not name them, or if
/// the file cannot be read.
std::optional<Frames> frames_of(const std::filesystem::path& file) {
  try {
    const video::Decoder decoder(file);
    const auto entry = decoder.metadata().find("frames");
    if (entry == decoder.metadata().end()) return std::nullopt;
    Frames frames;
    std::istringstream text(entry->second);
    char colon = 0;
    if (!(text >> frames.begin >> colon >> frames.end)) return std::nullopt;
    if (text >> colon && !(text >> frames.step)) return std::nullopt;
    return frames.begin >= 0 && frames.step > 0 ? std::optional(frames) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

double number_or_zero(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0;
}

}  // namespace

Json frame_columns(const Json& frames) {
  constexpr std::size_t kMaxFrameColumns = 200;  // limit for damaged files; Weft writes 33
  Json columns = Json::object();
  for (const Json& frame : frames) {
    for (const auto& [key, value] : frame.items())
      if (columns.size() < kMaxFrameColumns) columns.emplace(key, Json::array());
  }
  for (auto& [key, column] : columns.items()) {
    for (const Json& frame : frames) {
      const auto value = frame.find(key);
      column.push_back(value == frame.end() ? Json(nullptr) : rounded(*value));
    }
  }
  return columns;
}

Json column_digest(const Json& columns) {
  const auto frames = columns.find("frame");
  Json summary = Json::object();
  for (const auto& [name, column] : columns.items()) {
    Json entry;
    for (std::size_t row = 0; row < column.size(); ++row) {
      if (!column[row].is_number()) continue;
      const auto value = column[row].get<double>();
      const Json frame = frames == columns.end() ? Json(nullptr) : (*frames)[row];
      if (entry.is_null()) entry = {{"count", 0}, {"sum", 0.0}};
      if (!entry.contains("min") || value < entry["min"]) entry["min"] = column[row], entry["min_frame"] = frame;
      if (!entry.contains("max") || value > entry["max"]) entry["max"] = column[row], entry["max_frame"] = frame;
      entry["count"] = entry["count"].get<int>() + 1;
      entry["sum"] = entry["sum"].get<double>() + value;
      entry["last"] = column[row];
    }
    if (!entry.is_null()) summary[name] = std::move(entry);
  }
  return summary;
}

PictureTimes picture_times(const RunFiles& run) {
  std::vector<long long> shown;
  if (!run.pictures.empty()) {
    for (const auto& picture : run.pictures) shown.push_back(picture_number(picture));
  } else if (!run.stats.empty()) {
    // The statistics may be those of `weft simulate`, while the video shows only a part of these frames, as in a farm.
    const std::optional<Frames> drawn = run.video.empty() ? std::nullopt : frames_of(run.video);
    for (const Json& frame : run.stats_json["frames"]) {
      if (frame.value("written", Json(true)) == true) {
        constexpr double kMaxFrameNumber = 1e9;  // limit for damaged files
        const auto number = static_cast<long long>(std::clamp(number_or_zero(frame, "frame"), 0.0, kMaxFrameNumber));
        if (!drawn || drawn->contains(number)) shown.push_back(number);
      }
    }
  }
  PictureTimes times;
  times.count = static_cast<long long>(shown.size());
  if (times.count > 0) times.first = shown.front();
  for (std::size_t k = 1; k < shown.size(); ++k) {
    const long long distance = std::max(1ll, shown[k] - shown[k - 1]);
    times.step = k == 1 ? distance : std::min(times.step, distance);
  }
  if (!run.pictures.empty() && times.count > 0 && shown.back() != times.first + (times.count - 1) * times.step)
    times.frames = std::move(shown);
  if (!run.stats.empty()) times.fps = number_or_zero(run.stats_json, "fps") / static_cast<double>(times.step);
  return times;
}

Json scene_values(const std::string& toml, const std::string& file) {
  try {
    Json values = Json::object();
    scene::list_values(toml, [&](const std::string& key, const std::string& value) { values[key] = value; });
    return values;
  } catch (const toml::parse_error& error) {
    throw Error(ExitCode::asset_unreadable, "{}:{}: not readable as TOML: {}", file, error.source().begin.line,
                error.description());
  }
}

namespace {

/// Names the first picture whose number is not PictureTimes::step above that of the picture before it; empty if there
/// is none.
std::string gap_in_pictures(const RunFiles& run) {
  const long long step = picture_times(run).step;
  for (std::size_t k = 1; k < run.pictures.size(); ++k) {
    const long long distance = picture_number(run.pictures[k]) - picture_number(run.pictures[k - 1]);
    if (distance != step)
      return fmt::format(
          "{}: expected a number {} above that of the picture before it, got {} above: pictures between them are "
          "missing",
          run.pictures[k].filename().string(), step, distance);
  }
  return {};
}

}  // namespace

Json run_data(const RunFiles& run) {
  std::vector<std::string> problems = run.problems;
  if (run.video.empty() && run.pictures.empty()) problems.push_back("no video or pictures beside the statistics");
  if (run.stats.empty() && problems.empty())
    problems.push_back("no statistics: weft run --stats FILE.json writes them, for figures and plots");
  if (std::string gap = gap_in_pictures(run); !gap.empty()) problems.push_back(std::move(gap));
  Json stats = run.stats_json.is_object() ? run.stats_json : Json::object();
  Json columns = frame_columns(stats.value("frames", Json::array()));
  Json summary = column_digest(columns);
  stats.erase("frames");
  Json effective = effective_json(run, problems);
  return {{"name", run.name},
          {"problems", problems},
          {"stats", std::move(stats)},
          {"digest", std::move(summary)},
          {"columns", std::move(columns)},
          {"effective", std::move(effective)}};
}

}  // namespace weft::review
