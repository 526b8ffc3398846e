// Simulated laboratory tests of all named fabrics, compared with published measurements.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "film/scene/fabrics.hpp"
#include "lab/bench/fabric_tests.hpp"
#include "lab/bench/report.hpp"

namespace weft::bench {

/// Loads at which extension is measured [N/m]: three of the FAST system, and one of the KES system.
inline constexpr std::array kLoads{4.9, 19.6, 98.07, scene::kExtensionLoad};

/// Results of all tests of one fabric.
struct FabricRun {
  scene::Fabric fabric;
  /// Drape coefficients of two specimens. `drape`: solved exactly; `drape_in_scenes`: with the default tolerance
  /// (cusick::Solved).
  std::array<double, 2> drape{}, drape_in_scenes{};
  Cantilever elastic = {}, as_it_is = {};            ///< `elastic`: without bending friction; `as_it_is`: with
  std::array<double, kLoads.size()> weft{}, warp{};  ///< relative extension along weft and warp, at each load
  double cpu_s = 0;

  double mean_drape() const { return 0.5 * (drape[0] + drape[1]); }
  double mean_drape_in_scenes() const { return 0.5 * (drape_in_scenes[0] + drape_in_scenes[1]); }
};

/// Runs all tests of a fabric, with temporary files in `folder`. Throws Error(simulation_failed).
FabricRun test_fabric(const scene::Fabric& fabric, const std::filesystem::path& folder);

/// Relative deviation of the mean drape coefficient from the nearest published value; nullopt if none is published.
std::optional<double> drape_error(const FabricRun& run);

/// All values, for other programs: one row per fabric and load.
Table fabrics_table(const std::vector<FabricRun>& runs);
/// Plots of drape, bending rigidity, and force against extension.
std::string fabrics_svg(const std::vector<FabricRun>& runs);
/// The report. `plot`: name of the file with the plot, in the folder of the report.
std::string fabrics_markdown(const std::vector<FabricRun>& runs, const std::string& plot);
/// One sentence with two counts of fabrics whose drape coefficient is within 10 % of the nearest published value: of
/// all fabrics with a published drape, and of those with a published bending stiffness too.
std::string conclusion(const std::vector<FabricRun>& runs);

}  // namespace weft::bench
