// Measures the options of BroadPhase, and CoherentDetection, on recorded meshes of a scene.
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bench/measure.hpp"
#include "collision/hierarchy/feature_distance.hpp"
#include "collision/hierarchy/test_motions.hpp"
#include "physics/collision/hierarchy/broad_phase.hpp"
#include "physics/collision/variants/coherence.hpp"
#include "physics/collision/variants/normal_cones.hpp"
#include "support/ply.hpp"

namespace weft::bench {

namespace {

using namespace weft::collision;

/// Steps per frame; positions between frames are interpolated.
constexpr int kSteps = 4;

struct Recording {
  collision::testing::MovingScene scene;
  std::vector<std::vector<Vec3>> frames;  ///< positions of all objects, per frame
  std::vector<bool> deformable;           ///< by object

  std::vector<Vec3> at(int step) const {
    const auto frame = static_cast<std::size_t>(step / kSteps);
    std::vector<Vec3> x = frames[frame];
    if (const double part = step % kSteps / static_cast<double>(kSteps); part > 0)
      for (std::size_t v = 0; v < x.size(); ++v) x[v] += part * (frames[frame + 1][v] - x[v]);
    return x;
  }
  int steps() const { return static_cast<int>(frames.size() - 1) * kSteps; }
};

/// Whether the first side of any triangle has different lengths in both meshes. If so, the object counts as cloth.
bool deforms(const support::PlyMesh& first, const support::PlyMesh& last) {
  for (const auto& t : first.triangles) {
    const auto length = [&](const support::PlyMesh& m) {
      return (m.positions[static_cast<std::size_t>(t[0])] - m.positions[static_cast<std::size_t>(t[1])]).norm();
    };
    if (std::abs(length(first) - length(last)) > 1e-9 * length(first)) return true;
  }
  return false;
}

/// Reads the frames. Cloth comes first, then obstacles, each in the order of names.
Recording read(const std::filesystem::path& folder, int first, int count) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (const std::string name = entry.path().stem().string(); name.size() > 6)
      names.insert(name.substr(0, name.size() - 6));
  const auto load = [&](const std::string& name, int frame) {
    return support::read_ply(folder / fmt::format("{}_{:05}.ply", name, frame));
  };
  Recording recording;
  std::vector<std::string> order;
  for (const bool cloth : {true, false})
    for (const std::string& name : names) {
      const support::PlyMesh mesh = load(name, first);
      if (deforms(mesh, load(name, first + count - 1)) != cloth) continue;
      order.push_back(name);
      recording.deformable.push_back(cloth);
      recording.scene.add({mesh.positions, mesh.triangles});
    }
  for (int frame = first; frame < first + count; ++frame) {
    auto& x = recording.frames.emplace_back();
    for (const std::string& name : order) {
      const support::PlyMesh mesh = load(name, frame);
      x.insert(x.end(), mesh.positions.begin(), mesh.positions.end());
    }
  }
  return recording;
}

struct Costs {
  double refit = 0, pairs = 0, proximities = 0;  // CPU times, summed over all steps [ms]
  std::size_t candidates = 0, found = 0;
  double total() const { return refit + pairs + proximities; }
};

Costs run(const Recording& recording, const BroadPhaseOptions& options, double reach) {
  const std::vector<Surface> surfaces = recording.scene.surfaces();
  std::vector<Vec3> x_t0, x_t1 = recording.at(0);
  BroadPhase broad_phase(surfaces, x_t1, options);
  ProximityFinder finder(recording.scene.triangles, static_cast<Index>(x_t1.size()));
  CandidatePairs candidates;
  std::vector<Proximity> proximities;
  std::vector<Surface> cloth;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    if (recording.deformable[s]) cloth.push_back(surfaces[s]);
  Costs costs;
  for (int step = 0; step < recording.steps(); ++step) {
    x_t0 = x_t1;
    x_t1 = recording.at(step + 1);
    add_ms(costs.refit, [&] {
      for (std::size_t s = 0; s < surfaces.size(); ++s)
        if (recording.deformable[s] || step == 0) broad_phase.refit(s, {x_t0, x_t1}, reach / 2);
    });
    candidates.clear();
    add_ms(costs.pairs, [&] {
      for (std::size_t a = 0; a < cloth.size(); ++a) {
        broad_phase.self_pairs(a, candidates);
        for (std::size_t b = a + 1; b < surfaces.size(); ++b) broad_phase.pairs(a, b, candidates);
      }
    });
    add_ms(costs.proximities, [&] { finder.find(candidates, cloth, x_t0, reach, proximities); });
    costs.candidates += candidates.apart.size() + candidates.one_shared.size();
    costs.found += proximities.size();
  }
  return costs;
}

/// Like run(), with the default tree and CoherentDetection, which reuses results of earlier steps. All costs are summed
/// in Costs::proximities.
Costs run_with_reuse(const Recording& recording, double reach, double budget, int& reused, int& asked) {
  const std::vector<Surface> surfaces = recording.scene.surfaces();
  std::vector<SurfacePair> wanted;
  for (std::size_t a = 0; a < surfaces.size(); ++a)
    for (std::size_t b = a; recording.deformable[a] && b < surfaces.size(); ++b) wanted.push_back({a, b});
  std::vector<Vec3> x_t0, x_t1 = recording.at(0);
  BroadPhase broad_phase(surfaces, x_t1);
  ProximityFinder finder(recording.scene.triangles, static_cast<Index>(x_t1.size()));
  CoherentDetection detection(surfaces, wanted, x_t1, {.detection_distance = reach, .budget = budget});
  Costs costs;
  for (int step = 0; step < recording.steps(); ++step) {
    x_t0 = x_t1;
    x_t1 = recording.at(step + 1);
    int anew = 0;
    add_ms(costs.proximities, [&] { anew = detection.update(broad_phase, finder, x_t0, x_t1); });
    asked += static_cast<int>(wanted.size());
    reused += static_cast<int>(wanted.size()) - anew;
    costs.candidates += detection.candidates().apart.size() + detection.candidates().one_shared.size();
    costs.found += detection.proximities().size();
  }
  return costs;
}

void print_row(const std::string& name, const std::vector<Costs>& runs, int steps) {
  const auto each = [&](auto part) {
    std::vector<double> values;
    for (const Costs& costs : runs) values.push_back(part(costs) / steps);
    return median(values);
  };
  fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {} | {} |\n", name, each([](auto& c) { return c.refit; }),
             each([](auto& c) { return c.pairs; }), each([](auto& c) { return c.proximities; }),
             each([](auto& c) { return c.total(); }), runs[0].candidates / static_cast<std::size_t>(steps),
             runs[0].found / static_cast<std::size_t>(steps));
}

