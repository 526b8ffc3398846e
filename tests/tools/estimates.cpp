// Compares the error that runs report (weft run --error) with their true error, for twelve scenes, three integrators
// and five step lengths. `weft_estimates DIR` writes estimates.md, estimates.csv and estimates.svg to DIR.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/temporary_file.hpp"
#include "film/run_error/companions.hpp"
#include "film/scene/loader.hpp"
#include "lab/bench/accuracy.hpp"
#include "lab/bench/plot.hpp"
#include "lab/bench/report.hpp"
#include "physics/simulation/collision_stage.hpp"

namespace weft::bench {
namespace {

using namespace run_error;

constexpr double kSteps[] = {0.04, 0.02, 0.01, 0.005, 0.0025};  // [s]
// Reference runs use an eighth of the shortest step, and a tenth of newton_tolerance.
constexpr double kReferenceStepDivisor = 8, kReferenceNewtonRatio = 0.1;
constexpr double kShift = 1e-6;  // start noise of the second half of the reference runs [m]
constexpr double kFactor = 3;    // goal: estimates are within this factor of the true error

struct Case {
  const char *name, *cloth, *rest;
};
constexpr const char* kFree = "[contact]\nself = false\nobstacles = false\n";
// A soft material that is none of the named fabrics.
constexpr const char* kSoft =
    "material = { density = 0.2, stretch = 200, max_stretch = 0, shear = 60, bend = 1e-3, bend_viscosity = 5e-6, "
    "stretch_viscosity = 0.2, shear_viscosity = 0.1, bend_friction = 0 }\n";
constexpr const char* kBall = "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.15\n";
const Case kCases[] = {
    {"swing from two corners",
     "rotation = [45, 0, 0]\n[[cloth.pin]]\nlow = [0, 1]\nhigh = [0.2, 1]\n"
     "[[cloth.pin]]\nlow = [0.8, 1]\nhigh = [1, 1]\n",
     kFree},
    {"swing from one corner", "[[cloth.pin]]\nlow = [0, 1]\nhigh = [0, 1]\n", kFree},
    {"cantilever let go", "[[cloth.pin]]\nlow = [0, 0]\nhigh = [0.1, 1]\n", kFree},
    {"stretched by a tenth", "start_scale = 1.1\n", kFree},
    {"thrown through air", "rotation = [50, 20, 0]\nvelocity = [1, 0, 2]\nstart_noise = 2e-3\n", kFree},
    {"flag in the wind", "rotation = [90, 0, 0]\n[[cloth.pin]]\nlow = [0, 0]\nhigh = [0, 1]\n",
     "[contact]\nself = false\nobstacles = false\n[physics]\nwind = [3, 1, 0]\n"},
    {"falls on a ball", "position = [0.01, 0.02, 0.17]\n", kBall},
    {"falls on a floor", "position = [0, 0, 0.15]\nrotation = [20, 10, 0]\n",
     "[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\n"},
    {"slides down a slope", "position = [0, 0, 0.004]\nrotation = [30, 0, 0]\n",
     "[[obstacle]]\nname = \"slope\"\nshape = \"plane\"\nrotation = [30, 0, 0]\n"},
    {"falls over an edge", "position = [0.15, 0, 0.12]\n",
     "[[obstacle]]\nname = \"box\"\nshape = \"box\"\nsize = [0.4, 0.6, 0.2]\n"},
    {"a sheet on a sheet", "position = [0, 0, 0.03]\n",
     "[[cloth]]\nname = \"lower\"\nsize = 0.4\nparticles = 9\nposition = [0.1, 0.05, 0]\n[[cloth.pin]]\nlow = [0, 0]\n"
     "high = [1, 0]\n[[cloth.pin]]\nlow = [0, 1]\nhigh = [1, 1]\n"},
    {"a ball pushes a sheet", "rotation = [90, 0, 0]\n[[cloth.pin]]\nlow = [0, 1]\nhigh = [1, 1]\n",
     "[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.08\ninterpolation = \"linear\"\n"
     "keys = [ { time = 0, position = [0.02, -0.15, -0.03] }, { time = 0.48, position = [0.02, 0.1, -0.03] } ]\n"},
};

scene::Scene scene_of(const Case& one) {
  const std::string text = fmt::format(
      "[time]\nduration = 0.48\nfps = 25\nstep = 0.01\n\n[[cloth]]\nname = \"sheet\"\nsize = 0.4\n"
      "particles = 9\n{}{}\n{}\n",
      kSoft, one.cloth, one.rest);
  scene::LoadResult loaded = scene::load_text(text, std::string(one.name) + ".toml");
  if (!loaded.ok()) throw Error(ExitCode::internal, "{}", loaded.describe());
  return loaded.scene;
}

/// Reference runs of the scene: both second-order methods, each from the start and from a start with noise of a
/// micrometre. If the motion is chaotic, they are samples of possible results.
std::vector<Trajectory> reference_runs_of(scene::Scene scene) {
  scene.time.step = std::end(kSteps)[-1] / kReferenceStepDivisor;
  scene.solver.newton_tolerance *= kReferenceNewtonRatio;
  std::vector<Trajectory> references;
  for (double shift : {0.0, kShift}) {
    for (scene::Cloth& cloth : scene.cloths) cloth.start_noise += shift;
    for (scene::Integrator integrator : {scene::Integrator::implicit_midpoint, scene::Integrator::bdf2}) {
      scene.time.integrator = integrator;
      references.push_back(follow(scene));
    }
  }
  return references;
}

// Root mean square of the differences between the run and each reference run [m].
double distance(const Trajectory& run, const std::vector<Trajectory>& references, Quantity quantity) {
  double sum = 0;
  for (const Trajectory& reference : references) sum += std::pow(at(compare(run, reference), quantity), 2);
  return std::sqrt(sum / static_cast<double>(references.size()));
}

struct Row {
  const char* name;
  scene::Integrator integrator;
  double step;
  std::string failure = {};
  bool is_lower_bound = false;
  // Estimated error; distance to the reference runs; distance of the first reference run to all of them [m].
  double reported = 0, actual = 0, reference_spread = 0;
  double centre_reported = 0, centre_actual = 0;
  std::array<double, kErrorSources> parts{};

