#include "tools/cli/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/json.hpp"
#include "core/log.hpp"
#include "film/image/contact_sheet.hpp"
#include "film/image/png.hpp"
#include "film/image/shrink.hpp"
#include "film/video/decoder.hpp"

namespace weft::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPictureWidth = 400;  // [pixels]
constexpr int kMaxSheetColumns = 8;
constexpr std::uint8_t kGrey = 200;

std::string text_of(const Json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "";
}

// The value at this path of the statistics; null if there is none.
Json at(const Json& json, std::initializer_list<const char*> path) {
  const Json* here = &json;
  for (const char* key : path) {
    if (!here->is_object() || !here->contains(key)) return nullptr;
    here = &(*here)[key];
  }
  return *here;
}

const Json& frames_of(const Json& stats) {
  static const Json kNone = Json::array();
  return stats.is_object() && stats.contains("frames") && stats["frames"].is_array() ? stats["frames"] : kNone;
}

std::string largest(const Json& stats, const char* key) {
  std::optional<double> most;
  for (const Json& frame : frames_of(stats))
    if (const Json value = at(frame, {key}); value.is_number())
      most = std::max(value.get<double>(), most.value_or(value.get<double>()));
  return most ? fmt::format("{:.4g}", *most) : "";
}

/// Whether the estimated error can be compared with that of other runs: "yes" or "no"; empty without --error.
std::string comparable_of(const Json& stats) {
  const Json comparable = at(stats, {"error", "comparable"});
  if (!comparable.is_boolean()) return "";
  return comparable.get<bool>() ? "yes" : "no";
}

/// Newton iterations, rejected steps, largest strain, kinetic energy at the end, error, and whether the error is
/// comparable. If there is no frame, all texts are empty.
std::vector<std::string> figures_of(const Json& stats) {
  const Json& frames = frames_of(stats);
  if (frames.empty()) return std::vector<std::string>(6);
  double iterations = 0;
  for (const Json& frame : frames) iterations += value_or(frame, "newton_iterations", 0.0);
  return {fmt::format("{}", iterations),
          text_of(at(stats, {"totals", "rejected_steps"})),
          largest(stats, "max_strain"),
          text_of(at(frames.back(), {"kinetic_energy_j"})),
          text_of(at(stats, {"error", "all", "position_m"})),
          comparable_of(stats)};
}

/// CPU times: "simulation 1.2 s, drawing 0.8 s".
std::string costs_of(const Json& stats) {
  return fmt::format("simulation {} s, drawing {} s", text_of(at(stats, {"totals", "simulate_cpu"})),
                     text_of(at(stats, {"totals", "render_cpu"})));
}

std::optional<image::Image> picture_of(const std::filesystem::path& file, std::optional<int> frame) {
  try {
    video::Decoder decoder(file);
    std::optional<image::Image> picture;
    for (int k = 0; !frame || k <= *frame; ++k) {
      std::optional<image::Image> next = decoder.next();
      if (!next) break;
      picture = std::move(next);
    }
    if (picture) picture = image::shrink(*picture, kPictureWidth);
    return picture;
  } catch (const Error&) {
    return std::nullopt;  // the run failed before its first picture
  }
}

/// Number of columns of the sheet: the number n of leading runs that have the same values of the first k keys, with the
/// smallest k for which 2 <= n <= kMaxSheetColumns. Only the other keys vary along a row. If there is no such k, the
/// sheet is about square, with at most kMaxSheetColumns columns.
int columns_of(const std::vector<SweepResult>& results) {
  const Changes& first = results.front().run.difference;
  for (std::size_t keys = 1; keys < first.size(); ++keys) {
    const auto same = [&](const SweepResult& result) {
      const Changes& other = result.run.difference;
      return other.size() == first.size() && std::equal(first.begin(), first.begin() + keys, other.begin());
    };
    const auto row = std::ranges::find_if_not(results, same) - results.begin();
    if (row > 1 && row <= kMaxSheetColumns) return static_cast<int>(row);
  }
  return std::min(kMaxSheetColumns, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(results.size())))));
}

}  // namespace

std::string label_of(const SweepRun& run) {
  std::string label;
  for (const auto& [key, value] : run.difference)
    label += fmt::format("{}{}={}", label.empty() ? "" : "  ", key, value);
  return label.empty() ? "as it is" : log::without_controls(label, "");
}

bench::Table sweep_table(const std::vector<SweepResult>& results) {
  std::vector<std::string> keys;
  for (const SweepResult& result : results)
    for (const auto& [key, value] : result.run.difference)
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  bench::Table table{keys};
  for (const char* column :
       {"exit code", "CPU s", "simulation CPU s", "drawing CPU s", "frames", "Newton iterations", "rejected steps",
        "largest strain", "kinetic energy at the end J", "error m", "comparable", "run"})
    table.front().emplace_back(column);
  for (const SweepResult& result : results) {
    std::vector<std::string>& row = table.emplace_back();
    for (const std::string& key : keys) {
      const auto& changes = result.run.difference;
      const auto found = std::ranges::find(changes, key, [](const auto& change) { return change.first; });
      row.push_back(found == changes.end() ? "" : found->second);
    }
    const Json& frames = frames_of(result.stats);
    row.push_back(fmt::format("{}", static_cast<int>(result.code)));
    for (const char* key : {"cpu", "simulate_cpu", "render_cpu"})
      row.push_back(text_of(at(result.stats, {"totals", key})));
    row.push_back(fmt::format("{}", frames.size()));
    for (std::string& figure : figures_of(result.stats)) row.push_back(std::move(figure));
    row.push_back(result.run.name);
  }
  return table;
}

void write_sweep_sheet(const std::filesystem::path& file, const std::vector<SweepResult>& results,
                       const std::string& heading, std::optional<int> frame) {
  std::vector<std::optional<image::Image>> found;
  for (const SweepResult& result : results) found.push_back(picture_of(result.video, frame));
  const auto some = std::ranges::find_if(found, [](const auto& picture) { return picture.has_value(); });
  if (some == found.end()) {
    std::error_code ignored;  // a sheet of an earlier sweep could be mistaken for that of these runs
    std::filesystem::remove(file, ignored);
    return;
  }
  image::Image none((*some)->width, (*some)->height);
  std::ranges::fill(none.rgb, kGrey);
  std::vector<image::SheetPicture> pictures;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const bool fits = found[i] && found[i]->width == none.width && found[i]->height == none.height;
    const bool good = results[i].code == ExitCode::ok;
    pictures.push_back({fits ? *found[i] : none, label_of(results[i].run),
                        good ? costs_of(results[i].stats) : fmt::format("exit {}", static_cast<int>(results[i].code))});
  }
  const int columns = columns_of(results);
  const image::SheetSize size = image::contact_sheet_size(pictures, columns);
  if (!size.is_writable()) {
    // Keeps as many whole rows as a PNG can hold.
    const int too_many = (size.height - image::kMaxPngSide + size.row - 1) / size.row;
    const std::size_t rows = (pictures.size() + columns - 1) / columns;
    pictures.resize((rows - too_many) * columns);
    log::info(fmt::format("note: {}: shows the first {} of {} runs, as many as a picture can hold", file.string(),
                          pictures.size(), results.size()));
  }
  image::write_png(file, image::contact_sheet(pictures, columns, heading));
}

}  // namespace weft::cli