/// In every second frame, counts the pairs that normal cones skip, and those of them that are closer than `reach` [m],
/// the detection distance. Prints both sums.
void count_skipped_pairs(const Recording& recording, double reach) {
  const std::vector<Surface> surfaces = recording.scene.surfaces();
  std::size_t left_out = 0, missed = 0;
  for (std::size_t f = 0; f < recording.frames.size(); f += 2)
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      if (!recording.deformable[s]) continue;
      const std::vector<Vec3>& x = recording.frames[f];
      Tree<6> tree(surfaces[s], x);
      tree.refit({x, x}, reach / 2);
      NormalCones<6> cones(tree);
      cones.update(tree, x, x, reach);
      CandidatePairs all, with_cones;
      collision::self_pairs(tree, all);
      Traversal how;
      how.regions = &cones.regions();
      collision::self_pairs(tree, with_cones, how);
      const std::set<TrianglePair> found(with_cones.apart.begin(), with_cones.apart.end());
      for (const TrianglePair& pair : all.apart) {
        if (found.contains(pair)) continue;
        ++left_out;
        const auto triangle = [&](Index t) { return recording.scene.triangles[t]; };
        missed += collision::testing::feature_distance(triangle(pair.a), triangle(pair.b), x) < reach ? 1 : 0;
      }
    }
  fmt::print("\n{} pairs left out by normal cones, {} of them within reach\n", left_out, missed);
}

/// The default options, and variants that change one option each.
std::vector<std::pair<std::string, BroadPhaseOptions>> settings() {
  std::vector<std::pair<std::string, BroadPhaseOptions>> all{{"default: k 6, 8 children, leaf 8", {}}};
  const auto add = [&](const std::string& name, auto change) {
    change(all.emplace_back(name, BroadPhaseOptions{}).second);
  };
  for (const int k : {18, 26}) add(fmt::format("k {}", k), [&](auto& o) { o.directions = k; });
  for (const int c : {2, 4}) add(fmt::format("{} children", c), [&](auto& o) { o.children = c; });
  add("2 children, leaf 1 (as in the paper)", [](auto& o) { o.children = 2, o.leaf = 1; });
  add("4 children, leaf 1", [](auto& o) { o.children = 4, o.leaf = 1; });
  for (const int l : {1, 2, 4}) add(fmt::format("leaf {}", l), [&](auto& o) { o.leaf = l; });
  add("open longer side", [](auto& o) { o.open_longer_side = true; });
  add("separation list", [](auto& o) { o.separation_list = true; });
  add("2 children, leaf 1, separation list", [](auto& o) { o.children = 2, o.leaf = 1, o.separation_list = true; });
  add("velocity cones, lazy refit", [](auto& o) { o.velocity_cones = true; });
  add("k 26, velocity cones, lazy refit", [](auto& o) { o.directions = 26, o.velocity_cones = true; });
  add("normal cones", [](auto& o) { o.normal_cones = true; });
  return all;
}

}  // namespace

void replay(const std::filesystem::path& meshes, int first_frame, int frames, double reach) {
  const Recording recording = read(meshes, first_frame, frames);
  fmt::print("{}: {} triangles, {} steps, reach {} m; CPU ms a step\n\n", meshes.filename().string(),
             recording.scene.triangles.size(), recording.steps(), reach);
  fmt::print(
      "| setting | refit | pairs | proximities | all | candidates | proximities found "
      "|\n|---|---|---|---|---|---|---|\n");
  constexpr int kRuns = 3;
  const auto all = settings();
  // Alternates the runs of the options, so that other load on the machine slows all options alike.
  std::vector<std::vector<Costs>> costs(all.size());
  for (int r = 0; r < kRuns; ++r)
    for (std::size_t i = 0; i < all.size(); ++i) costs[i].push_back(run(recording, all[i].second, reach));
  for (std::size_t i = 0; i < all.size(); ++i) {
    print_row(all[i].first, costs[i], recording.steps());
    if (costs[i][0].found != costs[0][0].found) fmt::print("FOUND SOMETHING ELSE\n");
  }
  for (const double part : {0.125, 0.5}) {
    std::vector<Costs> coherent;
    int reused = 0, asked = 0;
    for (int r = 0; r < kRuns; ++r) coherent.push_back(run_with_reuse(recording, reach, part * reach, reused, asked));
    print_row(fmt::format("velocity cones, results kept, budget {} of reach ({} % kept)", part, 100 * reused / asked),
              coherent, recording.steps());
  }
  count_skipped_pairs(recording, reach);
}

}  // namespace weft::bench
