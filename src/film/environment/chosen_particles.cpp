#include "film/environment/chosen_particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "core/error.hpp"
#include "core/nearest.hpp"
#include "film/image/picture.hpp"

namespace weft::environment {
namespace {

using model::WeightedParticle;

// A particle belongs to a region if its fraction is at least this: half a level of an 8-bit picture.
constexpr double kMinFraction = 0.5 / 255;
// A pin without a strength holds a particle completely if its fraction is at least this; otherwise, not at all.
constexpr double kMinHeldFraction = 0.5;

/// Grey value of a picture at (u, v) times its opacity, in [0, 1]; v points up. Interpolates linearly between the
/// centres of pixels; beyond the outermost centres, uses the nearest pixel.
double grey_at(const image::Picture& picture, const Vec2& uv) {
  const auto pixel = [&](int x, int y) {
    x = std::clamp(x, 0, picture.width - 1);
    y = std::clamp(y, 0, picture.height - 1);
    const auto* p = &picture.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                       static_cast<std::size_t>(x))];
    return (p[0] + p[1] + p[2]) / (3 * 255.0) * (p[3] / 255.0);
  };
  const double x = std::clamp(uv.x(), 0.0, 1.0) * picture.width - 0.5;
  const double y = (1 - std::clamp(uv.y(), 0.0, 1.0)) * picture.height - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const double s = x - i, t = y - j;
  return (1 - t) * ((1 - s) * pixel(i, j) + s * pixel(i + 1, j)) +
         t * ((1 - s) * pixel(i, j + 1) + s * pixel(i + 1, j + 1));
}

[[noreturn]] void refuse(const std::string& key, const char* field, const std::string& why) {
  throw Error(ExitCode::scene_invalid, "{}.{}: expected {}", key, field, why);
}

/// Finds the particles of the regions (scene::ClothPart) of one cloth.
class ParticleFinder {
 public:
  ParticleFinder(const scene::Cloth& cloth, const assets::LoadedMesh& file, const MadeCloth& made)
      : from_file_(cloth.shape == scene::ClothShape::mesh), file_(file), cloth_(made.cloth), details_(made.details) {}

  /// Particles of a region, with their fractions. `key`: key of the region in the scene, for messages.
  std::vector<WeightedParticle> part(const scene::ClothPart& part, const std::string& key) const {
    std::vector<double> fractions(details_.fractions.size());
    if (part.at) {
      along_rope(*part.at, fractions);
    } else if (!part.panel.empty()) {
      on_panel(part, key, fractions);
    } else {
      for (std::size_t i = 0; i < fractions.size(); ++i)
        fractions[i] = part.holds(details_.fractions[i].x(), details_.fractions[i].y()) ? 1 : 0;
      if (part.mask) under_mask(image::read_picture(*part.mask), key, fractions);
    }
    if (!part.edge.empty()) on_edge(part.edge, key, fractions);
    if (part.vertex_color != scene::VertexColor::none) by_color(part.vertex_color, key, fractions);
    if (!part.vertex_group.empty()) by_group(part.vertex_group, key, fractions);
    std::vector<WeightedParticle> chosen;
    for (std::size_t i = 0; i < fractions.size(); ++i)
      if (fractions[i] > 0) chosen.push_back({static_cast<Index>(i), std::min(1.0, fractions[i])});
    return chosen;
  }

 private:
  void on_edge(const std::string& name, const std::string& key, std::vector<double>& fractions) const {
    const std::vector<Index>& edge = named(details_.edges, name, key, "edge", "an edge of its pattern");
    std::vector<double> on(fractions.size());
    for (const Index i : edge) on[static_cast<std::size_t>(i)] = 1;
    multiply(on, fractions);
  }

  // Selects the particles that are nearest to both ends of the region, and all particles between them.
  void along_rope(const Vec2& at, std::vector<double>& fractions) const {
    const auto pieces = static_cast<double>(cloth_.rope->lengths.size());
    const auto nearest = [&](double fraction) { return static_cast<std::size_t>(std::lround(fraction * pieces)); };
    for (std::size_t i = nearest(at.x()); i <= nearest(at.y()); ++i) fractions[i % fractions.size()] = 1;
  }

