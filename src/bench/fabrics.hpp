// All named fabrics in the tests of the laboratory, against what was published of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/fabric_tests.hpp"
#include "bench/report.hpp"
#include "scene/fabrics.hpp"

namespace weft::bench {

/// Loads at which extension is measured [N/m]: FAST's three, and KES'.
inline constexpr std::array kLoads{4.9, 19.6, 98.07, scene::kExtensionLoad};

struct FabricRun {
  scene::Fabric fabric;
  std::array<double, 2> drape{}, drape_in_scenes{};  ///< of two specimens, solved exactly and as in scenes [1]
  Cantilever elastic = {}, as_it_is = {};            ///< without its friction of bending, and with
  std::array<double, kLoads.size()> weft{}, warp{};  ///< extensions [1]
  double cpu_s = 0;

  double mean_drape() const { return 0.5 * (drape[0] + drape[1]); }
  double mean_drape_in_scenes() const { return 0.5 * (drape_in_scenes[0] + drape_in_scenes[1]); }
};

/// `folder`: where the specimens may be written meanwhile. Throws Error(simulation_failed).
FabricRun test_fabric(const scene::Fabric& fabric, const std::filesystem::path& folder);

/// How far a drape coefficient is off the published ones, relative to the nearest [1]; none: nothing is published.
std::optional<double> drape_error(const FabricRun& run);

/// All figures, for other programs.
Table fabrics_table(const std::vector<FabricRun>& runs);
/// Drape, rigidity and force against extension.
std::string fabrics_svg(const std::vector<FabricRun>& runs);
/// The report; the plot is expected beside it under this name.
std::string fabrics_markdown(const std::vector<FabricRun>& runs, const std::string& plot);
/// One sentence computed from the runs: how many are within 10 % of what was published.
std::string conclusion(const std::vector<FabricRun>& runs);

}  // namespace weft::bench
