// What a run is off by, told by companions: the same scene simulated otherwise.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/trajectory.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

/// By whose doing a run is off.
enum class ErrorSource { steps, solver, mesh, start };
inline constexpr std::size_t kErrorSources = 4;
std::string_view name_of(ErrorSource source);

struct ErrorPart {
  ErrorSource source;
  Errors errors{};
  std::string missing = {};  ///< why it is not known; empty where it is
};

struct ErrorEstimate {
  /// Whether paths can be compared. Where a micrometre at the start comes out as more than a third of what steps and
  /// solver leave, or as a millimetre, only functionals can.
  bool comparable = true;
  std::vector<ErrorPart> parts;
  Errors all{};      ///< root of the sum of the squares of the parts
  double cpu_s = 0;  ///< of the companions

  /// The part that is largest in what decides: the position, or the centre of mass where paths part.
  const ErrorPart& largest() const;
  Quantity deciding() const { return comparable ? Quantity::position : Quantity::centre; }
};

struct CompanionOptions {
  bool mesh = false;                   ///< whether coarser meshes are tried too
  std::function<bool()> proceed = {};  ///< asked before each frame of a companion
};

/// How far a run of the scene is from the motion that endlessly short, exactly solved steps would give, and with
/// options.mesh endlessly small cells. Companions: a start moved by a micrometre, and where that matters by more of
/// them; a tenth of solver.newton_tolerance; solved like that, twice and four times the step (time.tolerance
/// accordingly), half and a quarter of the cells. Differences are extrapolated after Richardson with the order that is
/// observed, at most that of the method. As many frames are compared as `run` has. A companion that fails is a part
/// that is missing. Throws Error(interrupted) where options.proceed says no.
ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options = {});

}  // namespace weft::bench
