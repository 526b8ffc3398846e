#include "lab/bench/speed_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lab/bench/plot.hpp"

namespace weft::bench {
namespace {

// Colours of the stages (palette of Okabe and Ito): they also differ in grey print and with red-green blindness.
constexpr const char* kColors[kSpeedStages] = {"#d55e00", "#e69f00", "#0072b2", "#009e73", "#999999", "#cc79a7"};

double frames_of(const SpeedRun& run) {
  return std::max(1, run.frames);
}
double cpu_ms(const SpeedRun& run, const StageTime& stage) {
  return 1e3 * stage.cpu_s / frames_of(run);
}
double wall_ms(const SpeedRun& run, const StageTime& stage) {
  return 1e3 * stage.wall_s / frames_of(run);
}
double bound_ms(const SpeedRun& run) {
  return 1e3 * memory_bound_s(run) / frames_of(run);
}
/// Sum of the stages to which memory_bound_s() applies.
StageTime solving(const SpeedRun& run) {
  StageTime sum = run.at(SpeedStage::forces);
  sum += run.at(SpeedStage::preconditioner);
  sum += run.at(SpeedStage::linear);
  return sum;
}
double newton_a_step(const SpeedRun& run) {
  return static_cast<double>(run.newton_iterations) / std::max(1, run.steps);
}
double linear_a_newton(const SpeedRun& run) {
  return static_cast<double>(run.linear_iterations) / std::max(1, run.newton_iterations);
}

/// The stages that took time in any of the runs.
std::vector<SpeedStage> stages_of(const std::vector<const SpeedRun*>& runs) {
  std::vector<SpeedStage> stages;
  for (std::size_t s = 0; s < kSpeedStages; ++s)
    if (std::ranges::any_of(runs, [&](const SpeedRun* run) { return run->stages[s].wall_s > 0; }))
      stages.push_back(static_cast<SpeedStage>(s));
  return stages;
}

int least_threads(const std::vector<SpeedRun>& runs) {
  int least = runs.empty() ? 1 : runs.front().setting.threads;
  for (const SpeedRun& run : runs) least = std::min(least, run.setting.threads);
  return least;
}

template <class Condition, class Order>
std::vector<const SpeedRun*> select(const std::vector<SpeedRun>& runs, const Condition& condition, const Order& order) {
  std::vector<const SpeedRun*> selected;
  for (const SpeedRun& run : runs)
    if (!run.failed() && condition(run)) selected.push_back(&run);
  std::ranges::stable_sort(selected, std::less(), order);
  return selected;
}

// The number with grouped digits, such as 4,096.
std::string grouped(std::int64_t number) {
  std::string text = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(text.size()) - 3; place > 0; place -= 3)
    text.insert(static_cast<std::size_t>(place), ",");
  return text;
}

// Milliseconds with three significant digits below 1 s, whole milliseconds above.
std::string milliseconds(double ms) {
  return ms < 999.5 ? fmt::format("{:.3g}", ms) : grouped(std::lround(ms));
}

std::string cost_growth_text(const std::vector<const SpeedRun*>& sizes) {
  const SpeedRun &small = *sizes.front(), &large = *sizes.back();
  const auto cost = [](const SpeedRun& run) { return cpu_ms(run, run.all()); };
  const auto stages = stages_of({&large});
  const SpeedStage most = *std::max_element(
      stages.begin(), stages.end(), [&](SpeedStage a, SpeedStage b) { return large.at(a).cpu_s < large.at(b).cpu_s; });
  const std::string where = fmt::format("The largest part of that is {}, {:.0f} %.", name_of(most),
                                        100 * large.at(most).cpu_s / large.all().cpu_s);
  const std::string of_large =
      fmt::format("A frame takes {} CPU ms with {} particles", milliseconds(cost(large)), grouped(large.particles));
  const auto power = exponent(small, large, cost(small), cost(large));
  if (!power) return fmt::format("{}. {}", of_large, where);
  const SpeedRun& before = **std::prev(sizes.end(), 2);
  const auto last_power = exponent(before, large, cost(before), cost(large));
  return fmt::format("{}. {} From {} particles, with {} CPU ms, it grows with the power {:.2f} of the particles{}.",
                     of_large, where, grouped(small.particles), milliseconds(cost(small)), *power,
                     sizes.size() > 2 && last_power ? fmt::format(", in the end {:.2f}", *last_power) : "");
}

std::string thread_gain_text(const std::vector<SpeedRun>& runs) {
  std::vector<std::string> gains;
  int most = 0;
  bool same = true;
  for (const SpeedRun* one : over_sizes(runs)) {
    const auto threads = over_threads(runs, one->setting.size);
    if (threads.size() < 2) continue;
    const SpeedRun& last = *threads.back();
    most = last.setting.threads;
    gains.push_back(fmt::format("{:.2f} times as fast with {} particles", one->all().wall_s / last.all().wall_s,
                                grouped(last.particles)));
    for (const SpeedRun* run : threads) same = same && run->positions == one->positions;
  }
  if (gains.empty()) return {};
  return fmt::format("{} threads are {}; the results are {}.", most, fmt::join(gains, ", "),
                     same ? "the same bits with any number" : "NOT the same bits");
}

std::string memory_text(const std::vector<const SpeedRun*>& sizes) {
  const SpeedRun& large = *sizes.back();
  return fmt::format("{} particles take {:.0f} MB, {:.2g} kB each.", grouped(large.particles),
                     static_cast<double>(large.peak_memory) / 1e6, large.bytes_a_particle() / 1e3);
}

std::string bound_text(const std::vector<const SpeedRun*>& sizes) {
  const SpeedRun& large = *sizes.back();
  const double bound = memory_bound_s(large), takes = solving(large).wall_s;
  if (!(bound > 0 && takes > 0)) return {};
  return fmt::format(
      "What it must move through memory would take {:.0f} % of the time of forces, preconditioner and linear solver.",
      100 * bound / takes);
}

// Appends the exponent() of a value in parentheses to `text`. `was`: value in the row above; `is`: value in this row.
std::string with_exponent(std::string text, const SpeedRun* before, const SpeedRun& run, double was, double is) {
  if (const auto power = before ? exponent(*before, run, was, is) : std::nullopt)
    text += fmt::format(" ({:.2f})", *power);
  return text;
}

Table sizes_table(const std::vector<const SpeedRun*>& runs) {
  const auto stages = stages_of(runs);
  Table table{{"particles", "steps", "rejected", "Newton a step", "linear a Newton"}};
  for (SpeedStage stage : stages) table[0].emplace_back(name_of(stage));
  table[0].insert(table[0].end(), {"all", "wall"});
  const SpeedRun* before = nullptr;
  for (const SpeedRun* run : runs) {
    const auto cost = [&](const SpeedRun& of, const auto& stage_of) { return cpu_ms(of, stage_of(of)); };
    const auto cell = [&](const auto& stage_of) {
      const double is = cost(*run, stage_of);
      return with_exponent(milliseconds(is), before, *run, before ? cost(*before, stage_of) : 0, is);
    };
    std::vector<std::string> row{grouped(run->particles), std::to_string(run->steps),
                                 std::to_string(run->rejected_steps), fmt::format("{:.2f}", newton_a_step(*run)),
                                 with_exponent(fmt::format("{:.1f}", linear_a_newton(*run)), before, *run,
                                               before ? linear_a_newton(*before) : 0, linear_a_newton(*run))};
    for (SpeedStage stage : stages) row.push_back(cell([stage](const SpeedRun& of) { return of.at(stage); }));
    row.push_back(cell([](const SpeedRun& of) { return of.all(); }));
    row.push_back(milliseconds(wall_ms(*run, run->all())));
    table.push_back(std::move(row));
    before = run;
  }
  return table;
}

Table threads_table(const std::vector<SpeedRun>& runs) {
  const auto sizes = over_sizes(runs);
  const auto stages = stages_of(sizes);
  Table table{{"particles", "threads"}};
  for (SpeedStage stage : stages) table[0].emplace_back(name_of(stage));
  table[0].insert(table[0].end(), {"all", "times as fast", "CPU ms", "last frame"});
  for (const SpeedRun* one : sizes) {
    for (const SpeedRun* run : over_threads(runs, one->setting.size)) {
      std::vector<std::string> row{grouped(run->particles), std::to_string(run->setting.threads)};
      for (SpeedStage stage : stages) row.push_back(milliseconds(wall_ms(*run, run->at(stage))));
      row.push_back(milliseconds(wall_ms(*run, run->all())));
      row.push_back(fmt::format("{:.2f}", one->all().wall_s / run->all().wall_s));
      row.push_back(milliseconds(cpu_ms(*run, run->all())));
      row.push_back(fmt::format("{:016x}", run->positions));
      table.push_back(std::move(row));
    }
  }
  return table;
}

Table loops_table(const std::vector<SpeedRun>& runs) {
  Table table{{"particles", "serial", "loops a step", "chunks a step"}};
  for (std::size_t threads : LoopCounts::kThreads) table[0].push_back(fmt::format("{} threads", threads));
  for (const SpeedRun* run : over_sizes(runs)) {
    if (run->loops.loops == 0) continue;
    const auto a_step = [&](std::int64_t number) { return grouped(number / std::max(1, run->steps)); };
    table.push_back({grouped(run->particles), fmt::format("{:.1f} %", 100 * run->serial_fraction()),
                     a_step(run->loops.loops), a_step(run->loops.chunks)});
    for (std::size_t t = 0; t < LoopCounts::kThreads.size(); ++t)
      table.back().push_back(fmt::format("{:.1f}", run->largest_gain(t)));
  }
  return table;
}

Table steps_table(const std::vector<const SpeedRun*>& runs) {
  const auto stages = stages_of(runs);
  Table table{{"step of the scene, times", "steps", "rejected", "Newton a step", "linear a Newton"}};
  for (SpeedStage stage : stages) table[0].emplace_back(name_of(stage));
  table[0].emplace_back("all");
  for (const SpeedRun* run : runs) {
    std::vector<std::string> row{fmt::format("{:g}", run->setting.step), std::to_string(run->steps),
                                 std::to_string(run->rejected_steps), fmt::format("{:.2f}", newton_a_step(*run)),
                                 fmt::format("{:.1f}", linear_a_newton(*run))};
    for (SpeedStage stage : stages) row.push_back(milliseconds(cpu_ms(*run, run->at(stage))));
    row.push_back(milliseconds(cpu_ms(*run, run->all())));
    table.push_back(std::move(row));
  }
  return table;
}

Table memory_table(const std::vector<const SpeedRun*>& runs) {
  Table table{{"particles", "peak MB", "bytes a particle", "full blocks a row", "multiples of the unit matrix a row"}};
  for (const SpeedRun* run : runs) {
    const auto rows = static_cast<double>(run->particles);
    table.push_back({grouped(run->particles), fmt::format("{:.1f}", static_cast<double>(run->peak_memory) / 1e6),
                     fmt::format("{:.0f}", run->bytes_a_particle()),
                     fmt::format("{:.1f}", static_cast<double>(run->full_blocks) / rows),
                     fmt::format("{:.1f}", static_cast<double>(run->isotropic_blocks) / rows)});
  }
  return table;
}

Table bound_table(const std::vector<SpeedRun>& runs) {
  Table table{{"particles", "threads", "MB a linear iteration", "MB a Newton iteration besides", "GB/s", "bound ms",
               "takes ms", "share"}};
  for (const SpeedRun* one : over_sizes(runs)) {
    for (const SpeedRun* run : over_threads(runs, one->setting.size)) {
      const double takes = wall_ms(*run, solving(*run));
      table.push_back({grouped(run->particles), std::to_string(run->setting.threads),
                       fmt::format("{:.3g}", bytes_of_linear_iteration(*run) / 1e6),
                       fmt::format("{:.3g}", bytes_of_newton_iteration(*run) / 1e6),
                       fmt::format("{:.3g}", run->bandwidth / 1e9), milliseconds(bound_ms(*run)), milliseconds(takes),
                       fmt::format("{:.0f} %", 100 * bound_ms(*run) / takes)});
    }
  }
  return table;
}

Table peer_table(const std::vector<PeerRun>& runs) {
  const auto pairs = [](const FramePairs& of) { return fmt::format("{}, {}", grouped(of.worst), grouped(of.last)); };
  Table table{{"particles", "Weft ms", "peer ms", "Weft / peer", "pairs of Weft", "pairs of the peer"}};
  for (const PeerRun& run : runs)
    if (!run.failed())
      table.push_back({grouped(run.particles), milliseconds(run.weft_ms), milliseconds(run.peer_ms),
                       fmt::format("{:.2f}", run.weft_ms / run.peer_ms), pairs(run.weft_pairs), pairs(run.peer_pairs)});
  return table;
}

std::string failures_text(const SpeedReport& report) {
  Table table{{"size", "threads", "step", "why"}};
  for (const SpeedRun& run : report.runs)
    if (run.failed())
      table.push_back({fmt::format("{:g}", run.setting.size), std::to_string(run.setting.threads),
                       fmt::format("{:g}", run.setting.step), run.failure});
  for (const PeerRun& run : report.peer_runs)
    if (run.failed()) table.push_back({fmt::format("{:g}", run.size), "1", "1", run.failure});
  return table.size() > 1 ? fmt::format("## Runs that failed\n\n{}\n", markdown(table)) : std::string();
}

template <class Value>
Curve curve_of(const char* name, const char* color, Marker marker, const std::vector<const SpeedRun*>& runs,
               const Value& value) {
  Curve curve{name, color, marker, false, {}};
  for (const SpeedRun* run : runs) curve.points.emplace_back(static_cast<double>(run->particles), value(*run));
  return curve;
}

}  // namespace