  // Selects the particles of one panel within the bounds and the mask. If a vertex has several UVs in the panel, as at
  // darts, the largest fraction counts.
  void on_panel(const scene::ClothPart& part, const std::string& key, std::vector<double>& fractions) const {
    const auto found = std::ranges::find(details_.panels, part.panel);
    if (found == details_.panels.end())
      refuse_name(part.panel, details_.panels, key, "panel", "a panel of its pattern");
    const auto number = found - details_.panels.begin();
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
    const auto each_corner = [&](const auto& visit) {
      for (std::size_t t = 0; t < details_.panel_of.size(); ++t)
        for (std::size_t k = 0; k < 3 && details_.panel_of[t] == number; ++k)
          visit(details_.paint_uv[t][k], fractions[static_cast<std::size_t>(cloth_.mesh.topology.triangles[t][k])]);
    };
    each_corner([&](const Vec2& uv, double&) { low = low.cwiseMin(uv), high = high.cwiseMax(uv); });
    std::optional<image::Picture> mask;
    if (part.mask) mask = image::read_picture(*part.mask);
    each_corner([&](const Vec2& uv, double& fraction) {
      const Vec2 at = (uv - low).cwiseQuotient(high - low);
      if (part.holds(at.x(), at.y())) fraction = std::max(fraction, mask ? grey_at(*mask, at) : 1.0);
    });
  }

  // If a vertex has several UVs, the largest fraction counts.
  void under_mask(const image::Picture& picture, const std::string& key, std::vector<double>& fractions) const {
    std::vector<double> greys(fractions.size());
    if (!from_file_) {
      for (std::size_t i = 0; i < greys.size(); ++i) greys[i] = grey_at(picture, details_.fractions[i]);
    } else {
      if (file_.uv.empty()) refuse(key, "mask", "a mesh with texture coordinates (UVs) to lay it on, got none");
      for (std::size_t t = 0; t < file_.uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          double& grey = greys[static_cast<std::size_t>(cloth_.mesh.topology.triangles[t][k])];
          if (file_.uv[t][k].allFinite()) grey = std::max(grey, grey_at(picture, file_.uv[t][k]));
        }
    }
    multiply(greys, fractions);
  }

  void by_color(scene::VertexColor channel, const std::string& key, std::vector<double>& fractions) const {
    if (file_.colors.empty()) refuse(key, "vertex_color", "a mesh whose vertices have colours, got none");
    for (std::size_t i = 0; i < fractions.size(); ++i) {
      const Vec3& color = file_.colors[i];
      fractions[i] *= channel == scene::VertexColor::brightness
                          ? color.mean()
                          : color[static_cast<int>(channel) - static_cast<int>(scene::VertexColor::red)];
    }
  }

  void by_group(const std::string& name, const std::string& key, std::vector<double>& fractions) const {
    if (file_.groups.empty()) refuse(key, "vertex_group", "a mesh with groups of vertices, or bones, got one without");
    multiply(named(file_.groups, name, key, "vertex_group", "a group of its vertices"), fractions);
  }

  template <class Map>
  static const typename Map::mapped_type& named(const Map& map, const std::string& name, const std::string& key,
                                                const char* field, const char* kind) {
    if (const auto found = map.find(name); found != map.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, value] : map) names.push_back(known);
    refuse_name(name, names, key, field, kind);
  }
  static void multiply(const std::vector<double>& factors, std::vector<double>& fractions) {
    for (std::size_t i = 0; i < fractions.size(); ++i) fractions[i] *= factors[i];
  }
  bool from_file_;
  const assets::LoadedMesh& file_;
  const model::Cloth& cloth_;
  const ClothDetails& details_;
};

/// Shortest distances along a cloth at rest. Paths follow edges of triangles, and edges and diagonals of quads.
class RestDistances {
 public:
  explicit RestDistances(const model::Cloth& cloth) : neighbours_(cloth.mesh.positions.size()) {
    const auto join = [&](Index a, Index b, double length) {
      neighbours_[static_cast<std::size_t>(a)].emplace_back(b, length);
      neighbours_[static_cast<std::size_t>(b)].emplace_back(a, length);
    };
    // Joins all pairs of corners of a quad: edges and diagonals. Inner edges are joined twice, which has no effect.
    for (const mesh::Quad& q : cloth.mesh.topology.quads)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b)
          join(q[a], q[b], (cloth.mesh.positions[q[b]] - cloth.mesh.positions[q[a]]).norm());
    for (std::size_t t = 0; t < cloth.sheet.triangles.size(); ++t)
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        join(cloth.sheet.triangles[t][a], cloth.sheet.triangles[t][b],
             (cloth.sheet.material[t][b] - cloth.sheet.material[t][a]).norm());
      }
  }

  /// Appends to the region `part` the particles that are nearer to it than `fade` [m]. Their fraction falls from that
  /// of the nearest particle of the region to 0 at the distance `fade`, with zero slope at both ends. Shortest paths:
  /// E. W. Dijkstra, "A note on two problems in connexion with graphs", 1959.
  void fade(double fade, std::vector<WeightedParticle>& part) const {
    struct FrontParticle {
      double distance;
      Index particle;
      double fraction;  // of the nearest particle of the region
      bool operator>(const FrontParticle& other) const {
        return std::pair(distance, particle) > std::pair(other.distance, other.particle);
      }
    };
    std::priority_queue<FrontParticle, std::vector<FrontParticle>, std::greater<>> front;
    std::vector<double> nearest(neighbours_.size(), std::numeric_limits<double>::infinity());
    std::vector<char> done(neighbours_.size());
    const auto visit = [&](const FrontParticle& candidate) {
      double& distance = nearest[static_cast<std::size_t>(candidate.particle)];
      if (candidate.distance >= fade || candidate.distance >= distance) return;
      distance = candidate.distance;
      front.push(candidate);
    };
    for (const WeightedParticle& chosen : part) visit({0, chosen.particle, chosen.fraction});
    while (!front.empty()) {
      const FrontParticle here = front.top();
      front.pop();
      const auto i = static_cast<std::size_t>(here.particle);
      if (std::exchange(done[i], 1) != 0) continue;
      const double s = 1 - here.distance / fade;
      if (here.distance > 0) part.push_back({here.particle, here.fraction * s * s * (3 - 2 * s), true});
      for (const auto& [next, length] : neighbours_[i]) visit({here.distance + length, next, here.fraction});
    }
  }

 private:
  std::vector<std::vector<std::pair<Index, double>>>
      neighbours_;  // per particle: its neighbours and their distances [m]
};

