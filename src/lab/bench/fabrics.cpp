#include "lab/bench/fabrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "lab/bench/plot.hpp"
#include "lab/bench/report.hpp"

namespace weft::bench {
namespace {

// The value in a unit as text, such as "12.3"; "~12.3" if it is estimated. `unit`: factor from SI units.
std::string text_of(const scene::MeasuredValue& figure, double unit) {
  return fmt::format("{}{:.3g}", figure.estimated ? "~" : "", figure.value * unit);
}

std::string published_drape(const scene::Measurements& m) {
  if (!m.drape) return "";
  const auto [low, high] = *m.drape;
  return low == high ? fmt::format("{:.1f}", 100 * low) : fmt::format("{:.0f} to {:.0f}", 100 * low, 100 * high);
}

std::string percent(double share) {
  return fmt::format("{:.1f}", 100 * share);
}

Table summary(const std::vector<FabricRun>& runs) {
  Table table{{"fabric", "drape %, published", "ours", "off %", "in scenes", "B µN·m, given", "cantilever, elastic",
               "as it is", "bending length mm", "extension at 490 N/m %, given weft, warp", "ours"}};
  for (const FabricRun& run : runs) {
    const scene::Measurements& m = run.fabric.measured;
    const std::optional<double> error = drape_error(run);
    const scene::MeasuredValue bend{run.fabric.material.bend, m.bend_weft.estimated};
    table.push_back({run.fabric.material.fabric, published_drape(m), percent(run.mean_drape()),
                     error ? fmt::format("{:+.0f}", 100 * *error) : "", percent(run.mean_drape_in_scenes()),
                     text_of(bend, 1e6), fmt::format("{:.3g}", 1e6 * run.elastic.rigidity),
                     fmt::format("{:.3g}", 1e6 * run.as_it_is.rigidity),
                     fmt::format("{:.1f}", 1e3 * run.as_it_is.bending_length),
                     text_of(m.extension_weft, 100) + ", " + text_of(m.extension_warp, 100),
                     percent(run.weft.back()) + ", " + percent(run.warp.back())});
  }
  return table;
}

// The diagonal, and lines 10 % below and above it.
void add_diagonal(Panel& panel, double low, double high) {
  for (double factor : {1.0, 0.9, 1.1})
    panel.curves.push_back({factor == 1  ? "equal"
                            : factor < 1 ? "off by 10 %"
                                         : "",
                            factor == 1 ? "#666666" : "#bbbbbb",
                            Marker::circle,
                            factor != 1,
                            {Vec2(low, factor * low), Vec2(high, factor * high)}});
}

std::string color_of(std::size_t index, std::size_t count) {
  return fmt::format("hsl({:.0f},70%,42%)", 360.0 * static_cast<double>(index) / static_cast<double>(count));
}

}  // namespace

FabricRun test_fabric(const scene::Fabric& fabric, const std::filesystem::path& folder) {
  constexpr int kRings = 14;
  const double cpu_start = process_cpu_seconds();
  FabricRun run{.fabric = fabric};
  const TemporaryName specimens(folder / "specimens", TemporaryName::Kind::folder);
  const std::filesystem::path file = specimens.path() / "disc.obj";
  for (int seed : {1, 2}) {
    const cusick::Specimen disc = cusick::rings(kRings, seed);
    const scene::Scene scene = cusick::scene_of(disc, fabric.material, file);
    const auto at = static_cast<std::size_t>(seed - 1);
    run.drape[at] = cusick::drape(scene, disc.triangles).coefficient;
    run.drape_in_scenes[at] = cusick::drape(scene, disc.triangles, cusick::Solved::with_default_tolerance).coefficient;
  }
  scene::Material elastic = fabric.material;
  elastic.bend_friction = 0;
  run.elastic = cantilever(elastic);
  run.as_it_is = cantilever(fabric.material);
  for (std::size_t k = 0; k < kLoads.size(); ++k) {
    run.weft[k] = extension(fabric.material, Direction::weft, kLoads[k]);
    run.warp[k] = extension(fabric.material, Direction::warp, kLoads[k]);
  }
  run.cpu_s = process_cpu_seconds() - cpu_start;
  return run;
}

std::optional<double> drape_error(const FabricRun& run) {
  if (!run.fabric.measured.drape) return std::nullopt;
  const auto [low, high] = *run.fabric.measured.drape;
  const double ours = run.mean_drape();
  return ours / std::clamp(ours, low, high) - 1;
}

Table fabrics_table(const std::vector<FabricRun>& runs) {
  Table table{{"fabric",         "density_kg_per_m2", "drape_published_low", "drape_published_high",
               "drape_1",        "drape_2",           "drape_in_scenes_1",   "drape_in_scenes_2",
               "bend_n_m",       "bend_estimated",    "hysteresis_per_m",    "cantilever_elastic_n_m",
               "cantilever_n_m", "bending_length_m",  "load_n_per_m",        "extension_weft",
               "extension_warp", "published_weft",    "published_warp",      "cpu_s"}};
  for (const FabricRun& run : runs) {
    const scene::Measurements& m = run.fabric.measured;
    for (std::size_t k = 0; k < kLoads.size(); ++k) {
      const bool published = k + 1 == kLoads.size();
      table.push_back({run.fabric.material.fabric,
                       fmt::format("{:g}", m.density.value),
                       m.drape ? fmt::format("{:g}", m.drape->first) : "",
                       m.drape ? fmt::format("{:g}", m.drape->second) : "",
                       fmt::format("{:.4f}", run.drape[0]),
                       fmt::format("{:.4f}", run.drape[1]),
                       fmt::format("{:.4f}", run.drape_in_scenes[0]),
                       fmt::format("{:.4f}", run.drape_in_scenes[1]),
                       fmt::format("{:g}", run.fabric.material.bend),
                       m.bend_weft.estimated ? "true" : "false",
                       fmt::format("{:g}", m.hysteresis.value),
                       fmt::format("{:.4g}", run.elastic.rigidity),
                       fmt::format("{:.4g}", run.as_it_is.rigidity),
                       fmt::format("{:.4g}", run.as_it_is.bending_length),
                       fmt::format("{:g}", kLoads[k]),
                       fmt::format("{:.5f}", run.weft[k]),
                       fmt::format("{:.5f}", run.warp[k]),
                       published ? fmt::format("{:g}", m.extension_weft.value) : "",
                       published ? fmt::format("{:g}", m.extension_warp.value) : "",
                       fmt::format("{:.2f}", run.cpu_s)});
    }
  }
  return table;
}

std::string fabrics_svg(const std::vector<FabricRun>& runs) {
  Panel drape{"Drape coefficient", "published [%]", "ours [%]", {}};
  Panel bend{"Bending rigidity by the cantilever", "given [µN·m]", "found [µN·m]", {}};
  Panel tension{"Force against extension along warp", "extension [%]", "force [N/m]", {}};
  const auto markers = [](const char* name, const char* color, Marker marker) {
    return Curve{name, color, marker, false, {}, false};
  };
  Curve both = markers("bending and drape published", "#b2182b", Marker::circle);
  Curve one = markers("bending estimated", "#2166ac", Marker::square);
  Curve elastic = markers("elastic", "#1a9850", Marker::circle);
  Curve as_it_is = markers("with friction", "#d08020", Marker::triangle);
  Curve published = markers("published", "#000000", Marker::circle);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const FabricRun& run = runs[i];
    const scene::Measurements& m = run.fabric.measured;
    if (m.drape) {
      Curve& group = m.bend_weft.estimated ? one : both;
      group.points.emplace_back(50 * (m.drape->first + m.drape->second), 100 * run.mean_drape());
    }
    elastic.points.emplace_back(1e6 * run.fabric.material.bend, 1e6 * run.elastic.rigidity);
    as_it_is.points.emplace_back(1e6 * run.fabric.material.bend, 1e6 * run.as_it_is.rigidity);
    Curve curve{run.fabric.material.fabric, color_of(i, runs.size())};
    for (std::size_t k = 0; k < kLoads.size(); ++k) curve.points.emplace_back(100 * run.warp[k], kLoads[k]);
    tension.curves.push_back(curve);
    if (!m.extension_warp.estimated) published.points.emplace_back(100 * m.extension_warp.value, kLoads.back());
  }
  drape.curves = {both, one};
  bend.curves = {elastic, as_it_is};
  tension.curves.push_back(published);
  add_diagonal(drape, 20, 100);
  add_diagonal(bend, 0.5, 100);
  return log_log_svg({drape, bend, tension});
}

