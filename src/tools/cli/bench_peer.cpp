#include "tools/cli/bench_peer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "core/isolated.hpp"
#include "tools/cli/child_process.hpp"

namespace weft::cli {
namespace {

std::filesystem::path judge_program() {
  return own_program().replace_filename("weft_judge");
}

bool can_start(const std::filesystem::path& program) {
  std::error_code none;
  return std::filesystem::is_regular_file(program, none) && ::access(program.c_str(), X_OK) == 0;
}

/// Runs a program and returns its standard output. `max_exit_code`: largest exit code that is no failure. A process in
/// between is killed once `stop` is true; the kernel then kills the program.
std::string output_of(const std::vector<std::string>& command, int max_exit_code, const std::atomic<bool>& stop) {
  const auto work = [&] {
    ProcessResult result = run_process(command);
    if (result.exit_code > max_exit_code)
      throw std::runtime_error(fmt::format("{} ended with exit code {}", command[0], result.exit_code));
    return std::move(result.output);
  };
  return run_isolated(work, {.name = command[0], .stop = &stop});
}

}  // namespace

void check_peer(const std::filesystem::path& peer) {
  if (!can_start(peer))
    throw Error(ExitCode::usage,
                "--peer: expected a program that can be started, such as build/bin/bench_bullet, got {}",
                peer.string());
  if (!can_start(judge_program()))
    throw Error(ExitCode::usage,
                "--peer: expected {}, which counts intersecting pairs; build it with ninja -C build weft_judge",
                judge_program().string());
}

double run_peer(const std::filesystem::path& peer, const std::vector<std::string>& arguments,
                const std::atomic<bool>& stop) {
  std::vector<std::string> command{std::filesystem::absolute(peer).string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const std::string output = output_of(command, 0, stop);
  static const std::regex kCost(R"(([0-9]+(\.[0-9]+)?) CPU ms a frame)");
  std::smatch cost;
  if (!std::regex_search(output, cost, kCost))
    throw std::runtime_error(fmt::format("{}: expected its cost, such as \"12.3 CPU ms a frame\", got \"{}\"",
                                         command[0], output.substr(0, output.find('\n'))));
  return std::stod(cost.str(1));
}

bench::FramePairs count_pairs(const std::filesystem::path& meshes, const scene::Scene& scene, int end,
                              const std::atomic<bool>& stop) {
  std::vector<std::string> command{judge_program().string(), meshes.string(), "--frames", fmt::format("0:{}", end)};
  for (const scene::Obstacle& obstacle : scene.obstacles) command.insert(command.end(), {"--obstacle", obstacle.name});
  for (const scene::Character& character : scene.characters)
    command.insert(command.end(), {"--obstacle", character.name});
  const std::string output = output_of(command, 1, stop);  // 1: some pairs intersect
  static const std::regex kFrame(R"(frame [0-9]+: ([0-9]+) intersecting pairs)");
  bench::FramePairs pairs;
  int frames = 0;
  for (std::sregex_iterator match(output.begin(), output.end(), kFrame), none; match != none; ++match, ++frames) {
    pairs.last = std::stol(match->str(1));
    pairs.worst = std::max(pairs.worst, pairs.last);
  }
  if (frames != end)
    throw std::runtime_error(fmt::format("expected meshes of frames 0 to {}, got {} frames", end - 1, frames));
  return pairs;
}

}  // namespace weft::cli