std::vector<const SpeedRun*> over_sizes(const std::vector<SpeedRun>& runs) {
  const int threads = least_threads(runs);
  return select(
      runs, [&](const SpeedRun& run) { return run.setting.threads == threads && run.setting.step == 1; },
      [](const SpeedRun* run) { return run->setting.size; });
}

std::vector<const SpeedRun*> over_threads(const std::vector<SpeedRun>& runs, double size) {
  return select(
      runs, [&](const SpeedRun& run) { return run.setting.size == size && run.setting.step == 1; },
      [](const SpeedRun* run) { return run->setting.threads; });
}

std::vector<const SpeedRun*> over_steps(const std::vector<SpeedRun>& runs) {
  const auto other = std::ranges::find_if(runs, [](const SpeedRun& run) { return run.setting.step != 1; });
  if (other == runs.end()) return {};
  return select(
      runs,
      [&](const SpeedRun& run) {
        return run.setting.size == other->setting.size && run.setting.threads == other->setting.threads;
      },
      [](const SpeedRun* run) { return -run->setting.step; });
}

std::optional<double> exponent(const SpeedRun& small, const SpeedRun& large, double of_small, double of_large) {
  if (small.particles >= large.particles || !(of_small > 0 && of_large > 0)) return std::nullopt;
  return std::log(of_large / of_small) /
         std::log(static_cast<double>(large.particles) / static_cast<double>(small.particles));
}

