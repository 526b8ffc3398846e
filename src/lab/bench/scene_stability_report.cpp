#include "lab/bench/scene_stability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/markup.hpp"

namespace weft::bench {
namespace {

constexpr double kTrialCell = 44, kTrialLeft = 90, kTrialTop = 50;

const char* color_of(TrialVerdict verdict) {
  constexpr const char* kFills[kTrialVerdicts] = {"#7fbf7b", "#e08f3c", "#f1c453", "#222222", "#9db7d9", "#dddddd"};
  return kFills[static_cast<std::size_t>(verdict)];
}

double newton_of(const Trial& trial) {
  return static_cast<double>(trial.newton_iterations) / std::max(1, trial.steps);
}

std::string what_of(const Trial& trial) {
  std::string text;
  for (const std::string& what : trial.new_faults) text += (text.empty() ? "" : ", ") + what;
  if (trial.verdict == TrialVerdict::too_slow)
    text = fmt::format("given up after {} frames and {:.2g} CPU s{}{}", trial.frames, trial.cpu_s,
                       text.empty() ? "" : "; ", text);
  if (!trial.reason.empty()) text = trial.reason;
  if (trial.verdict == TrialVerdict::not_finite)
    text = fmt::format("a position is no number in frame {}", trial.frames);
  return text;
}

std::string value_of(VariedParameter axis, double factor, const SceneStability& stability) {
  std::string times = fmt::format("{:g} times {}", factor, factor == 0 ? "(none)" : "its value");
  if (axis != VariedParameter::step || stability.as_is.step == 0) return times;
  return fmt::format("{:g} ms", 1e3 * stability.as_is.step * factor);
}

// Distance of a factor from 1, on a logarithmic scale; factors below 0.1 count as 0.1.
double distance(double factor) {
  return std::abs(std::log(std::max(factor, 0.1)));
}

double distance(const Factors& factors) {
  double sum = 0;
  for (const double factor : factors) sum += distance(factor);
  return sum;
}

std::string cell(double x, double y, const Trial* trial) {
  if (trial == nullptr) return {};
  return fmt::format(
      "<rect x='{0:.0f}' y='{1:.0f}' width='{2:.0f}' height='{2:.0f}' fill='{3}' stroke='white'><title>{6}: "
      "{7}</title></rect>\n<text x='{4:.0f}' y='{5:.0f}' text-anchor='middle'>{8:.1f}</text>\n",
      x, y, kTrialCell, color_of(trial->verdict), x + 0.5 * kTrialCell, y + 0.6 * kTrialCell, describe(trial->verdict),
      markup_text(what_of(*trial)), newton_of(*trial));
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='{}'>{}</text>\n", x, y, anchor, text);
}

}  // namespace

std::string margin_sentence(const SceneStability& stability) {
  const std::vector<Margin> margins = margins_of(stability);
  const Trial& as_is = stability.as_is;
  if (as_is.verdict != TrialVerdict::holds) {
    const Trial* cure = nullptr;
    for (const Trial& trial : stability.trials)
      if (trial.is_free_of_faults && (cure == nullptr || distance(trial.factors) < distance(cure->factors)))
        cure = &trial;
    std::string text = fmt::format("The scene as it is breaks ({}: {})", describe(as_is.verdict), what_of(as_is));
    for (std::size_t a = 0; cure != nullptr && a < kVariedValues; ++a)
      if (cure->factors[a] != 1)
        text += fmt::format("; it goes through with {} at {}", name_of(static_cast<VariedParameter>(a)),
                            value_of(static_cast<VariedParameter>(a), cure->factors[a], stability));
    return text + ".";
  }
  const Margin* nearest = nullptr;
  for (const Margin& margin : margins) {
    if (margin.breaks == nullptr) continue;
    const auto of = [](const Margin& m) { return distance(m.breaks->factors[static_cast<std::size_t>(m.axis)]); };
    if (nearest == nullptr || of(margin) < of(*nearest)) nearest = &margin;
  }
  if (nearest == nullptr)
    return "The scene as it is runs without anything broken, and so it does with every value that was tried.";
  const auto a = static_cast<std::size_t>(nearest->axis);
  return fmt::format(
      "The scene as it is runs without anything broken, and its nearest limit is {}: it holds at {} and "
      "breaks at {} ({}: {}).",
      name_of(nearest->axis),
      nearest->holds == 1 ? std::string("its own value") : value_of(nearest->axis, nearest->holds, stability),
      value_of(nearest->axis, nearest->breaks->factors[a], stability), describe(nearest->breaks->verdict),
      what_of(*nearest->breaks));
}

Table margin_table(const SceneStability& stability) {
  Table table{{"value", "side", "holds up to", "breaks at", "verdict", "what breaks"}};
  const std::vector<Margin> margins = margins_of(stability);
  for (std::size_t k = 0; k < margins.size(); ++k) {
    const Margin& margin = margins[k];
    const bool below =
        margin.breaks != nullptr ? margin.breaks->factors[static_cast<std::size_t>(margin.axis)] < 1 : margin.holds < 1;
    const auto text = [&](double factor) {
      return factor == 1 ? "as it is" : value_of(margin.axis, factor, stability);
    };
    table.push_back(
        {std::string(name_of(margin.axis)), below ? "less" : "more", text(margin.holds),
         margin.breaks ? text(margin.breaks->factors[static_cast<std::size_t>(margin.axis)]) : "nothing that was tried",
         margin.breaks ? std::string(describe(margin.breaks->verdict)) : "",
         margin.breaks ? what_of(*margin.breaks) : ""});
  }
  return table;
}

Table trial_table(const SceneStability& stability) {
  Table table{{}};
  for (std::size_t a = 0; a < kVariedValues; ++a) table[0].emplace_back(name_of(static_cast<VariedParameter>(a)));
  for (const char* column :
       {"step_s", "verdict", "frames", "steps", "rejected_steps", "newton_a_step", "max_strain", "cpu_s", "what"})
    table[0].emplace_back(column);
  const auto add = [&](const Trial& trial) {
    std::vector<std::string> row;
    for (const double factor : trial.factors) row.push_back(fmt::format("{:g}", factor));
    for (const std::string& field :
         {trial.step > 0 ? fmt::format("{:g}", trial.step) : std::string(), std::string(describe(trial.verdict)),
          std::to_string(trial.frames), std::to_string(trial.steps), std::to_string(trial.rejected_steps),
          fmt::format("{:.2f}", newton_of(trial)), fmt::format("{:.3g}", trial.max_strain),
          fmt::format("{:.2f}", trial.cpu_s), what_of(trial)})
      row.push_back(field);
    table.push_back(std::move(row));
  };
  add(stability.as_is);
  for (const Trial& trial : stability.trials) add(trial);
  return table;
}

std::string trial_svg(const std::string& title, const SceneStability& stability) {
  std::string body =
      label(kTrialLeft, 22, "start", markup_text(title) + ": one value at a time, times that of the scene");
  double y = kTrialTop;
  for (std::size_t a = 0; a < kVariedValues; ++a, y += kTrialCell + 18) {
    body += label(kTrialLeft - 8, y + 0.6 * kTrialCell, "end", std::string(name_of(static_cast<VariedParameter>(a))));
    double x = kTrialLeft;
    for (const double factor : factors_of(static_cast<VariedParameter>(a))) {
      Factors factors{1, 1, 1, 1, 1, 1};
      factors[a] = factor;
      body += cell(x, y, stability.find(factors));
      body += label(x + 0.5 * kTrialCell, y + kTrialCell + 12, "middle", fmt::format("{:g}", factor));
      x += kTrialCell;
    }
  }
  double x = kTrialLeft + 7 * kTrialCell + 110;
  body += label(x, 22, "start", "stiffness upward, step to the right");
  for (std::size_t s = 0; s < kMapSteps.size(); ++s, x += kTrialCell) {
    y = kTrialTop + kTrialCell * static_cast<double>(kMapStiffness.size());
    body += label(x + 0.5 * kTrialCell, y + 12, "middle", fmt::format("{:g}", kMapSteps[s]));
    for (const double stiffness : kMapStiffness) {
      y -= kTrialCell;
      body += cell(x, y, stability.find({stiffness, kMapSteps[s], 1, 1, 1, 1}));
      if (s == 0) body += label(x - 6, y + 0.6 * kTrialCell, "end", fmt::format("{:g}", stiffness));
    }
  }
  y = kTrialTop + kVariedValues * (kTrialCell + 18) + 14;
  double key = kTrialLeft;
  for (std::size_t v = 0; v < kTrialVerdicts; ++v) {
    const auto verdict = static_cast<TrialVerdict>(v);
    body += fmt::format("<rect x='{:.0f}' y='{:.0f}' width='12' height='12' fill='{}'/>\n", key, y, color_of(verdict));
    body += label(key + 16, y + 10, "start", std::string(describe(verdict)));
    key += 90;
  }
  body += label(key, y + 10, "start", "numbers: Newton iterations a step");
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "font-family='sans-serif' font-size='11'>\n<rect width='100%' height='100%' fill='white'/>\n{2}</svg>\n",
      kTrialLeft + 12 * kTrialCell + 150, y + 30, body);
}

std::string scene_stability_markdown(const std::string& title, const SceneStability& stability,
                                     const std::string& picture) {
  double cpu_s = stability.as_is.cpu_s;
  int broken_runs = 0;
  for (const Trial& trial : stability.trials) {
    cpu_s += trial.cpu_s;
    broken_runs += trial.breaks();
  }
  return fmt::format(
      "# Stability of {}\n\n{}\n\n![map]({})\n\n{} runs of {} frames, {:.0f} CPU s; {} of them break. Factors are on "
      "the values of the scene; something counts as broken that is not so in the scene as it is.\n\n{}\n## All "
      "runs\n\n{}",
      title, margin_sentence(stability), link_to(picture), stability.trials.size() + 1, stability.frames, cpu_s,
      broken_runs, markdown(margin_table(stability)), markdown(trial_table(stability)));
}

}  // namespace weft::bench
