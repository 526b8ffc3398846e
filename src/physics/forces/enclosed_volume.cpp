#include "physics/forces/enclosed_volume.hpp"

#include <array>
#include <map>
#include <set>

#include "core/parallel.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::forces {
namespace {

// Loops of border edges. Each edge runs opposite to its direction in its triangle.
std::vector<std::vector<Index>> border_loops(std::span<const mesh::Triangle> triangles) {
  // A border edge is one whose reverse is in no triangle.
  std::set<std::array<Index, 2>> edges;
  for (const mesh::Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  std::multimap<Index, Index> next;
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from})) next.emplace(to, from);
  std::vector<std::vector<Index>> loops;
  while (!next.empty()) {
    std::vector<Index>& loop = loops.emplace_back();
    for (auto edge = next.begin(); edge != next.end(); edge = next.find(loop.back())) {
      if (loop.empty()) loop.push_back(edge->first);
      loop.push_back(edge->second);
      next.erase(edge);
    }
    loop.pop_back();  // it repeats the first vertex
  }
  return loops;
}

}  // namespace

EnclosedVolume::EnclosedVolume(std::span<const mesh::Triangle> triangles, std::span<const Vec3> start)
    : borders_(border_loops(triangles)) {
  std::vector<mesh::Triangle> closed(triangles.begin(), triangles.end());
  auto middle = static_cast<Index>(start.size());
  for (const std::vector<Index>& border : borders_) {
    for (std::size_t k = 0; k < border.size(); ++k)
      closed.push_back({border[k], border[(k + 1) % border.size()], middle});
    ++middle;
  }
  star_begin_.assign(at(middle) + 1, 0);
  for (const mesh::Triangle& t : closed)
    for (Index corner : t) ++star_begin_[at(corner) + 1];
  for (std::size_t i = 0; i < at(middle); ++i) star_begin_[i + 1] += star_begin_[i];
  star_.resize(3 * closed.size());
  std::vector<Index> filled(star_begin_.begin(), star_begin_.end() - 1);
  for (const mesh::Triangle& t : closed)
    for (std::size_t k = 0; k < 3; ++k) star_[at(filled[at(t[k])]++)] = {t[(k + 1) % 3], t[(k + 2) % 3]};

  flat_ = mesh::largest_flat_volume(triangles, start);
  std::vector<Vec3> gradient(start.size());
  if (evaluate(start, gradient) < -flat_) sign_ = -1;
}

double EnclosedVolume::evaluate(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  std::vector<Vec3> middles(borders_.size(), Vec3::Zero());
  for (std::size_t b = 0; b < borders_.size(); ++b) {
    for (Index i : borders_[b]) middles[b] += x[at(i)];
    middles[b] /= static_cast<double>(borders_[b].size());
  }
  const auto place = [&](Index i) -> const Vec3& { return at(i) < x.size() ? x[at(i)] : middles[at(i) - x.size()]; };
  // Positions relative to vertex i itself keep the products accurate far from the origin.
  const auto derivative = [&](std::size_t i) {
    const Vec3& own = place(static_cast<Index>(i));
    Vec3 sum = Vec3::Zero();
    for (Index s = star_begin_[i]; s < star_begin_[i + 1]; ++s) {
      const auto& [j, k] = star_[at(s)];
      sum += (place(j) - own).cross(place(k) - own);
    }
    return Vec3(sign_ / 6 * sum);
  };
  parallel_for(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) gradient[i] = derivative(i);
  });
  for (std::size_t b = 0; b < borders_.size(); ++b) {
    const Vec3 of_each = derivative(x.size() + b) / static_cast<double>(borders_[b].size());
    for (Index i : borders_[b]) gradient[at(i)] += of_each;
  }
  const Vec3 origin = x.empty() ? Vec3(Vec3::Zero()) : x.front();
  return parallel_sum(x.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += gradient[i].dot(x[i] - origin);
    return sum / 3;
  });
}

}  // namespace weft::forces