  double ratio() const { return reported / actual; }
  bool near() const { return failure.empty() && ratio() > 1 / kFactor && ratio() < kFactor; }
};

Row row_of(const Case& one, scene::Scene scene, const std::vector<Trajectory>& references) {
  Row row{one.name, scene.time.integrator, scene.time.step};
  try {
    const Trajectory run = follow(scene);
    const ErrorEstimate estimate = estimate_error(scene, run);
    row.is_lower_bound = estimate.is_lower_bound();
    row.reported = at(estimate.all, Quantity::position);
    row.centre_reported = at(estimate.all, Quantity::centre);
    for (const ErrorPart& part : estimate.parts)
      row.parts[static_cast<std::size_t>(part.source)] = at(part.errors, Quantity::position);
    row.actual = distance(run, references, Quantity::position);
    row.centre_actual = distance(run, references, Quantity::centre);
    row.reference_spread = distance(references.front(), references, Quantity::position);
  } catch (const Error& error) {
    row.failure = error.what();
  }
  return row;
}

Table table_of(const std::vector<Row>& rows) {
  Table table{{"scene", "integrator", "step_ms", "doubtful", "estimate_m", "steps_m", "solver_m", "start_m", "is_m",
               "truths_apart_m", "ratio", "centre_estimate_m", "centre_is_m", "failure"}};
  for (const Row& row : rows) {
    std::vector<std::string> fields{row.name, name_of(row.integrator), fmt::format("{:g}", 1e3 * row.step)};
    if (row.failure.empty()) {
      fields.push_back(row.is_lower_bound ? "yes" : "no");
      for (double number : {row.reported, row.parts[0], row.parts[1], row.parts[3], row.actual, row.reference_spread})
        fields.push_back(fmt::format("{:.2g}", number));
      for (double number : {row.ratio(), row.centre_reported, row.centre_actual})
        fields.push_back(fmt::format("{:.2g}", number));
    }
    fields.resize(table[0].size() - 1);
    fields.push_back(row.failure);
    table.push_back(std::move(fields));
  }
  return table;
}

// Table of ratios: one row for each scene and integrator, one column for each step.
Table ratios_of(const std::vector<Row>& rows) {
  Table table{{"estimate / truth", "integrator"}};
  for (double step : kSteps) table[0].push_back(fmt::format("{:g} ms", 1e3 * step));
  for (std::size_t i = 0; i < rows.size(); i += std::size(kSteps)) {
    std::vector<std::string> fields{rows[i].name, name_of(rows[i].integrator)};
    for (std::size_t k = 0; k < std::size(kSteps); ++k) {
      const Row& row = rows[i + k];
      fields.push_back(row.failure.empty() ? fmt::format("{:.2f}{}", row.ratio(), row.is_lower_bound ? " ?" : "")
                                           : "failed");
    }
    table.push_back(std::move(fields));
  }
  return table;
}

std::string plot_of(const std::vector<Row>& rows) {
  Panel panel{"Error: what runs say and what it is", "distance to the truth [m]", "estimate of --error [m]", {}, {}};
  constexpr const char* kColors[] = {"#d55e00", "#0072b2", "#009e73"};  // Okabe and Ito
  double low = 1, high = 0;
  for (scene::Integrator integrator : kIntegrators) {
    Curve curve{name_of(integrator), kColors[static_cast<std::size_t>(integrator)], Marker::circle, false, {}, false};
    for (const Row& row : rows) {
      if (row.integrator != integrator || !row.failure.empty()) continue;
      curve.points.emplace_back(row.actual, row.reported);
      low = std::min(low, row.actual), high = std::max(high, row.actual);
    }
    panel.curves.push_back(std::move(curve));
  }
  for (double factor : {kFactor, 1.0, 1 / kFactor})
    panel.curves.push_back({fmt::format("× {:.2g}", factor),
                            "#888888",
                            Marker::square,
                            factor != 1,
                            {{low, factor * low}, {high, factor * high}}});
  return log_log_svg({panel});
}

void measure(const std::filesystem::path& folder) {
  set_thread_count(1);
  std::vector<Row> rows;
  for (const Case& one : kCases) {
    scene::Scene scene = scene_of(one);
    const std::vector<Trajectory> references = reference_runs_of(scene);
    for (scene::Integrator integrator : kIntegrators) {
      for (double step : kSteps) {
        scene.time.integrator = integrator;
        scene.time.step = step;
        rows.push_back(row_of(one, scene, references));
        std::cout << fmt::format("{}, {}, {:g} ms: {}\n", one.name, name_of(integrator), 1e3 * step,
                                 rows.back().failure.empty() ? fmt::format("{:.2f}", rows.back().ratio()) : "failed")
                  << std::flush;
      }
    }
  }
  const auto made = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.failure.empty(); });
  const auto near = std::ranges::count_if(rows, &Row::near);
  const auto doubtful_runs =
      std::ranges::count_if(rows, [](const Row& row) { return row.failure.empty() && row.is_lower_bound; });
  const auto warned = std::ranges::count_if(
      rows, [](const Row& row) { return row.failure.empty() && !row.near() && row.is_lower_bound; });
  const std::string counts = fmt::format(
      "Within a factor of {:g}: {} of {} ({} of the others say that paths part); {} say so in all; {} failed.", kFactor,
      near, made, warned, doubtful_runs, rows.size() - static_cast<std::size_t>(made));
  const std::string text = fmt::format(
      "# Estimates against truth\n\nEstimates of `weft run --error` over the distance to runs of second order with "
      "steps an eighth of the shortest. ?: the run says that paths part. {}\n\n![plot](estimates.svg)\n\n{}",
      counts, markdown(ratios_of(rows)));
  write_file(folder / "estimates.md", text);
  write_file(folder / "estimates.csv", csv(table_of(rows)));
  write_file(folder / "estimates.svg", plot_of(rows));
  std::cout << counts << "\n";
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: weft_estimates DIR\n";
    return 2;
  }
  weft::bench::measure(argv[1]);
}
