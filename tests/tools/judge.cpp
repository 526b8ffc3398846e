// weft_judge: counts the intersecting triangles of the meshes that `weft run --meshes DIR` wrote.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/intersections.hpp"
#include "support/ply.hpp"

namespace {

using namespace weft;

struct Request {
  std::filesystem::path folder;
  std::vector<std::string> obstacles;
  int begin = 0, end = std::numeric_limits<int>::max();  // range of frames, end excluded
  bool list = false;                                     // whether to print each pair of faces
};

// Files by frame and object name.
using Frames = std::map<int, std::map<std::string, std::filesystem::path>>;

Frames find_frames(const Request& request) {
  static const std::regex kName("(.+)_([0-9]{5,9})\\.ply");
  Frames frames;
  for (const auto& entry : std::filesystem::directory_iterator(request.folder)) {
    const std::string name = entry.path().filename().string();
    std::smatch match;
    if (!std::regex_match(name, match, kName)) continue;
    const int frame = std::stoi(match[2]);
    if (frame >= request.begin && frame < request.end) frames[frame][match[1]] = entry.path();
  }
  if (frames.empty()) throw std::runtime_error(request.folder.string() + ": no <object>_<frame>.ply of these frames");
  return frames;
}

// Checks the files: a missing file would hide intersections, and a misspelt obstacle would be judged as cloth.
void check_complete(const Frames& frames, const Request& request) {
  const auto& first = frames.begin()->second;
  for (const auto& [frame, files] : frames) {
    const bool same = std::equal(files.begin(), files.end(), first.begin(), first.end(),
                                 [](const auto& a, const auto& b) { return a.first == b.first; });
    if (!same) throw std::runtime_error("frame " + std::to_string(frame) + " has other objects than the first frame");
  }
  for (const std::string& name : request.obstacles) {
    if (!first.contains(name)) throw std::runtime_error("--obstacle " + name + ": there is no such object");
  }
}

// Prints the intersections of one frame; returns its number of pairs.
std::size_t print_intersections(int frame, const std::map<std::string, std::filesystem::path>& files,
                                const Request& request) {
  std::vector<support::PlyMesh> meshes;
  for (const auto& [name, file] : files) meshes.push_back(support::read_ply(file));
  std::vector<support::TestedObject> objects;
  for (const auto& [name, file] : files) {
    const bool is_obstacle = std::count(request.obstacles.begin(), request.obstacles.end(), name) > 0;
    const support::PlyMesh& mesh = meshes[objects.size()];
    const auto met = std::span(mesh.triangles).first(mesh.triangles.size() - mesh.passed_through);
    objects.push_back({name, !is_obstacle, mesh.positions, met});
  }
  const support::Intersections intersections = support::find_intersections(objects);
  std::printf("frame %d: %zu intersecting pairs", frame, intersections.pairs.size());
  for (const auto& [a, b, count] : support::count_by_objects(intersections, objects)) {
    std::printf(", %s-%s %zu", a.c_str(), b.c_str(), count);
  }
  if (!intersections.degenerate.empty())
    std::printf(" (%zu faces without area left out)", intersections.degenerate.size());
  std::printf("\n");
  if (request.list) {
    for (const auto& [a, b] : intersections.pairs) {
      std::printf("  %s face %d, %s face %d\n", objects[a.object].name.c_str(), a.face, objects[b.object].name.c_str(),
                  b.face);
    }
  }
  return intersections.pairs.size();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Counts intersecting triangles of cloth with itself, other cloth and obstacles; touching counts. Faces that "
      "cloth\n"
      "passes through, as files say, are left out.\n"
      "Exit code 0: none, 1: some, 2: the meshes cannot be judged.");
  Request request;
  std::string range;
  app.add_option("DIR", request.folder, "folder of <object>_<frame>.ply files")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--frames", range, "A:B, half-open")->check([](const std::string& text) {
    return std::regex_match(text, std::regex("[0-9]{1,9}:[0-9]{1,9}")) ? "" : "expected A:B, such as 0:126";
  });
  app.add_option("--obstacle", request.obstacles, "an object that is no cloth; repeatable")->expected(1)->take_all();
  app.add_flag("--list", request.list, "print each pair of faces");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!range.empty()) std::sscanf(range.c_str(), "%d:%d", &request.begin, &request.end);
    const Frames frames = find_frames(request);
    check_complete(frames, request);
    std::size_t total = 0;
    for (const auto& [frame, files] : frames) total += print_intersections(frame, files, request);
    std::printf("%zu frames: %zu intersecting pairs\n", frames.size(), total);
    return total == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft_judge: %s\n", error.what());
    return 2;
  }
}
