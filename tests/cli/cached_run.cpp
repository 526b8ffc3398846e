#include "cli/cached_run.hpp"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <memory>

#include "film/cache/reader.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// The cloth has contacts, friction and heat from about frame 6 on; the camera is computed.
constexpr const char* kFallOnBall = R"(
[time]
duration = 0.8
fps = 25
step = 0.02

[render]
heat = "strain"

[[cloth]]
name = "cloth"
size = [0.5, 0.5]
particles = [15, 15]
position = [0, 0, 0.4]

[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 8
keys = [{ time = 0, position = [0, 0, 0] }, { time = 0.8, position = [0.1, 0, 0] }]

[[obstacle]]
name = "floor"
shape = "plane"
position = [0, 0, -0.1]
)";

}  // namespace

void CachedRun::SetUp() {
  support::TestFolder::SetUp();
  support::write_bytes(folder_ / "s.toml", kFallOnBall);
}

Outcome CachedRun::weft(const Arguments& arguments) const {
  return run_weft(joined(arguments, kSmall), folder_);
}

void CachedRun::expect_well(const Arguments& arguments) const {
  expect_exit(weft(arguments), 0);
}

std::map<std::string, std::string> CachedRun::contents(const std::string& folder, const std::string& ending) const {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder_ / folder))
    if (entry.path().extension() == ending)
      contents[entry.path().filename().string()] = support::read_bytes(entry.path());
  return contents;
}

void CachedRun::expect_same(const std::string& a, const std::string& b, const std::string& ending,
                            std::size_t count) const {
  const auto first = contents(a, ending), second = contents(b, ending);
  EXPECT_EQ(first.size(), count);
  EXPECT_EQ(second.size(), count);
  for (const auto& [name, bytes] : first) {
    ASSERT_TRUE(second.contains(name)) << name;
    EXPECT_TRUE(second.at(name) == bytes) << name << " of " << a << " and " << b << " differ";
  }
}

std::string CachedRun::decoded(const std::string& video) const {
  const std::string command = "ffmpeg -v error -i '" + (folder_ / video).string() + "' -f framemd5 - 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> line;
  while (pipe && std::fgets(line.data(), line.size(), pipe.get()) != nullptr)
    if (line[0] != '#') text += line.data();
  EXPECT_FALSE(text.empty()) << video;
  return text;
}

std::uint64_t CachedRun::hash_of_frames(const std::string& cache, int count) const {
  const cache::Reader reader(folder_ / cache);
  EXPECT_EQ(reader.frames().size(), static_cast<std::size_t>(count));
  std::uint64_t hash = 0;
  const auto add = [&](const auto& list) {
    hash = XXH3_64bits_withSeed(list.data(), list.size() * sizeof list[0], hash);
  };
  for (const int frame : reader.frames()) {
    const cache::CachedFrame cached = reader.read(frame);
    for (const frame::SurfaceState& state : cached.snapshot->states) {
      add(state.positions);
      add(state.heat);
    }
    const simulation::FrameReport& r = cached.report;
    add(std::array<double, 9>{r.error_estimate, r.solver_error, r.min_distance, r.max_strain, r.kinetic_energy,
                              r.potential_energy, r.elastic_energy, r.pin_work, r.solver_work});
    add(std::array<int, 8>{r.frame, r.steps, r.rejected_steps, r.newton_iterations, r.linear_iterations, r.proximities,
                           r.constraints, r.pinched_pairs});
  }
  return hash;
}

}  // namespace weft::cli
