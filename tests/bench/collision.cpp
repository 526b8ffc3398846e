// Speed of the hierarchies: CPU milliseconds (least of several runs) to build, to refit, to list all pairs of a sheet
// with itself, and to find its proximities, for each kind of bound, arity and leaf capacity.
#include <fmt/core.h>

#include "collision/hierarchy/traversal.hpp"
#include "collision/hierarchy_meshes.hpp"
#include "collision/proximity/proximities.hpp"
#include "core/timer.hpp"

namespace {

using namespace weft;
using namespace weft::collision;

constexpr double kReach = 0.003;  // [m], on a sheet of 1 m

template <class Work>
double least_ms(const Work& work) {
  double least = 1e300;
  for (int run = 0; run < 15; ++run) {
    const double start = thread_cpu_seconds();
    work();
    least = std::min(least, thread_cpu_seconds() - start);
  }
  return 1e3 * least;
}

template <int K, int Arity>
void measure(const char* name, const collision::testing::TestMesh& mesh) {
  const Surface surface = mesh.surface();
  ProximityFinder finder(mesh.triangles, surface.vertex_count);
  for (const int capacity : {1, 4, 8}) {
    const double start = thread_cpu_seconds();
    Tree<K, Arity> tree(surface, mesh.x, capacity);
    const double build = 1e3 * (thread_cpu_seconds() - start);
    CandidatePairs found;
    std::vector<Proximity> proximities;
    const double refit = least_ms([&] { tree.refit(mesh.x, mesh.x, kReach / 2); });
    const double pairs = least_ms([&] {
      found.clear();
      self_pairs(tree, found);
    });
    const double find = least_ms([&] { finder.find(found, std::span(&surface, 1), mesh.x, kReach, proximities); });
    fmt::print("| {} | {} | {} | {} | {:.2f} | {:.3f} | {:.3f} | {:.3f} | {} | {} |\n", name, K, Arity, capacity, build,
               refit, pairs, find, found.apart.size(), proximities.size());
  }
}

template <int K>
void measure_arities(const char* name, const collision::testing::TestMesh& mesh) {
  measure<K, 2>(name, mesh);
  measure<K, 4>(name, mesh);
  measure<K, 8>(name, mesh);
}

}  // namespace

int main() {
  fmt::print("| sheet | k | arity | leaf | build | refit | pairs | proximities | pairs apart | proximities found |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int n : {64, 300}) {
    for (const int layers : {1, 8}) {
      const auto mesh = collision::testing::folded_sheet(n, layers, 0.002);
      const std::string name = fmt::format("{0}×{0}, {1}", n, layers == 1 ? "flat" : "8 layers 2 mm apart");
      measure_arities<6>(name.c_str(), mesh);
      measure_arities<14>(name.c_str(), mesh);
      measure_arities<18>(name.c_str(), mesh);
      measure_arities<26>(name.c_str(), mesh);
    }
  }
}
