// Runs a peer, another program that simulates the scenes of `weft bench speed`, and counts intersecting pairs in
// meshes.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "film/scene/scene.hpp"
#include "lab/bench/speed_report.hpp"

namespace weft::cli {

/// Throws Error(usage) if `peer` cannot be started, or if weft_judge, which counts pairs, is not beside this program.
void check_peer(const std::filesystem::path& peer);

/// Runs `peer` with these arguments. Returns the CPU time of a frame that it prints, such as "12.3 CPU ms a frame"
/// [ms]. Throws std::runtime_error if the peer fails, Error(interrupted) if `stop` becomes true.
double run_peer(const std::filesystem::path& peer, const std::vector<std::string>& arguments,
                const std::atomic<bool>& stop);

/// Counts the intersecting pairs in the meshes of frames 0 to `end` - 1 of a scene. Calls weft_judge, which has exact
/// predicates and shares no code with the collision modules. Throws as run_peer() does, also if a frame is missing.
bench::FramePairs count_pairs(const std::filesystem::path& meshes, const scene::Scene& scene, int end,
                              const std::atomic<bool>& stop);

}  // namespace weft::cli
