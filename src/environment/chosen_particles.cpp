#include "environment/chosen_particles.hpp"

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
#include "image/picture.hpp"

namespace weft::environment {
namespace {

// A share below this is that of no particle: half a level of a picture.
constexpr double kLeastShare = 0.5 / 255;
// What is held is held whole, with a share from this on.
constexpr double kHeld = 0.5;

/// Grey of a picture at (u, v), v upward, from 0 to 1, times its opacity; linear between the middles of its pixels, and
/// outside of them that of the nearest.
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

/// Finds the particles of the parts of one cloth.
class Chooser {
 public:
  Chooser(const scene::Cloth& cloth, const assets::LoadedMesh& file, const ClothObject& object)
      : from_file_(cloth.shape == scene::ClothShape::mesh), file_(file), object_(object) {}

  /// `key`: of the part, for messages.
  std::vector<Chosen> part(const scene::ClothPart& part, const std::string& key) const {
    std::vector<double> shares(object_.fractions.size());
    if (part.at) {
      along_rope(*part.at, shares);
    } else if (!part.panel.empty()) {
      on_panel(part, key, shares);
    } else {
      for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] = part.holds(object_.fractions[i].x(), object_.fractions[i].y()) ? 1 : 0;
      if (part.mask) under_mask(image::read_picture(*part.mask), key, shares);
    }
    if (!part.edge.empty()) on_edge(part.edge, key, shares);
    if (part.vertex_color != scene::VertexColor::none) by_color(part.vertex_color, key, shares);
    if (!part.vertex_group.empty()) by_group(part.vertex_group, key, shares);
    std::vector<Chosen> chosen;
    for (std::size_t i = 0; i < shares.size(); ++i)
      if (shares[i] > 0) chosen.push_back({static_cast<Index>(i), std::min(1.0, shares[i])});
    return chosen;
  }

 private:
  void on_edge(const std::string& name, const std::string& key, std::vector<double>& shares) const {
    const std::vector<Index>& edge = named(object_.edges, name, key, "edge", "an edge of its pattern");
    std::vector<double> on(shares.size());
    for (const Index i : edge) on[static_cast<std::size_t>(i)] = 1;
    multiply(on, shares);
  }

  // The particles nearest to both ends, and those between.
  void along_rope(const Vec2& at, std::vector<double>& shares) const {
    const auto pieces = static_cast<double>(object_.lengths.size());
    const auto nearest = [&](double fraction) { return static_cast<std::size_t>(std::lround(fraction * pieces)); };
    for (std::size_t i = nearest(at.x()); i <= nearest(at.y()); ++i) shares[i % shares.size()] = 1;
  }

  // Between low and high and under the mask of one panel. Where its own edges meet in a dart, the largest share.
  void on_panel(const scene::ClothPart& part, const std::string& key, std::vector<double>& shares) const {
    const auto found = std::ranges::find(object_.panels, part.panel);
    if (found == object_.panels.end()) refuse_name(part.panel, object_.panels, key, "panel", "a panel of its pattern");
    const auto number = found - object_.panels.begin();
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
    const auto each_corner = [&](const auto& visit) {
      for (std::size_t t = 0; t < object_.panel_of.size(); ++t)
        for (std::size_t k = 0; k < 3 && object_.panel_of[t] == number; ++k)
          visit(object_.paint_uv[t][k], shares[static_cast<std::size_t>(object_.mesh.topology.triangles[t][k])]);
    };
    each_corner([&](const Vec2& uv, double&) { low = low.cwiseMin(uv), high = high.cwiseMax(uv); });
    std::optional<image::Picture> mask;
    if (part.mask) mask = image::read_picture(*part.mask);
    each_corner([&](const Vec2& uv, double& share) {
      const Vec2 at = (uv - low).cwiseQuotient(high - low);
      if (part.holds(at.x(), at.y())) share = std::max(share, mask ? grey_at(*mask, at) : 1.0);
    });
  }