/// Text for a region that contains no particle, such as one between two rows of particles: proposes bounds that include
/// the nearest particle. Empty if not only bounds define the region.
std::string nearest_row(const scene::ClothPart& part, const ClothDetails& details) {
  if (!part.panel.empty() || !part.edge.empty() || part.mask || part.vertex_color != scene::VertexColor::none ||
      !part.vertex_group.empty() || details.fractions.empty())
    return {};
  const auto distance = [&](const Vec2& at) { return (at - at.cwiseMax(part.low).cwiseMin(part.high)).norm(); };
  const Vec2& nearest = *std::ranges::min_element(details.fractions, {}, distance);
  const Vec2 low = part.low.cwiseMin(nearest), high = part.high.cwiseMax(nearest);
  return fmt::format(
      " between low = [{:.4g}, {:.4g}] and high = [{:.4g}, {:.4g}]; the nearest particle is at [{:.4g}, {:.4g}]: low = "
      "[{:.4g}, {:.4g}], high = [{:.4g}, {:.4g}] hold it",
      part.low.x(), part.low.y(), part.high.x(), part.high.y(), nearest.x(), nearest.y(),
      std::floor(1e4 * low.x()) / 1e4, std::floor(1e4 * low.y()) / 1e4, std::ceil(1e4 * high.x()) / 1e4,
      std::ceil(1e4 * high.y()) / 1e4);
}

}  // namespace

void refuse_name(const std::string& name, const std::vector<std::string>& known, const std::string& key,
                 const char* field, const char* kind) {
  const std::string nearest = nearest_name(name, known);
  refuse(key, field,
         fmt::format("{}, such as {}, got \"{}\"{}", kind, known.front(), name,
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
}

void choose_particles(const scene::Scene& scene, const scene::Cloth& cloth, const assets::LoadedMesh& file,
                      const std::string& where, MadeCloth& made) {
  const ParticleFinder finder(cloth, file, made);
  const auto part_at = [&](const scene::ClothPart& part, const std::string& key, double min_fraction) {
    std::vector<WeightedParticle> chosen = finder.part(part, key);
    std::erase_if(chosen, [&](const WeightedParticle& one) { return one.fraction < min_fraction; });
    if (chosen.empty())
      throw Error(ExitCode::scene_invalid,
                  "{}: expected a part that holds at least one particle, got one that holds none{}", key,
                  nearest_row(part, made.details));
    return chosen;
  };
  const auto part_of = [&](const scene::ClothPart& part, const char* kind, std::size_t number, double min_fraction) {
    return part_at(part, fmt::format("{}.{}.{}", where, kind, number), min_fraction);
  };
  for (std::size_t p = 0; p < cloth.pins.size(); ++p) {
    const scene::Pin& pin = cloth.pins[p];
    model::Pin& made_pin = made.cloth.pins.emplace_back();
    made_pin.particles = part_of(pin, "pin", p, pin.strength ? kMinFraction : kMinHeldFraction);
    if (pin.fade > 0) RestDistances(made.cloth).fade(pin.fade, made_pin.particles);
    made_pin.release = pin.release;
    made_pin.strength = pin.strength;
  }
  for (std::size_t w = 0; w < cloth.weights.size(); ++w)
    made.cloth.weights.push_back({part_of(cloth.weights[w], "weight", w, kMinFraction), cloth.weights[w].mass});
  for (const scene::Attachment& attachment : scene.attachments)
    if (attachment.cloth == cloth.name)
      made.attachments.push_back(
          part_at(attachment, fmt::format("{}: attach.{}", scene.file.string(), attachment.name), kMinFraction));
}

}  // namespace weft::environment
