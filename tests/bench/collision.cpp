// Measures the collision heuristics and prints Markdown tables: medians of CPU milliseconds on one core.
//   bench_collision replay DIR FIRST COUNT REACH   each heuristic on frames of `weft run SCENE --meshes DIR`
//   bench_collision build                          building and refitting trees of 10³ to 10⁶ triangles
//   bench_collision ball                           a sheet wound around a ball, compared with CGAL's AABB tree
//   bench_collision distances                      GJK and the closed forms
#include <cstdlib>
#include <string>

#include "bench/measure.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const std::string what = words.empty() ? "" : words[0];
  if (what == "replay" && words.size() == 5)
    weft::bench::replay(words[1], std::stoi(words[2]), std::stoi(words[3]), std::stod(words[4]));
  else if (what == "build")
    weft::bench::build_and_refit();
  else if (what == "ball")
    weft::bench::wrapped_ball();
  else if (what == "distances")
    weft::bench::distances();
  else {
    fmt::print(stderr, "expected: replay DIR FIRST COUNT REACH | build | ball | distances\n");
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
