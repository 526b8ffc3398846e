#include "tools/cli/diff_report.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "core/json.hpp"
#include "core/markup.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;
using compare::FileComparison;
using Outcome = FileComparison::Outcome;

// The figures of the comparison as text; each figure that exceeds its limit is marked.
std::string describe_figures(const FileComparison& result, const compare::Limits& limits) {
  const compare::Figures& f = result.worst.figures;
  const auto limit = [](double figure, double most) {
    return figure > most ? fmt::format(" (limit {:.3g})", most) : "";
  };
  const double counted = compare::counted_pixels(f, limits), allowed = compare::allowed_pixels(f, limits);
  std::string of_pixels;
  if (counted < static_cast<double>(f.pixels_over))
    of_pixels = fmt::format(", {} of them at edges, counted as {:.3g}", f.pixels_at_edges, counted);
  if (counted > allowed)
    of_pixels += fmt::format(" (limit {:.3g}: {:g} of all pixels)", allowed,
                             limits.pixel_budget.value_or(compare::Limits::kPixelBudget));
  return fmt::format(
      "{} of {} pixels differ, {} by more than {} levels{}; at most {} at ({}, {}); FLIP {:.2g}{}, at most {:.2g}{}; "
      "SSIM {:.5f}",
      f.pixels_changed, f.pixels, f.pixels_over, limits.pixel_tolerance, of_pixels, f.largest, f.largest_x, f.largest_y,
      f.flip, limit(f.flip, *compare::for_size(limits, f).flip), f.spot,
      limit(f.spot, limits.spot.value_or(compare::Limits::kSpot)), f.ssim);
}

}  // namespace

std::string describe(const FileComparison& result, const compare::Limits& limits) {
  std::string line = result.name + ": ";
  if (!result.problem.empty()) line += result.problem;
  if (result.frames == 0) return line;
  if (!result.problem.empty()) line += "; ";
  const bool same = result.worst.figures.pixels_changed == 0;
  if (result.video) line += fmt::format("{} of {} frames differ", result.frames_differing, result.frames);
  if (result.video && result.frames_differing > 0)
    line += fmt::format(", the first is frame {}", result.first_differing);
  if (result.frames_of_spill > 0) line += fmt::format(", and the encoder changed {} near them", result.frames_of_spill);
  if (result.video && !same) line += fmt::format("; worst is frame {}: ", result.worst_frame);
  if (same) return line + (result.video ? ", all are the same" : "same");
  if (!result.video) line += result.frames_differing > 0 ? "DIFFERS: " : "within the limits: ";
  return line + describe_figures(result, limits);
}

namespace {

const char* name_of(Outcome outcome) {
  constexpr const char* kNames[] = {"same",        "within",  "differs",      "size",
                                    "frame_count", "no_test", "no_reference", "unreadable"};
  return kNames[static_cast<int>(outcome)];
}

}  // namespace

std::string annotation(const FileComparison& result, const std::string& description) {
  const auto quoted = [](const std::string& text, std::string_view special) {
    std::string safe;
    for (const char c : text)
      safe += special.find(c) == std::string_view::npos ? std::string(1, c) : fmt::format("%{:02X}", c);
    return safe;
  };
  fs::path file = result.outcome == Outcome::no_reference ? result.test : result.reference;
  const char* workspace = std::getenv("GITHUB_WORKSPACE");
  if (workspace != nullptr) {
    const fs::path inside = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(workspace));
    if (!inside.empty() && *inside.begin() != "..") file = inside;
  }
  return fmt::format("::error file={},title=weft diff::{}", quoted(file.string(), "%\r\n:,"),
                     quoted(description, "%\r\n"));
}

Json describe_json(const FileComparison& result, const compare::Limits& limits, const fs::path& heatmap) {
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
    if (result.frames_differing > 0) json["first_frame_differing"] = result.first_differing;
    if (result.frames_of_spill > 0) json["frames_of_spill"] = result.frames_of_spill;
    json["worst_frame"] = result.worst_frame;
  }
  json["width"] = f.width;
  json["height"] = f.height;
  json["pixels"] = f.pixels;
  json["pixels_changed"] = f.pixels_changed;
  json["pixels_over"] = f.pixels_over;
  json["pixels_at_edges"] = f.pixels_at_edges;
  json["share_over"] = f.fraction_over();
  json["largest"] = f.largest;
  json["largest_at"] = {f.largest_x, f.largest_y};
  json["ssim"] = f.ssim;
  json["flip"] = f.flip;
  json["spot"] = f.spot;
  json["limits"] = describe_json(compare::for_size(limits, f));
  if (!heatmap.empty()) json["heatmap"] = heatmap.string();
  return json;
}

Json describe_json(const compare::Limits& limits) {
  return {{"pixel_tolerance", limits.pixel_tolerance},
          {"pixel_budget", limits.pixel_budget.value_or(compare::Limits::kPixelBudget)},
          {"flip", limits.flip.value_or(compare::Limits::kFlip)},
          {"spot", limits.spot.value_or(compare::Limits::kSpot)}};
}

std::string junit_xml(const std::vector<FileComparison>& results, const std::vector<std::string>& descriptions) {
  std::string cases;
  int failures = 0, errors = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const fs::path name = results[i].name;
    const std::string folder = name.parent_path().string();
    cases += fmt::format("  <testcase classname=\"{}\" name=\"{}\"", markup_text(folder.empty() ? "." : folder),
                         markup_text(name.filename().string()));
    if (results[i].good()) {
      cases += "/>\n";
      continue;
    }
    const bool broken = results[i].outcome == Outcome::unreadable;
    ++(broken ? errors : failures);
    const char* kind = broken ? "error" : "failure";
    cases += fmt::format(">\n    <{} type=\"{}\" message=\"{}\"/>\n  </testcase>\n", kind, name_of(results[i].outcome),
                         markup_text(descriptions[i]));
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"weft diff\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" skipped=\"0\">\n{}</testsuite>\n",
      results.size(), failures, errors, cases);
}

}  // namespace weft::cli
