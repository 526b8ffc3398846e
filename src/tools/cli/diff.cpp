#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <system_error>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/log.hpp"
#include "core/temporary_file.hpp"
#include "film/image/png.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/diff_limits.hpp"
#include "tools/cli/diff_origin.hpp"
#include "tools/cli/diff_page.hpp"
#include "tools/cli/diff_report.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/standard_output.hpp"
#include "tools/compare/files.hpp"
#include "tools/compare/references.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using compare::FileComparison;
using Outcome = FileComparison::Outcome;

FileComparison missing_file_result(const std::string& name, const fs::path& reference, const fs::path& test,
                                   Outcome outcome) {
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

/// A pair to compare; its files are not read yet.
struct Pair {
  std::string name;
  std::optional<fs::path> reference;
  fs::path test;
  bool has_test = true;  ///< whether `test` is a picture or video; false if it is missing or a heat map
  DiffLimits::Rules rules = {};

  FileComparison compare(const DiffOptions& options) const {
    if (!reference) return missing_file_result(name, options.reference, test, Outcome::no_reference);
    if (!has_test) return missing_file_result(name, *reference, test, Outcome::no_test);
    FileComparison result = compare::compare_files(*reference, test, rules.limits, rules.mask);
    result.name = name;
    return result;
  }
};

std::vector<Pair> pairs_of_folders(const DiffOptions& options) {
  std::vector<std::string> names = compare::comparable_names(options.test);
  // Assumes that one machine drew all pictures of the folder.
  const std::string machine = compare::machine_class_of(options.test, names);
  const std::vector<std::string> references = compare::reference_names(options.reference, machine);
  names.insert(names.end(), references.begin(), references.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::vector<Pair> pairs;
  for (const std::string& name : names) {
    const fs::path test = options.test / name;
    pairs.push_back({name, compare::find_reference(options.reference, name, machine), test,
                     fs::exists(test) && !compare::is_heat_map(test)});
  }
  if (pairs.empty()) {
    throw Error(ExitCode::reference_missing, "{}: expected pictures or videos, there are none",
                options.reference.string());
  }
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

// Like all_pairs(), but checks --heatmap first, and throws Error(asset_unreadable) if a folder cannot be read.
std::vector<Pair> read_pairs(const DiffOptions& options) {
  try {
    const bool folders = fs::is_directory(options.reference) && fs::is_directory(options.test);
    if (folders && options.heatmap.extension() == ".png")
      throw Error(ExitCode::usage, "--heatmap: expected a folder for the pictures of folders, got {}",
                  options.heatmap.string());
    return all_pairs(options);
  } catch (const fs::filesystem_error& error) {
    if (error.code() == std::errc::filename_too_long) throw;
    throw Error(ExitCode::asset_unreadable, "{}: cannot be read: {}", error.path1().string(), error.code().message());
  }
}

// Exit code of the whole comparison. Unreadable files take precedence over differences; differences take precedence
// over missing references.
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

std::string summary(const std::vector<FileComparison>& results) {
  const auto good = std::count_if(results.begin(), results.end(), [](const auto& result) { return result.good(); });
  return fmt::format("{} of {} match their references", good, results.size());
}

// Whether annotations are printed. GitHub Actions reads them from standard output, and sets GITHUB_ACTIONS for every
// step.
bool is_annotated(const DiffOptions& options) {
  const char* actions = std::getenv("GITHUB_ACTIONS");
  return options.annotations || (actions != nullptr && std::string_view(actions) == "true");
}

// File for the heat map of a pair; empty if none is requested. The map of a.mp4 is a.png or, if another pair has the
// name a.png or a.mov, a.mp4.png.
fs::path heatmap_file(const DiffOptions& options, const std::vector<Pair>& pairs, const std::string& name) {
  if (options.heatmap.empty() || options.heatmap.extension() == ".png") return options.heatmap;
  const std::string picture = fs::path(name).replace_extension(".png").string();
  const bool taken = picture != name && std::ranges::any_of(pairs, [&](const Pair& pair) {
                       return pair.name != name && fs::path(pair.name).replace_extension(".png") == picture;
                     });
  return options.heatmap / (taken ? name + ".png" : picture);
}

void check_outputs(const DiffOptions& options, const std::vector<Pair>& pairs) {
  if (options.heatmap.empty() && options.junit.empty() && options.html.empty()) return;
  PathLedger paths;
  for (const fs::path& folder : {options.reference, options.test})
    if (fs::is_directory(folder)) paths.searches(folder, "a folder to compare");
  for (const Pair& pair : pairs) {
    if (pair.reference) paths.reads(*pair.reference, "a reference");
    paths.reads(pair.test, "a picture to test");
    if (!pair.rules.mask.empty()) paths.reads(pair.rules.mask, "a mask");
  }
  if (!options.limits_file.empty()) paths.reads(options.limits_file, "the limits");
  if (!options.heatmap.empty())
    for (const Pair& pair : pairs) paths.writes("--heatmap", heatmap_file(options, pairs, pair.name));
  if (!options.junit.empty()) paths.writes("--junit", options.junit);
  if (!options.html.empty()) paths.writes("--html", options.html);
  paths.check_absent(options.overwrite);
  paths.check_writable();
}

}  // namespace

ExitCode diff(const DiffOptions& options) {
  std::vector<Pair> pairs = read_pairs(options);
  const DiffLimits rules(options.limits, options.limits_file);
  std::vector<std::string> names;
  for (const Pair& pair : pairs) names.push_back(pair.name);
  rules.check_used(names);
  for (Pair& pair : pairs) {
    pair.rules = rules.of(pair.name);
    pair.rules.limits = compare::limits_for(pair.rules.limits, pair.reference.value_or(fs::path()), pair.test);
  }
  check_outputs(options, pairs);
  Json json{{"exit_code", 0}, {"limits", describe_json(options.limits)}, {"results", Json::array()}};
  std::vector<FileComparison> results;
  std::vector<std::string> lines;
  DiffPage page;
  for (const Pair& pair : pairs) {
    FileComparison result = pair.compare(options);
    const fs::path heatmap = result.frames > 0 ? heatmap_file(options, pairs, pair.name) : fs::path();
    if (!heatmap.empty()) image::write_png(heatmap, compare::heat_map(result.worst.flip), compare::heat_map_metadata());
    json["results"].push_back(describe_json(result, pair.rules.limits, heatmap));
    lines.push_back(describe(result, pair.rules.limits));
    if (result.outcome == Outcome::differs || result.outcome == Outcome::size || result.outcome == Outcome::frame_count)
      if (const std::string origin = describe_origin_changes(*pair.reference, pair.test); !origin.empty()) {
        json["results"].back()["origin"] = origin;
        lines.back() += "; " + origin;
      }
    if (!options.html.empty()) page.add(result, lines.back());
    // Frees the pictures, so that the results of thousands of pairs fit into memory.
    result.worst.flip = {};
    result.reference_picture = result.test_picture = {};
    results.push_back(std::move(result));
  }
  const ExitCode code = exit_code(results);
  json["exit_code"] = static_cast<int>(code);
  if (!options.junit.empty()) write_file(options.junit, junit_xml(results, lines));
  if (!options.html.empty()) write_file(options.html, page.html(summary(results)));
  std::string text;  // one line per pair, even if a name contains a line feed
  for (const std::string& line : lines) text += log::without_controls(line, "") + "\n";
  if (results.size() > 1) text += summary(results) + "\n";
  std::string annotations;
  for (std::size_t i = 0; is_annotated(options) && i < results.size(); ++i)
    if (!results[i].good()) annotations += annotation(results[i], lines[i]) + "\n";
  if (options.json) {
    if (!annotations.empty()) log::info(annotations.substr(0, annotations.size() - 1));
    write_standard_output(json_text(json, 2) + "\n");
  } else {
    print("{}{}", text, annotations);
  }
  return code;
}

}  // namespace weft::cli
