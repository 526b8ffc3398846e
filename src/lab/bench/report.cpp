#include "lab/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace weft::bench {
namespace {

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\n") == std::string::npos) return field;
  std::string text = "\"";
  for (char c : field) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

// Escapes bars, which would end a table cell, and replaces line feeds, which would end a row, by
// spaces.
std::string escaped(const std::string& field) {
  std::string text;
  for (char c : field) text += c == '|' ? std::string("\\|") : std::string(1, c == '\n' ? ' ' : c);
  return text;
}

const char* color_of(Verdict verdict) {
  constexpr const char* kFills[kVerdicts] = {"#7fbf7b", "#f1c453", "#e08f3c", "#d7503f", "#222222"};
  return kFills[static_cast<std::size_t>(verdict)];
}

template <class Key>
std::vector<double> values_of(const std::vector<MapCell>& cells, Key key) {
  std::set<double> values;
  for (const MapCell& cell : cells) values.insert(cell.*key);
  return {values.begin(), values.end()};
}

std::size_t place_of(const std::vector<double>& values, double value) {
  return static_cast<std::size_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

}  // namespace

std::string csv(const Table& table) {
  std::string text;
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + quoted(row[i]);
    text += "\n";
  }
  return text;
}

std::string markdown(const Table& table) {
  std::string text;
  for (std::size_t r = 0; r < table.size(); ++r) {
    text += "|";
    for (const std::string& field : table[r]) text += " " + escaped(field) + " |";
    text += "\n";
    if (r > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < table[r].size(); ++i) text += "---|";
    text += "\n";
  }
  return text;
}

std::string link_to(const std::string& file) {
  std::string link;
  for (const char c : file) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                          c == '.' || c == '_' || c == '~';
    link += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return link;
}

int Tally::wrong() const {
  return of_[static_cast<std::size_t>(Verdict::unbounded)] + of_[static_cast<std::size_t>(Verdict::not_finite)];
}

std::string Tally::text() const {
  std::string text;
  for (std::size_t k = 0; k < kVerdicts; ++k)
    text += fmt::format("{}{} {}", k > 0 ? ", " : "", of_[k], describe(static_cast<Verdict>(k)));
  return text;
}

Table map_table(const std::vector<MapCell>& cells) {
  Table table{{"integrator", "stiffness_n_per_m", "step_s", "verdict", "swings", "stiffest_periods", "steps",
               "rejected_steps", "newton_a_step", "energy_gain", "max_strain", "cpu_s", "reason"}};
  for (const MapCell& cell : cells) {
    const Outcome& o = cell.outcome;
    table.push_back({std::string(name_of(cell.integrator)), fmt::format("{:g}", cell.stiffness),
                     fmt::format("{:g}", cell.step), std::string(describe(o.verdict)),
                     fmt::format("{:.2g}", cell.swings), fmt::format("{:.2g}", cell.stiffest_periods),
                     std::to_string(o.steps), std::to_string(o.rejected_steps),
                     fmt::format("{:.2f}", static_cast<double>(o.newton_iterations) / std::max(1, o.steps)),
                     fmt::format("{:.3g}", o.energy_gain), fmt::format("{:.3g}", o.max_strain),
                     fmt::format("{:.2f}", o.cpu_s), o.reason});
  }
  return table;
}

std::string map_svg(const std::vector<MapCell>& cells) {
  constexpr double kCell = 34, kLeft = 70, kTop = 40, kGap = 60;
  const auto steps = values_of(cells, &MapCell::step), stiffnesses = values_of(cells, &MapCell::stiffness);
  const double panel = kCell * static_cast<double>(steps.size()),
               tall = kCell * static_cast<double>(stiffnesses.size());
  std::string body;
  for (const MapCell& cell : cells) {
    const double left = kLeft + static_cast<double>(cell.integrator) * (panel + kGap);
    const double x = left + kCell * static_cast<double>(place_of(steps, cell.step));
    const double y = kTop + tall - kCell * static_cast<double>(place_of(stiffnesses, cell.stiffness) + 1);
    body += fmt::format("<rect x='{:.0f}' y='{:.0f}' width='{:.0f}' height='{:.0f}' fill='{}' stroke='white'/>\n", x, y,
                        kCell, kCell, color_of(cell.outcome.verdict));
    body += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>{:.1f}</text>\n", x + 0.5 * kCell,
                        y + 0.6 * kCell,
                        static_cast<double>(cell.outcome.newton_iterations) / std::max(1, cell.outcome.steps));
    if (cell.stiffness == stiffnesses.front()) {
      body += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>{:g}</text>\n", x + 0.5 * kCell,
                          kTop + tall + 14, cell.step);
      if (cell.step == steps.front())
        body += fmt::format("<text x='{:.0f}' y='{:.0f}' font-size='13'>{}, step [s] to the right</text>\n", left,
                            kTop - 12, name_of(cell.integrator));
    }
    if (cell.step == steps.front())
      body += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='end'>{:g}</text>\n", left - 4, y + 0.6 * kCell,
                          cell.stiffness);
  }
  const double width = kLeft + 3 * (panel + kGap), height = kTop + tall + 60;
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "font-family='sans-serif' font-size='10'>\n<rect width='100%' height='100%' fill='white'/>\n{2}<text x='{3:.0f}' "
      "y='{4:.0f}' font-size='12'>Stiffness of stretch [N/m] upward; in each cell Newton iterations a step. Green "
      "solved, yellow refused by name, orange warned of and red not: more energy than is possible, black not "
      "finite.</text>\n</svg>\n",
      width, height, body, kLeft, height - 12);
}

}  // namespace weft::bench
