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
  /// A micrometre at the start comes out as more than a third of what steps and solver leave, or as a millimetre.
  bool start_matters = false;
  /// Twice the step changes the run by too little beside what half of it does, or fails: errors do not fall as the
  /// method says.
  bool steps_irregular = false;
  std::vector<ErrorPart> parts;
  Errors all{};      ///< root of the sum of the squares of the parts
  double cpu_s = 0;  ///< of the companions

  /// Whether paths part: then the run is off by at least what is told.
  bool doubtful() const { return start_matters || steps_irregular; }
  /// The part that is largest in the position.
  const ErrorPart& largest() const;
};

struct CompanionOptions {
  bool mesh = false;                   ///< whether coarser meshes are tried too
  std::function<bool()> proceed = {};  ///< asked before each frame of a companion
};

/// How far a run of the scene is from the motion that endlessly short, exactly solved steps would give, and with
/// options.mesh endlessly small cells. Companions: a start moved by a micrometre; a tenth of solver.newton_tolerance;
/// solved like that, half and twice the step (time.tolerance accordingly), half and a quarter of the cells. Differences
/// are extrapolated after Richardson with the order that is observed, at most that of the method. As many frames are
/// compared as `run` has. A companion that fails is a part that is missing. Throws Error(interrupted) where
/// options.proceed says no.
ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options = {});

}  // namespace weft::bench
