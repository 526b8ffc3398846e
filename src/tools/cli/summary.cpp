#include "tools/cli/summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "tools/cli/error_report.hpp"
#include "tools/cli/table.hpp"

namespace weft::cli {
namespace {

using Row = std::vector<std::string>;

constexpr double kLargeStrain = 0.25;  // woven cloth tears at about this strain

std::string bytes_text(std::uintmax_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return fmt::format("{} bytes", bytes);
  if (value < 1e6) return fmt::format("{:.0f} kB", value / 1e3);
  if (value < 1e9) return fmt::format("{:.1f} MB", value / 1e6);
  return fmt::format("{:.2f} GB", value / 1e9);
}

std::string headline(const RunReport& report) {
  if (report.width == 0)
    return fmt::format("{}: {} frame{} at {:.4g} fps, {}", report.output, report.frames.size(),
                       report.frames.size() == 1 ? "" : "s", report.fps, bytes_text(report.cache_bytes));
  if (report.written == 0) return fmt::format("{}: no frame was written", report.output);
  const double video_fps = report.fps / report.wanted.step;
  std::string line = fmt::format("{}: {} frame{}, {}x{} at {:.4g} fps", report.output, report.written,
                                 report.written == 1 ? "" : "s", report.width, report.height, video_fps);
  if (report.output_bytes > 0) line += fmt::format(", {}", bytes_text(report.output_bytes));
  return line;
}

Row stage_row(const char* name, const StageTime& time, int frames) {
  const std::string per_frame = frames > 0 ? fmt::format("{:.1f} ms", 1e3 * time.cpu_s / frames) : std::string("-");
  return {name, fmt::format("{:.2f} s", time.wall_s), fmt::format("{:.2f} s", time.cpu_s), per_frame};
}

std::string times_table(const RunReport& report) {
  const StageTotals totals = total_times(report.frames);
  // Frame 0 is the given start, which is not simulated. Frames read from a cache may begin later.
  const auto simulated = static_cast<int>(
      std::ranges::count_if(report.frames, [](const FrameRecord& record) { return record.report.frame > 0; }));
  std::vector<Row> rows{{"", "wall", "CPU", "CPU a frame"},
                        stage_row("set up", report.setup, 0),
                        stage_row(report.replayed ? "simulated before" : "simulate", totals.simulate, simulated),
                        stage_row("  collisions", totals.collide, simulated)};
  if (report.cache.wall_s > 0) rows.push_back(stage_row("cache", report.cache, static_cast<int>(report.frames.size())));
  if (report.width > 0) {
    rows.push_back(stage_row("draw", totals.render, report.written));
    rows.push_back(stage_row("encode", totals.encode, report.written));
  }
  if (totals.meshes.wall_s > 0) rows.push_back(stage_row("meshes", totals.meshes, report.written));
  rows.push_back(stage_row("whole run", {report.wall_s, report.cpu_s}, report.written));
  return format_table(rows, "lrrr", 2);
}

// The largest value and its frame, for example "0.0123 (frame 45)".
template <class Value>
std::string at_largest(const std::vector<FrameRecord>& frames, const char* format, const Value& value, double scale) {
  const auto largest = std::max_element(
      frames.begin(), frames.end(), [&](const auto& a, const auto& b) { return value(a.report) < value(b.report); });
  return fmt::format(fmt::runtime(format), scale * value(largest->report)) +
         fmt::format(" (frame {})", largest->report.frame);
}

// Energies below a picojoule are rounding errors.
std::string joule(double energy) {
  return fmt::format("{:.3g} J", std::abs(energy) < 1e-12 ? 0.0 : energy);
}

// One sentence: the error of positions, its main source, and how to reduce the error. Without
// --error, the sentence covers only the frame with the largest error: the errors of frames do not
// add up, since later motion may reduce or amplify them.
std::string error_text(const RunReport& report) {
  if (report.error) return error_sentence(*report.error, report.cloth_size);
  const auto of_frame = [](const FrameRecord& record) {
    return std::max(record.report.error_estimate, record.report.solver_error);
  };
  const auto worst = std::ranges::max_element(report.frames, {}, of_frame)->report;
  const double steps = worst.error_estimate, solver = worst.solver_error;
  if (!(std::max(steps, solver) > 0)) return "no step was taken";
  const bool by_solver = solver > steps;
  return fmt::format(
      "frame {}, the worst, adds about {} to the error of positions, due to the {} (the {}: {:.2g} mm); a smaller {} "
      "reduces it; --error estimates that of the whole run",
      worst.frame, relative_length(by_solver ? solver : steps, report.cloth_size), by_solver ? "solver" : "time steps",
      by_solver ? "time steps" : "solver", 1e3 * (by_solver ? steps : solver),
      by_solver ? "solver.newton_tolerance" : "time.step or time.tolerance");
}

std::string figures_table(const RunReport& report) {
  const StepTotals steps = total_steps(report.frames);
  long long newton = 0, linear = 0;
  for (const FrameRecord& record : report.frames) {
    newton += record.report.newton_iterations;
    linear += record.report.linear_iterations;
  }
  const simulation::FrameReport &first = report.frames.front().report, &last = report.frames.back().report;
  const auto nearness = [](const simulation::FrameReport& r) { return -r.min_distance; };
  const bool none_near = std::all_of(report.frames.begin(), report.frames.end(),
                                     [](const FrameRecord& r) { return std::isinf(r.report.min_distance); });
  const auto strain = [](const simulation::FrameReport& r) { return r.max_strain; };
  return format_table({{"particles", fmt::format("{} in {} objects", report.particles, report.objects.size())},
                       {"steps", fmt::format("{} and {} rejected; {} Newton and {} linear iterations", steps.accepted,
                                             steps.rejected, newton, linear)},
                       {"error", error_text(report)},
                       {"smallest distance", none_near ? "nothing within the detection distance"
                                                       : at_largest(report.frames, "{:.3g} mm", nearness, -1e3)},
                       {"largest strain", at_largest(report.frames, "{:.2f} %", strain, 100)},
                       {"energy at the end", fmt::format("kinetic {} (start {}), elastic {} (start {})",
                                                         joule(last.kinetic_energy), joule(first.kinetic_energy),
                                                         joule(last.elastic_energy), joule(first.elastic_energy))},
                       {"peak memory", bytes_text(static_cast<std::uintmax_t>(report.peak_memory))},
                       {"scene", fmt::format("{} ({:016x}), {} thread{}", report.scene_file, report.scene_hash,
                                             report.threads, report.threads == 1 ? "" : "s")}},
                      "ll", 2);
}

}  // namespace

std::string summary(const RunReport& report) {
  std::string text = headline(report) + "\n" + times_table(report);
  if (!report.frames.empty()) text += figures_table(report);
  if (report.error) text += error_summary(*report.error) + "\n";
  for (const std::string& note : report.notes) text += fmt::format("  note: {}\n", note);
  for (const std::string& warning : report.warnings) text += fmt::format("  warning: {}\n", warning);
  text.pop_back();
  return text;
}

std::vector<std::string> find_warnings(const std::vector<FrameRecord>& frames) {
  std::vector<std::string> warnings;
  if (frames.empty()) return warnings;
  const StepTotals steps = total_steps(frames);
  using Report = simulation::FrameReport;
  const auto worst = [&](auto value) -> const Report& {
    return std::ranges::max_element(frames, {}, [&](const FrameRecord& r) { return std::invoke(value, r.report); })
        ->report;
  };
  // The frames for which `holds` is true, such as "in 3 of 76 frames, first in frame 12"; empty if there are none.
  const auto where = [&](auto holds) {
    const auto in = [&](const FrameRecord& r) { return holds(r.report); };
    const auto count = std::ranges::count_if(frames, in);
    return count == 0 ? std::string()
                      : fmt::format("in {} of {} frames, first in frame {}", count, frames.size(),
                                    std::ranges::find_if(frames, in)->report.frame);
  };
  const auto warn = [&]<class... Args>(fmt::format_string<Args...> text, Args&&... args) {
    warnings.push_back(fmt::format(text, std::forward<Args>(args)...));
  };
  if (const Report& most = worst(&Report::max_strain); most.max_strain > kLargeStrain)
    warn(
        "threads were stretched or squeezed by up to {:.0f} %, in frame {}: a stiffer material or a smaller time.step "
        "may be needed",
        100 * most.max_strain, most.frame);
  const auto is_overstretched = [](const Report& r) { return r.stretch_ratio > simulation::kMaxStretchRatio; };
  if (const std::string in = where(is_overstretched); !in.empty()) {
    const Report& most = worst(&Report::stretch_ratio);
    warn(
        "cloth was stretched beyond its max_stretch {}, most in frame {}, to {:.1f} times that limit (warnings of "
        "single frames name the cloth): pins farther apart than the cloth is long, an obstacle pressed into pinned "
        "cloth, or a motion too fast for time.step",
        in, most.frame, most.stretch_ratio);
  }
  if (steps.rejected > steps.accepted / 4)
    warn("{} of {} steps failed and were repeated as shorter ones: a smaller time.step would be faster", steps.rejected,
         steps.accepted + steps.rejected);
  if (steps.inexact > 0)
    warn(
        "{} of {} steps, most in frame {}, have an error above time.tolerance: something hits so hard there that exact "
        "steps would be too short; slower motion is more exact",
        steps.inexact, steps.accepted, worst(&Report::inexact_steps).frame);
  if (const std::string in = where([](const Report& r) { return r.pinched_pairs > 0; }); !in.empty())
    warn(
        "obstacles left cloth no space, so that it is inside one of them, {} (warnings of single frames name them): "
        "move them farther apart there",
        in);
  if (const std::string in = where([](const Report& r) { return r.lagging_particles > 0; }); !in.empty())
    warn(
        "pins lagged behind, because something was in their way, {} (warnings of single frames name the pin): change "
        "its keys or what is in its way",
        in);
  if (const std::string in = where([](const Report& r) { return r.min_distance <= 0; }); !in.empty())
    warn("surfaces touched or passed through each other {}: a smaller time.step may be needed", in);
  return warnings;
}

}  // namespace weft::cli