  // Where islands of UVs meet, the largest share.
  void under_mask(const image::Picture& picture, const std::string& key, std::vector<double>& shares) const {
    std::vector<double> greys(shares.size());
    if (!from_file_) {
      for (std::size_t i = 0; i < greys.size(); ++i) greys[i] = grey_at(picture, object_.fractions[i]);
    } else {
      if (file_.uv.empty()) refuse(key, "mask", "a mesh with texture coordinates (UVs) to lay it on, got none");
      for (std::size_t t = 0; t < file_.uv.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          double& grey = greys[static_cast<std::size_t>(object_.mesh.topology.triangles[t][k])];
          if (file_.uv[t][k].allFinite()) grey = std::max(grey, grey_at(picture, file_.uv[t][k]));
        }
    }
    multiply(greys, shares);
  }

  void by_color(scene::VertexColor channel, const std::string& key, std::vector<double>& shares) const {
    if (file_.colors.empty()) refuse(key, "vertex_color", "a mesh whose vertices have colours, got none");
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const Vec3& color = file_.colors[i];
      shares[i] *= channel == scene::VertexColor::brightness
                       ? color.mean()
                       : color[static_cast<int>(channel) - static_cast<int>(scene::VertexColor::red)];
    }
  }

  void by_group(const std::string& name, const std::string& key, std::vector<double>& shares) const {
    if (file_.groups.empty()) refuse(key, "vertex_group", "a mesh with groups of vertices, or bones, got one without");
    multiply(named(file_.groups, name, key, "vertex_group", "a group of its vertices"), shares);
  }

  template <class Map>
  static const typename Map::mapped_type& named(const Map& map, const std::string& name, const std::string& key,
                                                const char* field, const char* kind) {
    if (const auto found = map.find(name); found != map.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, value] : map) names.push_back(known);
    refuse_name(name, names, key, field, kind);
  }
  [[noreturn]] static void refuse_name(const std::string& name, const std::vector<std::string>& names,
                                       const std::string& key, const char* field, const char* kind) {
    const std::string nearest = nearest_name(name, names);
    refuse(key, field,
           fmt::format("{}, such as {}, got \"{}\"{}", kind, names.front(), name,
                       nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
  }
  static void multiply(const std::vector<double>& factors, std::vector<double>& shares) {
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] *= factors[i];
  }
  [[noreturn]] static void refuse(const std::string& key, const char* field, const std::string& why) {
    throw Error(ExitCode::scene_invalid, "{}.{}: expected {}", key, field, why);
  }

  bool from_file_;
  const assets::LoadedMesh& file_;
  const ClothObject& object_;
};

