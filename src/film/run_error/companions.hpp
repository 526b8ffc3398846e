// Error estimate of a run from companions: the same scene, simulated with other settings.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "film/run_error/trajectory.hpp"
#include "film/scene/scene.hpp"

namespace weft::run_error {

/// The cause of an error.
enum class ErrorSource { steps, solver, mesh, start };
inline constexpr std::size_t kErrorSources = 4;
std::string_view name_of(ErrorSource source);

struct ErrorPart {
  ErrorSource source;
  Errors errors{};
  std::string missing = {};  ///< why the error is not known; empty if it is
};

struct ErrorEstimate {
  /// The motion is chaotic: random offsets of the particles at the start, of up to 1 µm, change positions by more than
  /// 0.3 of the step and solver errors. This limit is at least 10 µm and at most 1 mm. Also true if the run with these
  /// offsets fails.
  bool start_matters = false;
  /// The error does not follow the order of the method: the run with twice the step fails, or differs from the run too
  /// little in relation to the run with half the step.
  bool steps_irregular = false;
  std::vector<ErrorPart> parts;
  Errors all{};      ///< root of the sum of squares of the parts
  double cpu_s = 0;  ///< CPU time of all companions

  /// Whether the estimate is only a lower bound: the motion is chaotic, or the step error does not follow the order.
  bool is_lower_bound() const { return start_matters || steps_irregular; }
  /// The part with the largest error in position.
  const ErrorPart& largest() const;
};

struct CompanionOptions {
  bool mesh = false;                   ///< whether coarser meshes are simulated too
  std::function<bool()> proceed = {};  ///< called before each frame of a companion; false: interrupt
};

/// Estimates the distance of a run from the limit of infinitely short, exactly solved steps, and with options.mesh of
/// infinitely small cells. Companions: particles moved at random by up to a micrometre at the start; a tenth of
/// solver.newton_tolerance; and, with that tolerance, half and twice the step (time.tolerance accordingly), and half
/// and a quarter of the cells along each side. A fixed step as long as a frame is not doubled, and cells are quartered
/// only if four remain along each side. Differences between steps and between meshes are extrapolated by Richardson's
/// method with the observed order, clamped to between 0.5 and 1 times the expected order; with only one companion, with
/// 0.75 times the expected order. Only the frames in `run` are compared. If a companion other than that with twice the
/// step fails, its part is marked as missing. Throws Error(usage) if the scene has neither cloth nor ropes, and
/// Error(interrupted) if options.proceed returns false.
ErrorEstimate estimate_error(const scene::Scene& scene, Trajectory run, const CompanionOptions& options = {});

}  // namespace weft::run_error