Table speed_table(const std::vector<SpeedRun>& runs) {
  Table table{{"size", "threads", "step", "particles", "frames", "steps", "rejected_steps", "newton_iterations",
               "linear_iterations"}};
  for (std::size_t s = 0; s <= kSpeedStages; ++s) {
    std::string name(s < kSpeedStages ? name_of(static_cast<SpeedStage>(s)) : "all");
    std::ranges::replace(name, ' ', '_');
    table[0].push_back(name + "_cpu_ms");
    table[0].push_back(name + "_wall_ms");
  }
  table[0].insert(table[0].end(),
                  {"full_blocks", "isotropic_blocks", "memory_before_bytes", "peak_memory_bytes", "bytes_a_particle",
                   "linear_iteration_bytes", "newton_iteration_bytes", "bandwidth_bytes_a_s", "bound_ms", "loops",
                   "chunks", "loops_wall_ms", "last_positions", "failure"});
  for (const SpeedRun& run : runs) {
    const SpeedSetting& s = run.setting;
    std::vector<std::string> row{fmt::format("{:g}", s.size), std::to_string(s.threads), fmt::format("{:g}", s.step)};
    if (!run.failed()) {
      for (std::int64_t number :
           {run.particles, std::int64_t{run.frames}, std::int64_t{run.steps}, std::int64_t{run.rejected_steps},
            std::int64_t{run.newton_iterations}, std::int64_t{run.linear_iterations}})
        row.push_back(std::to_string(number));
      for (std::size_t stage = 0; stage <= kSpeedStages; ++stage) {
        const StageTime time = stage < kSpeedStages ? run.stages[stage] : run.all();
        row.push_back(fmt::format("{:.6g}", cpu_ms(run, time)));
        row.push_back(fmt::format("{:.6g}", wall_ms(run, time)));
      }
      for (std::int64_t number : {run.full_blocks, run.isotropic_blocks, run.memory_before, run.peak_memory})
        row.push_back(std::to_string(number));
      for (double number : {run.bytes_a_particle(), bytes_of_linear_iteration(run), bytes_of_newton_iteration(run),
                            run.bandwidth, bound_ms(run)})
        row.push_back(fmt::format("{:.6g}", number));
      row.push_back(std::to_string(run.loops.loops));
      row.push_back(std::to_string(run.loops.chunks));
      row.push_back(fmt::format("{:.6g}", 1e3 * run.loops.seconds / frames_of(run)));
      row.push_back(fmt::format("{:016x}", run.positions));
    }
    row.resize(table[0].size() - 1);
    row.push_back(run.failure);
    table.push_back(std::move(row));
  }
  return table;
}

