// Estimates the error of a run from companions: runs of the same scene with other settings.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "film/run_error/trajectory.hpp"
#include "film/scene/scene.hpp"

namespace weft::run_error {

/// Causes of an error. start: start positions that differ by up to 1 µm.
enum class ErrorSource { steps, solver, mesh, start };
inline constexpr std::size_t kErrorSources = 4;
std::string_view name_of(ErrorSource source);

/// The error due to one source.
struct ErrorPart {
  ErrorSource source;
  Errors errors{};
  std::string missing = {};  ///< why `errors` are not known; empty if they are
};

struct ErrorEstimate {
  /// The motion is chaotic: the companion for ErrorSource::start fails, or its difference in position to the run
  /// exceeds a limit. The limit is 0.3 of the step and solver errors (root of the sum of squares), but at least 10 µm
  /// and at most 1 mm.
  bool is_chaotic = false;
  /// The step error does not follow the order of the method: the companion with twice the step fails, or its difference
  /// to the run is too small compared with that of the companion with half the step.
  bool steps_irregular = false;
  std::vector<ErrorPart> parts;
  Errors all{};  ///< root of the sum of squares over all parts; unknown errors count as 0
  /// CPU time of all companions that have not failed [s].
  double cpu_s = 0;

  /// Whether the known errors are only lower bounds, because is_chaotic or steps_irregular is true, or because the
  /// errors of a part are not known.
  bool is_lower_bound() const;
  /// The part with the largest error in position.
  const ErrorPart& largest() const;
};

struct CompanionOptions {
  bool mesh = false;                   ///< whether to estimate the error of the mesh, too, from coarser meshes
  std::function<bool()> proceed = {};  ///< called before each frame of a companion; false: interrupt
};

/// Estimates the difference of a run to the limit of infinitely short, exactly solved steps; with options.mesh, also of
/// infinitely small cells. Simulates these companions:
/// - start: particles displaced at random by up to 1 µm along each axis at the start,
/// - solver: a tenth of solver.newton_tolerance; unless this companion fails, the companions below use this tolerance,
///   too, and are compared with this companion,
/// - steps: half of the step, and about twice the step unless a step is as long as a frame; if the scene has
///   time.tolerance, the tolerances that halve and double the steps,
/// - mesh: half of the cells along each side, and a quarter if this leaves whole numbers of cells, at least four.
/// Richardson extrapolation gives the errors of steps and mesh. It uses the observed order, limited to 0.5 to 1 times
/// the expected order; if a source has only one companion, 0.75 times the expected order. Only the frames in `run` are
/// compared. If a companion fails (except the one with twice the step), ErrorPart::missing gives the reason. Throws
/// Error(usage) if the scene has neither cloth nor ropes, and Error(interrupted) if options.proceed returns false.
ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options = {});

}  // namespace weft::run_error
