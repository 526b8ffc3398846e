#include "simulation/saved_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "core/parallel.hpp"
#include "film/production/scene_simulation.hpp"

namespace weft::simulation::testing {
namespace {

/// All observable results of a frame.
struct FrameResults {
  std::vector<Vec3> positions, velocities;
  frame::SnapshotPtr snapshot;
  FrameReport report, initial;
};

template <class T>
bool same_bits(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

std::string figures(const FrameReport& r) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", r.frame, r.time, r.steps,
                     r.rejected_steps, r.inexact_steps, r.error_estimate, r.solver_error, r.newton_iterations,
                     r.linear_iterations, r.proximities, r.constraints, r.min_distance, r.max_strain, r.kinetic_energy,
                     r.potential_energy, r.elastic_energy, r.pinched_pairs, fmt::join(r.warnings, " | ")) +
         fmt::format("; {} {} {} {}", r.lagging_particles, r.stretch_ratio, r.pin_work, r.solver_work);
}

bool same_picture(const frame::FrameSnapshot& a, const frame::FrameSnapshot& b) {
  const auto same = [](const frame::SurfaceState& one, const frame::SurfaceState& other) {
    return same_bits<Vec3>(one.positions, other.positions) && same_bits<float>(one.heat, other.heat);
  };
  return a.frame == b.frame && a.time == b.time && std::ranges::equal(a.states, b.states, same);
}

// Compares two frames. Returns the name of the first part that differs, or an empty string.
std::string compare(const FrameResults& expected, const FrameResults& actual) {
  if (!same_bits<Vec3>(expected.positions, actual.positions)) return "positions";
  if (!same_bits<Vec3>(expected.velocities, actual.velocities)) return "velocities";
  if (!same_picture(*expected.snapshot, *actual.snapshot)) return "what is shown";
  if (figures(expected.report) != figures(actual.report))
    return fmt::format("report\n  {}\nin place of\n  {}", figures(actual.report), figures(expected.report));
  if (figures(expected.initial) != figures(actual.initial)) return "initial report";
  return "";
}

// Advances to the next frame, which may belong to the preroll.
FrameResults next_frame(production::SceneSimulation& simulation) {
  FrameResults results;
  if (simulation.snapshot()->frame < 0) {
    int asked = 0;
    simulation.run_preroll([&] { return asked++ == 0; });
  } else {
    results.report = simulation.advance();
  }
  const ParticleState state = simulation.state();
  results.positions.assign(state.positions.begin(), state.positions.end());
  results.velocities.assign(state.velocities.begin(), state.velocities.end());
  results.snapshot = simulation.snapshot();
  results.initial = simulation.initial_report();
  return results;
}

std::string saved(const production::SceneSimulation& simulation) {
  std::string bytes;
  simulation.save(bytes);
  return bytes;
}

// Continues to the end from `state`, saved after frame k. Compares with `run`; returns the difference, or an empty
// string.
std::string continue_from_state(const scene::Scene& scene, const std::string& state, int k,
                                const std::vector<FrameResults>& run) {
  production::SceneSimulation simulation(scene);
  simulation.restore(state);
  if (saved(simulation) != state) return fmt::format("the state after frame {}, restored, is saved as another one", k);
  if (k > 0 && !same_picture(*run[k - 1].snapshot, *simulation.snapshot()))
    return fmt::format("restored after frame {}: another picture", k);
  for (auto next = static_cast<std::size_t>(k); next < run.size(); ++next)
    if (const std::string what = compare(run[next], next_frame(simulation)); !what.empty())
      return fmt::format("restored after frame {}, frame {}: {}", k, next + 1, what);
  return "";
}

}  // namespace

ContinuationResult continue_runs(const scene::Scene& scene, const Interruptions& interruptions) {
  ContinuationResult result;
  std::vector<FrameResults> run;
  production::SceneSimulation plain(scene), saving(scene);
  std::vector<std::string> states{saved(saving)};
  for (int k = 1; k <= interruptions.frames; ++k) {
    run.push_back(next_frame(plain));
    const FrameReport& report = run.back().report;
    result.rejected_steps += report.rejected_steps;
    result.inexact_steps += report.inexact_steps;
    result.pinched_pairs = std::max(result.pinched_pairs, report.pinched_pairs);
    result.most_proximities = std::max(result.most_proximities, report.proximities);
    if (const std::string what = compare(run.back(), next_frame(saving)); !what.empty()) {
      result.difference = fmt::format("saving changes frame {}: {}", k, what);
      return result;
    }
    states.push_back(saved(saving));
    result.largest_state = std::max(result.largest_state, states.back().size());
  }
  const int threads = thread_count();
  if (interruptions.threads_after > 0) set_thread_count(interruptions.threads_after);
  for (int k : interruptions.saved_at)
    if (result.difference.empty()) result.difference = continue_from_state(scene, states[k], k, run);
  set_thread_count(threads);
  return result;
}

}  // namespace weft::simulation::testing