/// Ways along a cloth at rest: along the edges of triangles; of quads also across.
class Ways {
 public:
  explicit Ways(const ClothObject& cloth) : to_(cloth.fractions.size()) {
    const auto join = [&](Index a, Index b, double length) {
      to_[static_cast<std::size_t>(a)].emplace_back(b, length);
      to_[static_cast<std::size_t>(b)].emplace_back(a, length);
    };
    // A quad's diagonals come of its corners, an inner edge of two triangles twice, which does no harm.
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

  /// Appends to a part what is nearer to it than `fade` [m]; shares fall to nothing there with no kink at either end,
  /// from that of the nearest particle of the part (E. W. Dijkstra, "A note on two problems in connexion with graphs",
  /// 1959).
  void fade(double fade, std::vector<Chosen>& part) const {
    struct Reached {
      double distance;
      Index particle;
      double share;  // of the particle of the part that it is reached from
      bool operator>(const Reached& other) const {
        return std::pair(distance, particle) > std::pair(other.distance, other.particle);
      }
    };
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    std::vector<double> nearest(to_.size(), std::numeric_limits<double>::infinity());
    std::vector<char> done(to_.size());
    const auto reach = [&](const Reached& reached) {
      double& distance = nearest[static_cast<std::size_t>(reached.particle)];
      if (reached.distance >= fade || reached.distance >= distance) return;
      distance = reached.distance;
      front.push(reached);
    };
    for (const Chosen& chosen : part) reach({0, chosen.particle, chosen.share});
    while (!front.empty()) {
      const Reached here = front.top();
      front.pop();
      const auto i = static_cast<std::size_t>(here.particle);
      if (std::exchange(done[i], 1) != 0) continue;
      const double s = 1 - here.distance / fade;
      if (here.distance > 0) part.push_back({here.particle, here.share * s * s * (3 - 2 * s), true});
      for (const auto& [next, length] : to_[i]) reach({here.distance + length, next, here.share});
    }
  }

 private:
  std::vector<std::vector<std::pair<Index, double>>> to_;  // per particle: others, and how far they are [m]
};

/// What to write instead of bounds that lie between two rows of particles; nothing of parts that are given otherwise.
std::string nearest_row(const scene::ClothPart& part, const ClothObject& object) {
  if (!part.panel.empty() || !part.edge.empty() || part.mask || part.vertex_color != scene::VertexColor::none ||
      !part.vertex_group.empty() || object.fractions.empty())
    return {};
  const auto distance = [&](const Vec2& at) { return (at - at.cwiseMax(part.low).cwiseMin(part.high)).norm(); };
  const Vec2& nearest = *std::ranges::min_element(object.fractions, {}, distance);
  const Vec2 low = part.low.cwiseMin(nearest), high = part.high.cwiseMax(nearest);
  return fmt::format(
      " between low = [{:.4g}, {:.4g}] and high = [{:.4g}, {:.4g}]; the nearest particle is at [{:.4g}, {:.4g}]: low = "
      "[{:.4g}, {:.4g}], high = [{:.4g}, {:.4g}] hold it",
      part.low.x(), part.low.y(), part.high.x(), part.high.y(), nearest.x(), nearest.y(),
      std::floor(1e4 * low.x()) / 1e4, std::floor(1e4 * low.y()) / 1e4, std::ceil(1e4 * high.x()) / 1e4,
      std::ceil(1e4 * high.y()) / 1e4);
}

}  // namespace

void choose_particles(const scene::Scene& scene, const scene::Cloth& cloth, const assets::LoadedMesh& file,
                      const std::string& where, ClothObject& object) {
  const Chooser choose(cloth, file, object);
  const auto part_at = [&](const scene::ClothPart& part, const std::string& key, double least) {
    std::vector<Chosen> chosen = choose.part(part, key);
    std::erase_if(chosen, [&](const Chosen& one) { return one.share < least; });
    if (chosen.empty())
      throw Error(ExitCode::scene_invalid,
                  "{}: expected a part that holds at least one particle, got one that holds none{}", key,
                  nearest_row(part, object));
    return chosen;
  };
  const auto part_of = [&](const scene::ClothPart& part, const char* kind, std::size_t number, double least) {
    return part_at(part, fmt::format("{}.{}.{}", where, kind, number), least);
  };
  for (std::size_t p = 0; p < cloth.pins.size(); ++p) {
    const scene::Pin& pin = cloth.pins[p];
    std::vector<Chosen>& chosen = object.pins.emplace_back(part_of(pin, "pin", p, pin.strength ? kLeastShare : kHeld));
    if (pin.fade > 0) Ways(object).fade(pin.fade, chosen);
  }
  for (std::size_t w = 0; w < cloth.weights.size(); ++w)
    object.weights.push_back(part_of(cloth.weights[w], "weight", w, kLeastShare));
  for (const scene::Attachment& attachment : scene.attachments)
    if (attachment.cloth == cloth.name)
      object.attachments.push_back(
          part_at(attachment, fmt::format("{}: attach.{}", scene.file.string(), attachment.name), kLeastShare));
}

}  // namespace weft::environment
