#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "cli/path_ledger.hpp"
#include "compare/files.hpp"
#include "compare/references.hpp"
#include "image/png.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using compare::FileComparison;
using Outcome = FileComparison::Outcome;

FileComparison only_one(const std::string& name, const fs::path& reference, const fs::path& test, Outcome outcome) {
  FileComparison result;
  result.name = name;
  result.reference = reference;
  result.test = test;
  result.outcome = outcome;
  result.problem = outcome == Outcome::no_test
                       ? fmt::format("missing: the reference {} has no counterpart", reference.string())
                       : fmt::format("no reference: there is none for {}", test.string());
  return result;
}

void check_exists(const fs::path& path, ExitCode code, const char* what) {
  if (!fs::exists(path)) throw Error(code, "{}: the {} does not exist", path.string(), what);
}

/// What is to be compared. Nothing is read yet.
struct Pair {
  std::string name;
  std::optional<fs::path> reference;
  fs::path test;

  FileComparison compare(const DiffOptions& options) const {
    if (!reference) return only_one(name, options.reference, test, Outcome::no_reference);
    if (!fs::exists(test)) return only_one(name, *reference, test, Outcome::no_test);
    return compare::compare_files(*reference, test, options.limits);
  }
};

std::vector<Pair> pairs_of_folders(const DiffOptions& options) {
  std::vector<std::string> names = compare::comparable_names(options.test);
  // The pictures of one folder come from one machine.
  const std::string machine = names.empty() ? "" : compare::machine_class_of(options.test / names.front());
  const std::vector<std::string> references = compare::reference_names(options.reference, machine);
  if (names.empty() && references.empty()) {
    throw Error(ExitCode::reference_missing, "{}: expected pictures or videos, there are none",
                options.reference.string());
  }
  names.insert(names.end(), references.begin(), references.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::vector<Pair> pairs;
  for (const std::string& name : names)
    pairs.push_back({name, compare::find_reference(options.reference, name, machine), options.test / name});
  return pairs;
}

std::vector<Pair> all_pairs(const DiffOptions& options) {
  check_exists(options.reference, ExitCode::reference_missing, "reference");
  check_exists(options.test, ExitCode::asset_unreadable, "picture to test");
  if (fs::is_directory(options.reference)) {
    if (fs::is_directory(options.test)) return pairs_of_folders(options);
    const std::string name = options.test.filename();
    return {{name, compare::find_reference(options.reference, name, compare::machine_class_of(options.test)),
             options.test}};
  }
  const fs::path test = fs::is_directory(options.test) ? options.test / options.reference.filename() : options.test;
  check_exists(test, ExitCode::asset_unreadable, "picture to test");
  return {{test.filename(), options.reference, test}};
}

// Of the whole comparison: what hides most comes first.
ExitCode exit_code(const std::vector<FileComparison>& results) {
  ExitCode code = ExitCode::ok;
  for (const FileComparison& result : results) {
    if (result.outcome == Outcome::unreadable) return ExitCode::asset_unreadable;
    if (result.outcome == Outcome::no_reference) {
      if (code == ExitCode::ok) code = ExitCode::reference_missing;
    } else if (!result.good()) {
      code = ExitCode::images_differ;
    }
  }
  return code;
}

// Each figure that is past its limit says so.
std::string describe_figures(const FileComparison& result, const compare::Limits& limits) {
  const compare::Figures& f = result.worst.figures;
  const auto limit = [](double figure, double most) { return figure > most ? fmt::format(" (limit {:g})", most) : ""; };
  const double pixels = static_cast<double>(f.width) * f.height;
  return fmt::format(
      "{} of {} pixels differ, {} by more than {} levels{}; at most {} at ({}, {}); FLIP {:.2g}{}, at most {:.2g}{}; "
      "SSIM {:.5f}",
      f.pixels_changed, pixels, f.pixels_over, limits.pixel_tolerance,
      limit(static_cast<double>(f.pixels_over), std::floor(limits.pixel_budget * pixels)), f.largest, f.largest_x,
      f.largest_y, f.flip, limit(f.flip, limits.flip), f.spot, limit(f.spot, limits.spot), f.ssim);
}

std::string describe(const FileComparison& result, const compare::Limits& limits) {
  std::string line = result.name + ": ";
  if (!result.problem.empty()) line += result.problem;
  if (result.frames == 0) return line;
  if (!result.problem.empty()) line += "; ";
  const bool same = result.worst.figures.pixels_changed == 0;
  if (result.video) line += fmt::format("{} of {} frames differ", result.frames_differing, result.frames);
  if (result.video && !same) line += fmt::format("; worst is frame {}: ", result.worst_frame);
  if (same) return line + (result.video ? ", all are the same" : "same");
  if (!result.video) line += result.frames_differing > 0 ? "DIFFERS: " : "within the limits: ";
  return line + describe_figures(result, limits);
}

const char* name_of(Outcome outcome) {
  constexpr const char* kNames[] = {"same",        "within",  "differs",      "size",
                                    "frame_count", "no_test", "no_reference", "unreadable"};
  return kNames[static_cast<int>(outcome)];
}

using Json = nlohmann::ordered_json;

Json describe_json(const FileComparison& result, const fs::path& heatmap) {
  Json json{{"name", result.name},
            {"reference", result.reference.string()},
            {"test", result.test.string()},
            {"outcome", name_of(result.outcome)}};
  if (!result.problem.empty()) json["problem"] = result.problem;
  if (result.frames == 0) return json;
  const compare::Figures& f = result.worst.figures;
  if (result.video) {
    json["frames"] = result.frames;
    json["frames_differing"] = result.frames_differing;
    json["worst_frame"] = result.worst_frame;
  }
  json["width"] = f.width;
  json["height"] = f.height;
  json["pixels_changed"] = f.pixels_changed;
  json["pixels_over"] = f.pixels_over;
  json["share_over"] = f.share_over();
  json["largest"] = f.largest;
  json["largest_at"] = {f.largest_x, f.largest_y};
  json["ssim"] = f.ssim;
  json["flip"] = f.flip;
  json["spot"] = f.spot;
  if (!heatmap.empty()) json["heatmap"] = heatmap.string();
  return json;
}

// Where the heat map of a pair goes; empty where none is asked for. A video that has the name of a picture keeps its
// ending.
fs::path heatmap_file(const DiffOptions& options, const std::vector<Pair>& pairs, const std::string& name) {
  if (options.heatmap.empty() || options.heatmap.extension() == ".png") return options.heatmap;
  const std::string picture = fs::path(name).replace_extension(".png").string();
  const bool taken =
      picture != name && std::ranges::any_of(pairs, [&](const Pair& pair) { return pair.name == picture; });
  return options.heatmap / (taken ? name + ".png" : picture);
}

void check_heatmaps(const DiffOptions& options, const std::vector<Pair>& pairs) {
  if (options.heatmap.empty()) return;
  PathLedger paths;
  for (const fs::path& folder : {options.reference, options.test})
    if (fs::is_directory(folder)) paths.searches(folder, "a folder to compare");
  for (const Pair& pair : pairs) {
    if (pair.reference) paths.reads(*pair.reference, "a reference");
    paths.reads(pair.test, "a picture to test");
  }
  for (const Pair& pair : pairs) paths.writes("--heatmap", heatmap_file(options, pairs, pair.name));
  paths.check_absent(options.overwrite);
  paths.check_writable();
}

}  // namespace