std::string conclusion(const std::vector<FabricRun>& runs) {
  int both = 0, of_both = 0, published = 0, of_published = 0;
  for (const FabricRun& run : runs) {
    const std::optional<double> error = drape_error(run);
    if (!error) continue;
    const bool near = std::abs(*error) <= 0.1;
    ++published, of_published += near;
    if (!run.fabric.measured.bend_weft.estimated) ++both, of_both += near;
  }
  return fmt::format(
      "{} of {} fabrics whose drape is published drape within 10 % of that, of those whose bending is too {} of {}\n",
      of_published, published, of_both, both);
}

std::string fabrics_markdown(const std::vector<FabricRun>& runs, const std::string& plot) {
  double cpu_s = 0;
  for (const FabricRun& run : runs) cpu_s += run.cpu_s;
  return fmt::format(
      "# Fabrics\n\n{}\nCusick's drape test (30 cm over 18 cm, mean of two specimens), the cantilever test (ASTM "
      "D1388) "
      "and a strip that hangs with a load of 490 N/m; {:.0f} CPU s. What is marked with ~ is estimated; \"off\" is to "
      "the nearest published figure. \"Ours\" is solved so exactly that the rest does not decide, \"in scenes\" with "
      "their newton_tolerance.\n\n![tests]({})\n\n{}",
      conclusion(runs), cpu_s, link_to(plot), markdown(summary(runs)));
}

}  // namespace weft::bench
