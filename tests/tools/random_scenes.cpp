// Runs small random scenes of one sheet that falls on a body, each also turned by 90°, mirrored, and with four times
// the frame rate. Compares the differences between runs with the errors that they report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "support/scene_runs.hpp"

namespace {

using weft::Vec3;
using weft::scene::Scene;
using weft::support::MeasuredFrame;
using Positions = std::vector<Vec3>;

constexpr int kFrames = 16;  // 0.6 s, including the impact

double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

weft::Quat turn(double angle, const Vec3& axis) {
  return weft::Quat(Eigen::AngleAxisd(angle, axis));
}

Scene random_scene(unsigned number, std::string& name) {
  std::mt19937 random(number);
  const char* const fabric = random() % 2 == 0 ? "silk" : "denim";
  const int particles = random() % 2 == 0 ? 15 : 23;
  const unsigned shape = random() % 3;
  const char* const bodies[] = {"shape = \"sphere\"\nradius = 0.15", "shape = \"box\"\nsize = [0.25, 0.25, 0.3]",
                                "shape = \"cone\"\nradius = 0.18\nheight = 0.3"};
  const char* const names[] = {"sphere", "box", "cone"};
  name = fmt::format("{} {} {}", fabric, particles, names[shape]);
  Scene scene = weft::support::scene_of_text(
      fmt::format("[time]\nduration = {}\n[[cloth]]\nname = \"sheet\"\nsize = [0.5, 0.5]\nparticles = {}\nmaterial = "
                  "{{ fabric = \"{}\" }}\n[[obstacle]]\nname = \"body\"\n{}\n",
                  (kFrames - 1) / 25.0, particles, fabric, bodies[shape]));
  const double tilt = uniform(random, 0, 0.6), yaw = uniform(random, 0, 2 * std::numbers::pi);
  scene.cloths[0].pose.rotation = turn(yaw, Vec3::UnitZ()) * turn(tilt, Vec3::UnitX()) *
                                  turn(uniform(random, 0, 2 * std::numbers::pi), Vec3::UnitZ());
  scene.cloths[0].pose.position = {uniform(random, -0.08, 0.08), uniform(random, -0.08, 0.08),
                                   0.22 + 0.25 * std::sin(tilt)};
  scene.obstacles[0].pose.rotation = turn(uniform(random, 0, 1), Vec3::UnitZ());
  return scene;
}

void turn_by_90(weft::scene::Pose& pose) {
  const weft::Quat quarter = turn(0.5 * std::numbers::pi, Vec3::UnitZ());
  pose = {quarter * pose.position, quarter * pose.rotation};
}

void mirror(weft::scene::Pose& pose) {
  pose.position.y() = -pose.position.y();
  pose.rotation = {pose.rotation.w(), -pose.rotation.x(), pose.rotation.y(), -pose.rotation.z()};
}

double rms_apart(const Positions& a, const Positions& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Run {
  double steps = 0, solver = 0;  // errors of the time steps and of the solver, summed over the frames [m]
  int rejected = 0, taken = 0, newton = 0;
  double stretch = 1;
  std::size_t pairs = 0;
  Positions last;
};

Run run(const Scene& scene) {
  Run result;
  weft::support::run_scene(scene, {}, [&](const MeasuredFrame& frame) {
    result.steps += frame.report.error_estimate;
    result.solver += frame.report.solver_error;
    result.rejected += frame.report.rejected_steps;
    result.taken += frame.report.steps;
    result.newton += frame.report.newton_iterations;
    result.stretch = std::max(result.stretch, frame.max_stretch);
    result.pairs += frame.pairs;
    if (!frame.cloths.empty()) result.last = frame.cloths[0];
  });
  return result;
}

void print_row(const char* what, std::vector<double> values) {
  std::ranges::sort(values);
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} |\n", what, values.front(), values[values.size() / 2], values.back());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs small random scenes as they are, turned, mirrored and with more frames; prints what differs.");
  unsigned first = 1, count = 200;
  app.add_option("--first", first, "number of the first scene");
  app.add_option("--count", count, "scenes");
  CLI11_PARSE(app, argc, argv);
  weft::set_thread_count(1);
  fmt::print("{:>4} {:18} {:>9} {:>9} {:>6} {:>9} {:>9} {:>9} {:>3} {:>6} {:>7} {:>5}\n", "", "scene", "steps mm",
             "solver mm", "ratio", "turned", "mirrored", "fps x4", "rej", "newton", "stretch", "pairs");
  int loose = 0, apart = 0, all_rejected = 0;
  std::vector<double> ratios, farthest, iterations, stretches;
  int all_farther = 0;
  std::size_t all_pairs = 0;
  long all_newton = 0, all_taken = 0;
  for (unsigned number = first; number < first + count; ++number) {
    std::string name;
    const Scene scene = random_scene(number, name);
    Scene turned = scene, mirrored = scene, finer = scene;
    turn_by_90(turned.cloths[0].pose), turn_by_90(turned.obstacles[0].pose);
    mirror(mirrored.cloths[0].pose), mirror(mirrored.obstacles[0].pose);
    finer.time.fps = 4 * scene.time.fps;
    const Run base = run(scene), as_turned = run(turned), as_mirrored = run(mirrored), as_finer = run(finer);
    Positions back = as_turned.last;
    for (Vec3& x : back) x = turn(-0.5 * std::numbers::pi, Vec3::UnitZ()) * x;
    Positions flipped;
    const int n = scene.cloths[0].particles_weft;
    for (int j = n - 1; j >= 0; --j)
      for (int i = 0; i < n; ++i) {
        const Vec3& x = as_mirrored.last[static_cast<std::size_t>(j * n + i)];
        flipped.emplace_back(x.x(), -x.y(), x.z());
      }
    const double differences[] = {rms_apart(base.last, back), rms_apart(base.last, flipped),
                                  rms_apart(base.last, as_finer.last)};
    const bool is_apart = *std::ranges::max_element(differences) > base.steps + base.solver;
    ratios.push_back(base.solver / base.steps);
    farthest.push_back(std::max(differences[0], differences[1]) / (base.steps + base.solver));
    iterations.push_back(static_cast<double>(base.newton) / base.taken);
    stretches.push_back(base.stretch);
    all_farther += differences[2] > 0;
    loose += base.solver > base.steps;
    apart += is_apart;
    all_pairs += base.pairs, all_rejected += base.rejected, all_newton += base.newton, all_taken += base.taken;
    fmt::print("{:4} {:18} {:9.3f} {:9.3f} {:6.2f} {:9.3f} {:9.3f} {:9.3f} {:3} {:6.2f} {:7.3f} {:5}{}\n", number, name,
               1e3 * base.steps, 1e3 * base.solver, base.solver / base.steps, 1e3 * differences[0],
               1e3 * differences[1], 1e3 * differences[2], base.rejected, static_cast<double>(base.newton) / base.taken,
               base.stretch, base.pairs,
               base.solver > base.steps ? " LOOSE"
               : is_apart               ? " APART"
                                        : "");
    std::fflush(stdout);
  }
  fmt::print("\n| of {} scenes | least | median | largest |\n|---|---|---|---|\n", count);
  print_row("solver error over step error", ratios);
  print_row("Newton iterations a step", iterations);
  print_row("longest thread", stretches);
  print_row("turned or mirrored: distance at the end over both errors", farthest);
  fmt::print(
      "\nSolver error beyond step error in {}; turned or mirrored farther apart than both errors in {}; other bits "
      "with "
      "four times the frames in {}; {} pairs, {} rejected steps, {:.2f} Newton iterations a step.\n",
      loose, apart, all_farther, all_pairs, all_rejected,
      static_cast<double>(all_newton) / static_cast<double>(all_taken));
}