ExitCode diff(const DiffOptions& options) {
  const bool folders = fs::is_directory(options.reference) && fs::is_directory(options.test);
  if (folders && options.heatmap.extension() == ".png") {
    throw Error(ExitCode::usage, "--heatmap: expected a folder for the pictures of folders, got {}",
                options.heatmap.string());
  }
  const std::vector<Pair> pairs = all_pairs(options);
  check_heatmaps(options, pairs);
  std::vector<FileComparison> results;
  for (const Pair& pair : pairs) results.push_back(pair.compare(options));
  const ExitCode code = exit_code(results);
  Json json{{"exit_code", static_cast<int>(code)},
            {"limits",
             {{"pixel_tolerance", options.limits.pixel_tolerance},
              {"pixel_budget", options.limits.pixel_budget},
              {"flip", options.limits.flip},
              {"spot", options.limits.spot}}},
            {"results", Json::array()}};
  std::string text;
  for (const FileComparison& result : results) {
    const fs::path heatmap = result.frames > 0 ? heatmap_file(options, pairs, result.name) : fs::path();
    if (!heatmap.empty()) image::write_png(heatmap, compare::heat_map(result.worst.flip));
    json["results"].push_back(describe_json(result, heatmap));
    text += describe(result, options.limits) + "\n";
  }
  if (results.size() > 1) {
    const auto good = std::count_if(results.begin(), results.end(), [](const auto& result) { return result.good(); });
    text += fmt::format("{} of {} are as their references\n", good, results.size());
  }
  fmt::print("{}", options.json ? json.dump(2) + "\n" : text);
  if (std::fflush(stdout) != 0) throw Error(ExitCode::output_failed, "standard output cannot be written");
  return code;
}

}  // namespace weft::cli