std::string conclusion(const std::vector<SpeedRun>& runs) {
  const auto sizes = over_sizes(runs);
  if (sizes.empty()) return "No run succeeded.\n";
  std::vector<std::string> sentences{cost_growth_text(sizes), thread_gain_text(runs), memory_text(sizes),
                                     bound_text(sizes)};
  std::erase(sentences, "");
  return fmt::format("{}\n", fmt::join(sentences, " "));
}

std::string speed_svg(const SpeedReport& report) {
  const auto sizes = over_sizes(report.runs);
  const std::string across = "particles";
  Panel cost{report.title, across, "CPU ms a frame", {}};
  for (SpeedStage stage : stages_of(sizes))
    cost.curves.push_back(curve_of(name_of(stage).data(), kColors[static_cast<std::size_t>(stage)], Marker::circle,
                                   sizes, [stage](const SpeedRun& run) { return cpu_ms(run, run.at(stage)); }));
  cost.curves.push_back(
      curve_of("all", "black", Marker::square, sizes, [](const SpeedRun& run) { return cpu_ms(run, run.all()); }));
  Panel threads{"Threads", across, "wall ms a frame", {}};
  std::set<int> counts;
  for (const SpeedRun& run : report.runs) counts.insert(run.setting.threads);
  std::size_t color = 0;
  for (int count : counts) {
    const auto with = select(
        report.runs, [&](const SpeedRun& run) { return run.setting.threads == count && run.setting.step == 1; },
        [](const SpeedRun* run) { return run->setting.size; });
    const char* tint = kColors[color++ % kSpeedStages];
    const std::string name = fmt::format("{} thread{}", count, count == 1 ? "" : "s");
    threads.curves.push_back(curve_of(name.c_str(), tint, Marker::circle, with,
                                      [](const SpeedRun& run) { return wall_ms(run, run.all()); }));
    threads.curves.push_back(curve_of((name + ", bound").c_str(), tint, Marker::triangle, with, bound_ms));
    threads.curves.back().dashed = true;
  }
  Panel iterations{"Iterations", across, "iterations", {}};
  iterations.curves = {curve_of("Newton a step", kColors[0], Marker::circle, sizes, newton_a_step),
                       curve_of("linear a Newton", kColors[2], Marker::square, sizes, linear_a_newton)};
  Panel memory{"Memory", across, "bytes a particle", {}};
  memory.curves = {curve_of("peak of the process", kColors[3], Marker::circle, sizes,
                            [](const SpeedRun& run) { return run.bytes_a_particle(); })};
  std::vector<Panel> panels{cost, threads, iterations, memory};
  const auto steps = over_steps(report.runs);
  if (steps.size() > 1) {
    Panel panel{"Steps", "step, times that of the scene", "CPU ms a frame", {}};
    panel.curves = {{"all", "black", Marker::square, false, {}}};
    for (const SpeedRun* run : steps) panel.curves[0].points.emplace_back(run->setting.step, cpu_ms(*run, run->all()));
    panels.push_back(panel);
  }
  return log_log_svg(panels);
}

