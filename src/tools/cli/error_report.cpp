#include "tools/cli/error_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/table.hpp"

namespace weft::cli {
namespace {

using run_error::ErrorEstimate, run_error::ErrorPart, run_error::ErrorSource, run_error::Quantity;

// A reported quantity, with its column in the table and its key in JSON.
struct Figure {
  Quantity quantity;
  const char *column, *format, *key;
  double scale;
};
constexpr Figure kFigures[] = {
    {Quantity::position, "position", "{:.2g} mm", "position_m", 1e3},
    {Quantity::centre, "centre of mass", "{:.2g} mm", "centre_m", 1e3},
    {Quantity::top, "highest point", "{:.2g} mm", "top_m", 1e3},
    {Quantity::shadow, "shadow", "{:.2g} %", "shadow", 1e2},
    {Quantity::energy, "energy", "{:.2g} %", "energy", 1e2},
    {Quantity::rest_energy, "energy at rest", "{:.2g} %", "rest_energy", 1e2},
};

std::string remedy(ErrorSource source) {
  switch (source) {
    case ErrorSource::steps:
      return "a smaller time.step or time.tolerance";
    case ErrorSource::solver:
      return "a smaller solver.newton_tolerance";
    case ErrorSource::mesh:
      return "more particles";
    case ErrorSource::start:
      return "no setting";
  }
  return {};
}

// Error of positions due to the random offsets of the start [mm]; "?" if it is not known.
std::string start_text(const ErrorEstimate& estimate) {
  for (const ErrorPart& part : estimate.parts)
    if (part.source == ErrorSource::start && part.missing.empty())
      return fmt::format("{:.2g}", 1e3 * at(part.errors, Quantity::position));
  return "?";
}

std::vector<std::string> row(const std::string& name, const run_error::Errors& errors) {
  std::vector<std::string> row{name};
  for (const Figure& figure : kFigures)
    row.push_back(fmt::format(fmt::runtime(figure.format), figure.scale * at(errors, figure.quantity)));
  return row;
}

nlohmann::ordered_json errors_json(const run_error::Errors& errors) {
  nlohmann::ordered_json json;
  for (const Figure& figure : kFigures) json[figure.key] = at(errors, figure.quantity);
  return json;
}

}  // namespace

std::string error_summary(const ErrorEstimate& estimate) {
  std::vector<std::vector<std::string>> rows{{"error, by comparison runs"}};
  for (const Figure& figure : kFigures) rows[0].emplace_back(figure.column);
  for (const ErrorPart& part : estimate.parts) {
    rows.push_back(row(std::string(name_of(part.source)), part.errors));
    if (part.missing.empty()) continue;
    for (std::size_t i = 1; i < rows.back().size(); ++i) rows.back()[i] = "?";
  }
  rows.push_back(row("all", estimate.all));
  std::string text = format_table(rows, "l" + std::string(rows[0].size() - 1, 'r'), 2);
  for (const ErrorPart& part : estimate.parts)
    if (!part.missing.empty()) text += fmt::format("  {} not known: {}\n", name_of(part.source), part.missing);
  return text + fmt::format("  ({:.2g} CPU s for the comparison runs)", estimate.cpu_s);
}

std::string relative_length(double length, double cloth_size) {
  if (!(cloth_size > 0)) return fmt::format("{:.2g} mm", 1e3 * length);
  return fmt::format("{:.2g} mm ({:.2g} % of the cloth's size)", 1e3 * length, 100 * length / cloth_size);
}

std::string error_sentence(const ErrorEstimate& estimate, double cloth_size) {
  const ErrorPart& largest = estimate.largest();
  const std::string length = relative_length(at(estimate.all, Quantity::position), cloth_size);
  std::string remark =
      estimate.steps_irregular ? "; steps twice as long fail or change it hardly more than steps half as long" : "";
  for (const ErrorPart& part : estimate.parts)
    if (!part.missing.empty()) remark += fmt::format("; the error due to the {} is not known", name_of(part.source));
  if (estimate.is_chaotic)
    return fmt::format(
        "the motion is chaotic: a start moved by 1 µm alone moves positions by {} mm; in all they are off by {} or "
        "more, and no setting reduces that{}",
        start_text(estimate), length, remark);
  return fmt::format("positions {} {}, most of it due to the {}; {} reduces it{}",
                     estimate.is_lower_bound() ? "are off by at least" : "may be off by", length,
                     name_of(largest.source), remedy(largest.source), remark);
}

nlohmann::ordered_json error_json(const ErrorEstimate& estimate) {
  nlohmann::ordered_json parts;
  for (const ErrorPart& part : estimate.parts) {
    std::string key(name_of(part.source));
    std::replace(key.begin(), key.end(), ' ', '_');
    parts[key] = part.missing.empty() ? errors_json(part.errors) : nlohmann::ordered_json{{"missing", part.missing}};
  }
  return {{"comparable", !estimate.is_lower_bound()},
          {"parts", std::move(parts)},
          {"all", errors_json(estimate.all)},
          {"advice", error_sentence(estimate, 0)},
          {"cpu_s", estimate.cpu_s}};
}

}  // namespace weft::cli
