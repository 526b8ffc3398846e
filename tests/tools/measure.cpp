// weft_measure: simulates scenes without rendering and prints cost and measures of each frame. With --table, prints one
// row per scene, as Markdown.
#include "bench/measure.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "support/scene_runs.hpp"

namespace {

using weft::support::MeasuredFrame;

struct Request {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  weft::support::RunPlan plan;
  int every = 1;    // frames per printed line
  int threads = 1;  // 1, so that CPU seconds are comparable
};

void print(const MeasuredFrame& frame) {
  const auto& report = frame.report;
  std::printf("%5d %8.1f %8.1f %3d %2d %4d %5d %7d %6zu %8.4f %9.3g %9.3g %9.3g %9.2e %s %s\n", report.frame,
              1e3 * report.simulate.cpu_s, 1e3 * report.collide.cpu_s, report.steps, report.rejected_steps,
              report.newton_iterations, report.linear_iterations, report.constraints, frame.pairs, frame.max_stretch,
              frame.rms_speed, frame.largest_speed, report.kinetic_energy, report.min_distance, frame.between.c_str(),
              frame.max_stretch > 1.1 ? frame.stretched_at.c_str() : "");
  for (const std::string& text : report.warnings) std::printf("      %s\n", text.c_str());
  std::fflush(stdout);
}

// Median CPU time of the costly frames, which are those from the first near pair on [ms].
double median_after_contact_ms(const std::vector<MeasuredFrame>& frames) {
  const auto first = std::find_if(frames.begin(), frames.end(), [](const auto& f) { return f.report.proximities > 0; });
  std::vector<double> ms;
  for (auto frame = first; frame != frames.end(); ++frame) ms.push_back(1e3 * frame->report.simulate.cpu_s);
  return ms.empty() ? 0 : weft::bench::median(ms);
}

// Sums and worst values of a run.
struct Summary {
  explicit Summary(const std::vector<MeasuredFrame>& frames) {
    for (const MeasuredFrame& frame : frames) {
      simulate += frame.report.simulate.cpu_s;
      collide += frame.report.collide.cpu_s;
      forces += frame.report.forces.cpu_s;
      preconditioner += frame.report.preconditioner.cpu_s;
      linear += frame.report.linear.cpu_s;
      of_steps += frame.report.error_estimate;
      of_solver += frame.report.solver_error;
      taken += frame.report.steps;
      newton += frame.report.newton_iterations;
      linear_iterations += frame.report.linear_iterations;
      stretch = std::max(stretch, frame.max_stretch);
      pairs += frame.pairs;
      with_pairs += frame.pairs > 0;
      worst = std::max(worst, frame.pairs);
      rejected += frame.report.rejected_steps;
      pinched = std::max(pinched, frame.report.pinched_pairs);
      lagging += frame.report.lagging_particles > 0;
    }
  }
  double simulate = 0, collide = 0, stretch = 0;
  double forces = 0, preconditioner = 0, linear = 0, of_steps = 0, of_solver = 0;
  int taken = 0, newton = 0, linear_iterations = 0;
  std::size_t pairs = 0, worst = 0;
  int rejected = 0, with_pairs = 0, pinched = 0, lagging = 0;
};

constexpr const char* kTableHead =
    "| scene | particles | frames | steps | rejected | Newton a step | linear for each | solver error over step error "
    "| "
    "longest thread | pairs | CPU ms a frame | of it collisions | median after contact |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";

void print_row(const std::string& scene, const std::vector<MeasuredFrame>& frames) {
  const Summary sum(frames);
  const double steps = static_cast<double>(frames.size()) - 1;
  std::size_t particles = 0;
  for (const auto& x : frames.back().cloths) particles += x.size();
  fmt::print("| {} | {} | {} | {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.3f} | {} | {:.0f} | {:.0f} | {:.0f} |\n", scene,
             particles, frames.size(), sum.taken, sum.rejected, static_cast<double>(sum.newton) / sum.taken,
             static_cast<double>(sum.linear_iterations) / std::max(1, sum.newton), sum.of_solver / sum.of_steps,
             sum.stretch, sum.pairs, 1e3 * sum.simulate / steps, 1e3 * sum.collide / steps,
             median_after_contact_ms(frames));
  std::fflush(stdout);
}

// Heights of cloths are those of the last frame.
void print_summary(const std::vector<MeasuredFrame>& frames) {
  const Summary sum(frames);
  const double steps = static_cast<double>(frames.size()) - 1;
  std::printf(
      "%zu frames: %.1f CPU ms a frame (median after first contact %.1f), of it collisions %.1f; %d rejected steps; "
      "stretch %.4f; %zu pairs in %d frames, at most %zu; %d pinched at most; pins lag in "
      "%d frames\n",
      frames.size(), 1e3 * sum.simulate / steps, median_after_contact_ms(frames), 1e3 * sum.collide / steps,
      sum.rejected, sum.stretch, sum.pairs, sum.with_pairs, sum.worst, sum.pinched, sum.lagging);
  std::printf(
      "%d steps: %.2f Newton, %.1f linear iterations each; CPU ms a frame: forces %.1f, preconditioner %.1f, linear "
      "%.1f; "
      "solver error over that of the steps %.2f\n",
      sum.taken, static_cast<double>(sum.newton) / sum.taken, static_cast<double>(sum.linear_iterations) / sum.taken,
      1e3 * sum.forces / steps, 1e3 * sum.preconditioner / steps, 1e3 * sum.linear / steps,
      sum.of_solver / sum.of_steps);
  for (const auto& x : frames.back().cloths) {
    double mean = 0, lowest = x.front().z(), highest = lowest;
    for (const weft::Vec3& p : x) {
      mean += p.z() / static_cast<double>(x.size());
      lowest = std::min(lowest, p.z());
      highest = std::max(highest, p.z());
    }
    std::printf("  cloth: z from %.6f to %.6f, mean %.6f m\n", lowest, highest, mean);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Simulates scenes and prints figures of each frame; exit code 1 if surfaces intersect, 2 if one fails.");
  Request request;
  bool unjudged = false, table = false;
  app.add_option("SCENE", request.scenes)->required()->check(CLI::ExistingFile);
  app.add_option("--set", request.overrides, "KEY=VALUE; repeatable")->expected(1)->take_all();
  app.add_option("--end", request.plan.end, "frame after the last one");
  app.add_option("--judge-from", request.plan.intersections_from, "first frame whose intersections are counted");
  app.add_flag("--unjudged", unjudged, "counts no intersections");
  app.add_flag("--table", table, "prints a row for each scene, no frames");
  app.add_option("--every", request.every, "prints each Nth frame and those with intersections");
  app.add_option("--threads", request.threads, "0: all cores");
  CLI11_PARSE(app, argc, argv);
  request.plan.counts_intersections = !unjudged;
  weft::set_thread_count(request.threads);
  bool intersect = false;
  if (table) fmt::print("{}", kTableHead);
  try {
    for (const std::string& file : request.scenes) {
      const weft::scene::Scene scene = weft::support::scene_of(file, request.overrides);
      if (!table)
        std::printf(
            "frame   CPU ms  collide stp rj newt  line active  pairs  stretch   rms m/s   max m/s kinetic J   least "
            "m\n");
      const auto frames = weft::support::run_scene(scene, request.plan, [&](const MeasuredFrame& frame) {
        if (!table && (frame.report.frame % request.every == 0 || frame.pairs > 0)) print(frame);
      });
      table ? print_row(scene.name, frames) : print_summary(frames);
      intersect |= std::any_of(frames.begin(), frames.end(), [](const auto& frame) { return frame.pairs > 0; });
    }
    return intersect ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft_measure: %s\n", error.what());
    return 2;
  }
}