std::string speed_markdown(const SpeedReport& report, const std::string& plot) {
  const auto sizes = over_sizes(report.runs), steps = over_steps(report.runs);
  std::string text = fmt::format(
      "# Speed: {}\n\n{}\n![By particles]({})\n\nFrames {} up to but without {}, all times of one frame on average. "
      "{}. "
      "Each run is a process of its own.\n\n",
      report.title, conclusion(report.runs), link_to(plot), report.frames.begin, report.frames.end, report.machine);
  const auto section = [&](const std::string& heading, const std::string& about, const Table& table) {
    if (table.size() > 1) text += fmt::format("## {}\n\n{}\n\n{}\n", heading, about, markdown(table));
  };
  section("Sizes",
          fmt::format("CPU ms by stage, threads: {}. In parentheses the power of the particles with which it has grown "
                      "since the row above.",
                      least_threads(report.runs)),
          sizes_table(sizes));
  section("Beside " + report.peer,
          fmt::format("Frames 1 to {} on one thread. CPU ms: mean over the frames, median over runs in turns. Pairs of "
                      "triangles that intersect, by exact predicates: in the frame with the most, in the last one.",
                      report.frames.end - 1),
          peer_table(report.peer_runs));
  const Table threads = threads_table(report.runs);
  if (threads.size() > sizes.size() + 1)
    section("Threads", "Wall ms by stage, CPU ms of all threads, and a hash of the positions of the last frame.",
            threads);
  section("What threads can gain",
          "Counted with one thread: the fraction of the time outside of loops that threads divide, these loops and "
          "their chunks, and at most how many times as fast so many threads are, if waiting for each other costs "
          "nothing and all chunks of a loop take equal times.",
          loops_table(report.runs));
  if (steps.size() > 1)
    section("Steps",
            fmt::format("CPU ms by stage, {} particles, threads: {}.", grouped(steps.front()->particles),
                        steps.front()->setting.threads),
            steps_table(steps));
  section("Memory",
          "Of the process at its peak; of a particle without what the process held before the scene was built.",
          memory_table(sizes));
  section("The bound of the machine",
          "What forces, preconditioner and linear solver must move, were each number moved once for each purpose, at "
          "the speed at which so many threads read as many bytes as a linear iteration moves, again and again; and "
          "the wall ms that they take. Contacts and what elements know of themselves are not counted.",
          bound_table(report.runs));
  return text + failures_text(report);
}

}  // namespace weft::bench
