#include "film/garment/specification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "core/json.hpp"
#include "film/garment/specification_panels.hpp"

namespace weft::garment {
namespace {

using nlohmann::json;
using scene::Findings;

// Upper bound of the absolute value of each number in a list, such as coordinates in units of the file.
constexpr double kMaxSpecCoordinate = 1e5;
constexpr double kDefaultUnitsPerMetre = 100;  // centimetres, for files that state no unit
// In files of the Garment-Pattern-Generator, the predecessor of GarmentCode, the origin lies between pelvis and chest,
// at this height above the floor [m].
constexpr double kPredecessorOrigin = 1.12;
// Measures of the bodies for which patterns of GarmentCode and of its predecessor are drawn [m].
constexpr Measures kBody{.chest = 0.998, .waist = 0.843, .hip = 1.035, .arm = {}, .height = 1.72};
constexpr Measures kPredecessorBody{.chest = 0.98, .waist = 0.81, .hip = 1.04, .arm = {}, .height = 1.66};
// A file counts as one of the predecessor if it has the predecessor's format of curves, or if the lowest height in the
// file is below kMinLowestPanel [m]. The limit is negative, because flat trousers of GarmentCode may end below the
// floor.
constexpr double kMinLowestPanel = -0.2;
// Maximum distance by which a leg panel crosses the middle of the body, relative to the distance of its own middle from
// there. Trousers of the predecessor for legs apart cross by 2 %.
constexpr double kMaxMiddleCrossing = 0.05;
// Minimum height above the floor at which the lowest point of a GarmentCode pattern, and of legs, starts [m].
constexpr double kMinStartHeight = 0.02;

/// The direction along an axis of the drawing (up, down, left or right) that is nearest to `direction`.
Vec2 nearest_axis(const Vec2& direction) {
  return std::abs(direction.x()) > std::abs(direction.y()) ? Vec2(direction.x() > 0 ? 1 : -1, 0)
                                                           : Vec2(0, direction.y() > 0 ? 1 : -1);
}

/// Text of a value for messages, shortened to 40 characters.
std::string text_of(const json& value) {
  return sorted_json_text(value).substr(0, 40);
}

class Reader {
 public:
  Reader(const std::string& text, Findings& findings) : text_(text), findings_(findings) {}

  bool read(Pattern& pattern) {
    json root;
    try {
      root = parse_json<json>(text_);
    } catch (const json::parse_error& error) {
      const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text_.size()));
      const int line = 1 + static_cast<int>(std::count(text_.begin(), end, '\n'));
      findings_.report("", {line, 1, {}}, "expected valid JSON, found an error near here");
      return false;
    } catch (const std::exception& error) {  // numbers beyond the range of double, and excessive depth
      findings_.report("", {1, 1, {}}, fmt::format("expected valid JSON: {}", error.what()));
      return false;
    }
    const json* panels = member(member(&root, "pattern", ""), "panels", "pattern");
    if (panels == nullptr) return false;
    read_properties(root);
    if (!panels->is_object() || panels->empty()) mistake("pattern.panels", "expected panels by name, got none");
    for (const auto& [name, panel] : panels->items()) read_panel(name, panel);
    read_stitches(root["pattern"]);
    if (has_mistakes_) return false;
    for (SpecPanel& panel : panels_) derive_geometry(panel);
    if (const auto ring = find_turned_panels(panels_, stitches_)) {
      mistake(
          fmt::format("pattern.stitches.{}", *ring),
          "expected stitches that keep the same side of each panel outside, got a ring of stitches that turns it over");
      return false;
    }
    assign_parts();
    fill_pattern(pattern);
    shorten_low_legs(pattern);
    place_turned_panels(pattern);
    return true;
  }

 private:
  void mistake(const std::string& key, const std::string& text) {
    has_mistakes_ = true;
    findings_.report(key, text);
  }
  const json* member(const json* of, const char* name, const std::string& path) {
    if (of == nullptr) return nullptr;
    if (of->is_object() && of->contains(name)) return &(*of)[name];
    mistake(path, fmt::format("expected \"{}\" of a specification of GarmentCode, got none", name));
    return nullptr;
  }
  /// The numbers of a list. If `value` is no list of `count` numbers below kMaxSpecCoordinate, reports a mistake for
  /// the key `key` and returns nothing.
  std::optional<std::vector<double>> numbers(const json& value, std::size_t count, const std::string& key) {
    std::vector<double> list;
    if (value.is_array())
      for (const json& each : value)
        if (each.is_number() && std::abs(each.get<double>()) < kMaxSpecCoordinate) list.push_back(each.get<double>());
    if (value.is_array() && list.size() == count && value.size() == count) return list;
    mistake(key, fmt::format("expected {} numbers below {:g}, got {}", count, kMaxSpecCoordinate, text_of(value)));
    return std::nullopt;
  }

  void read_properties(const json& root) {
    if (!root.contains("properties") || !root["properties"].is_object()) return;
    const json& properties = root["properties"];
    if (const auto units = properties.find("units_in_meter"); units != properties.end()) {
      constexpr double kMinUnits = 1e-3, kMaxUnits = 1e6;  // kilometres to micrometres
      const double count = units->is_number() ? units->get<double>() : 0;
      if (!(count >= kMinUnits && count <= kMaxUnits))
        return mistake("properties.units_in_meter", fmt::format("expected a number from {:g} to {:g}, got {}",
                                                                kMinUnits, kMaxUnits, text_of(*units)));
      unit_ = 1 / units->get<double>();
    }
    has_absolute_curvature_ = properties.value("curvature_coords", json("relative")) == "absolute";
  }

  void read_panel(const std::string& name, const json& panel) {
    const std::string path = "pattern.panels." + name;
    if (const std::size_t at = text_.find("\"" + name + "\""); at != std::string::npos) {
      const std::size_t line_start = text_.rfind('\n', at) + 1;
      const auto begin = text_.begin();
      findings_.set_place(path, {1 + static_cast<int>(std::count(begin, begin + static_cast<std::ptrdiff_t>(at), '\n')),
                                 static_cast<int>(at - line_start) + 1,
                                 {}});
    }
    SpecPanel result;
    result.name = name;
    result.words = name;
    if (panel.is_object() && panel.contains("label") && panel["label"].is_string())
      result.words += " " + panel["label"].get<std::string>();
    std::ranges::transform(result.words, result.words.begin(), [](unsigned char c) { return std::tolower(c); });
    const json *vertices = member(&panel, "vertices", path), *edges = member(&panel, "edges", path);
    if (vertices == nullptr || edges == nullptr || !vertices->is_array() || !edges->is_array() || edges->empty())
      return mistake(path, "expected lists of vertices and edges, got other things");
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < vertices->size(); ++i)
      if (const auto p = numbers((*vertices)[i], 2, fmt::format("{}.vertices.{}", path, i)))
        points.emplace_back(unit_ * (*p)[0], unit_ * (*p)[1]);
    for (std::size_t i = 0; i < edges->size() && !has_mistakes_; ++i)
      read_edge((*edges)[i], points, fmt::format("{}.edges.{}", path, i), result.edges);
    if (panel.contains("translation"))
      if (const auto t = numbers(panel["translation"], 3, path + ".translation"))
        result.translation = unit_ * Vec3((*t)[0], (*t)[1], (*t)[2]);
    if (panel.contains("rotation"))
      if (const auto r = numbers(panel["rotation"], 3, path + ".rotation")) {
        result.rotation =
            (Eigen::AngleAxisd(kDegree * (*r)[2], Vec3::UnitZ()) * Eigen::AngleAxisd(kDegree * (*r)[1], Vec3::UnitY()) *
             Eigen::AngleAxisd(kDegree * (*r)[0], Vec3::UnitX()))
                .toRotationMatrix();
      }
    panels_.push_back(std::move(result));
  }

  void read_edge(const json& value, const std::vector<Vec2>& vertices, const std::string& key,
                 std::vector<SpecEdge>& edges) {
    const json* ends = member(&value, "endpoints", key);
    if (ends == nullptr) return;
    const auto numbers_of_ends = numbers(*ends, 2, key + ".endpoints");
    if (!numbers_of_ends) return;
    SpecEdge edge;
    for (const int k : {0, 1}) {
      const double number = (*numbers_of_ends)[static_cast<std::size_t>(k)];
      if (!(number >= 0) || number >= static_cast<double>(vertices.size()) || number != std::floor(number))
        return mistake(key + ".endpoints",
                       fmt::format("expected numbers of vertices below {}, got {:g}", vertices.size(), number));
      (k == 0 ? edge.start : edge.end) = vertices[static_cast<std::size_t>(number)];
    }
    if (!edges.empty() && edges.back().end != edge.start)
      return mistake(key + ".endpoints", "expected edges one after the other around the panel, got a gap before this");
    if (value.contains("curvature")) read_curvature(value["curvature"], key + ".curvature", edge);
    edges.push_back(std::move(edge));
  }

  /// A control point of an edge. If has_absolute_curvature_, `p` has coordinates of the panel; otherwise, coordinates
  /// along the edge and to its left, in units of the edge's length.
  Vec2 control_point(const SpecEdge& edge, const std::vector<double>& p) const {
    if (has_absolute_curvature_) return {unit_ * p[0], unit_ * p[1]};
    const Vec2 along = edge.end - edge.start;
    return edge.start + p[0] * along + p[1] * Vec2(-along.y(), along.x());
  }

  void read_curvature(const json& curvature, const std::string& key, SpecEdge& edge) {
    if (curvature.is_array()) {  // the predecessor's format: one control point
      is_predecessor_ = true;
      if (const auto p = numbers(curvature, 2, key)) edge.control.push_back(control_point(edge, *p));
      return;
    }
    const json *type = member(&curvature, "type", key), *params = member(&curvature, "params", key);
    if (type == nullptr || params == nullptr) return;
    const std::size_t count = *type == "quadratic" ? 1 : *type == "cubic" ? 2 : 0;
    if (*type == "circle") {
      const auto p = numbers(*params, 3, key + ".params");
      if (!p) return;
      edge.radius = unit_ * (*p)[0];
      edge.large_arc = (*p)[1] != 0, edge.sweep = (*p)[2] != 0;
      if (!(edge.radius > 0)) mistake(key + ".params", fmt::format("expected a radius > 0, got {:g}", (*p)[0]));
    } else if (count == 0) {
      mistake(key + ".type", "expected quadratic, cubic or circle, got " + text_of(*type));
    } else if (!params->is_array() || params->size() != count) {
      mistake(key + ".params",
              fmt::format("expected {} control point{}, got {}", count, count == 1 ? "" : "s", text_of(*params)));
    } else {
      for (const json& each : *params)
        if (const auto p = numbers(each, 2, key + ".params")) edge.control.push_back(control_point(edge, *p));
    }
  }

  void read_stitches(const json& pattern) {
    if (!pattern.contains("stitches")) return;
    const json& stitches = pattern["stitches"];
    if (!stitches.is_array())
      return mistake("pattern.stitches", "expected a list of pairs of edges, got " + text_of(stitches));
    for (std::size_t i = 0; i < stitches.size(); ++i) {
      const std::string key = fmt::format("pattern.stitches.{}", i);
      const json& value = stitches[i];
      if (!value.is_array() || value.size() < 2) {
        mistake(key, "expected two edges, got " + text_of(value));
        continue;
      }
      SpecStitch stitch;
      stitch.right_wrong = value.size() > 2 && value[2] == "right_wrong";
      bool found = true;
      for (const std::size_t k : {0, 1}) found &= find_edge(value[k], key, stitch.panel[k], stitch.edge[k]);
      if (found) stitches_.push_back(stitch);
    }
  }
  bool find_edge(const json& side, const std::string& key, std::size_t& panel, std::size_t& edge) {
    const bool named = side.is_object() && side.contains("panel") && side["panel"].is_string() &&
                       side.contains("edge") && side["edge"].is_number_unsigned();
    if (!named) {
      mistake(key, "expected panel and edge, got " + text_of(side));
      return false;
    }
    const auto name = side["panel"].get<std::string>();
    edge = side["edge"].get<std::size_t>();
    panel = static_cast<std::size_t>(std::ranges::find(panels_, name, &SpecPanel::name) - panels_.begin());
    if (panel < panels_.size() && edge < panels_[panel].edges.size()) return true;
    if (!has_mistakes_) mistake(key, fmt::format("expected an edge of a panel, got {} of \"{}\"", edge, name));
    return false;
  }

  bool mentions(const SpecPanel& panel, std::initializer_list<const char*> words) const {
    return std::ranges::any_of(words, [&](const char* w) { return panel.words.find(w) != std::string::npos; });
  }
  /// Whether a panel belongs to a leg: it lies on one side of the body, and an edge near the inside of the leg is sewn
  /// to a panel on the same side that faces in the opposite direction.
  bool has_inseam(std::size_t p) const {
    const SpecPanel& panel = panels_[p];
    double inner = std::numeric_limits<double>::infinity(), outer = 0, low = inner, high = -inner;
    for (const auto& points : panel.points)
      for (const Vec2& each : points) {
        const Vec3 x = panel.in_space(each);
        // The panel crosses the middle of the body, by more than the rise of trousers that are drawn with spread legs.
        if (x.x() * panel.middle.x() < -kMaxMiddleCrossing * panel.middle.x() * panel.middle.x()) return false;
        inner = std::min(inner, std::abs(x.x())), outer = std::max(outer, std::abs(x.x()));
        low = std::min(low, x.y()), high = std::max(high, x.y());
      }
    return std::ranges::any_of(stitches_, [&](const SpecStitch& stitch) {
      for (const std::size_t k : {0, 1}) {
        const SpecPanel& other = panels_[stitch.panel[1 - k]];
        if (stitch.panel[k] != p || stitch.panel[1 - k] == p) continue;
        if (other.middle.x() * panel.middle.x() <= 0 || other.outward.z() * panel.outward.z() >= 0) continue;
        const auto& points = panel.points[stitch.edge[k]];
        const Vec3 x = panel.in_space(points[points.size() / 2]);
        if (std::abs(x.x()) < inner + 0.35 * (outer - inner) && x.y() < low + 0.6 * (high - low)) return true;
      }
      return false;
    });
  }

  void assign_parts() {
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      SpecPanel& panel = panels_[p];
      const bool left = panel.middle.x() > 0;
      const bool trousers = mentions(panel, {"pant", "trouser"});
      if (!trousers && mentions(panel, {"sleeve", "sl_", " arm", "cuff"}))
        panel.around = left ? Around::left_arm : Around::right_arm;
      else if (trousers || has_inseam(p))
        panel.around = left ? Around::left_leg : Around::right_leg;
      else if (mentions(panel, {"hood"}))
        panel.around = Around::head;
      else if (mentions(panel, {"collar", "turtle"}))
        panel.around = Around::neck;
    }
    // Sets SpecPanel::limbs_to_trunk by a breadth-first search along stitches from the trunk.
    for (int step = 0; step < static_cast<int>(panels_.size()); ++step)
      for (const SpecStitch& stitch : stitches_)
        for (const std::size_t k : {0, 1}) {
          SpecPanel& panel = panels_[stitch.panel[k]];
          const SpecPanel& other = panels_[stitch.panel[1 - k]];
          if (panel.is_limb() && panel.limbs_to_trunk < 0 &&
              (other.is_limb() ? step > 0 && other.limbs_to_trunk == step - 1 : step == 0))
            panel.limbs_to_trunk = step;
        }
  }

  /// Direction toward the trunk in the drawing of an arm panel. Files draw arm panels in any of four orientations.
  /// Therefore the direction is derived from the edges that are sewn to the trunk or to a limb panel nearer to the
  /// trunk. Returns (0, 1) if there are no such edges.
  Vec2 direction_to_trunk(std::size_t p) const {
    const SpecPanel& panel = panels_[p];
    Vec2 cap(0, 0);
    double count = 0;
    for (const SpecStitch& stitch : stitches_)
      for (const std::size_t k : {0, 1}) {
        const SpecPanel& other = panels_[stitch.panel[1 - k]];
        if (stitch.panel[k] != p || (other.is_limb() && other.limbs_to_trunk >= panel.limbs_to_trunk)) continue;
        for (const Vec2& x : panel.points[stitch.edge[k]]) cap += x, ++count;
      }
    if (count == 0) return {0, 1};
    cap /= count;
    Vec2 low = panel.points[0][0], high = low;
    for (const auto& points : panel.points)
      for (const Vec2& x : points) low = low.cwiseMin(x), high = high.cwiseMax(x);
    return nearest_axis((cap - 0.5 * (low + high)).cwiseQuotient((high - low).cwiseMax(kRoundoff)));
  }

  /// The linear map from the drawing of a panel to its orientation when worn, seen from outside with y up.
  Eigen::Affine2d map_to_worn(std::size_t p) const {
    const SpecPanel& panel = panels_[p];
    const Vec2 mirror(panel.mirrored ? -1 : 1, 1);
    Vec2 up(0, 1);
    // Files may draw legs apart, at an angle to the vertical. Such a panel starts upright.
    if (is_arm(panel.around))
      up = direction_to_trunk(p).cwiseProduct(mirror);
    else if (const Vec2 height(mirror.x() * panel.rotation(1, 0), panel.rotation(1, 1)); height.norm() > 0.1)
      up = panel.is_limb() ? nearest_axis(height) : height.normalized();
    Eigen::Matrix2d turn;
    turn << up.y(), -up.x(), up.x(), up.y();
    Eigen::Affine2d map = Eigen::Affine2d::Identity();
    map.linear() = turn * mirror.asDiagonal();
    return map;
  }

  void fill_pattern(Pattern& pattern) {
    // Heights in space of the lowest point, of the lowest point apart from legs, and of the highest point [m].
    double lowest = std::numeric_limits<double>::infinity(), lowest_without_legs = lowest, highest = -lowest;
    for (const SpecPanel& panel : panels_)
      for (const auto& points : panel.points)
        for (const Vec2& p : points) {
          const double height = panel.in_space(p).y();
          lowest = std::min(lowest, height), highest = std::max(highest, height);
          if (!panel.is_leg()) lowest_without_legs = std::min(lowest_without_legs, height);
        }
    const bool from_predecessor = is_predecessor_ || lowest < kMinLowestPanel;
    // Templates of the predecessor are up to a quarter narrower than its body.
    pattern.measures =
        from_predecessor ? limit_to_panels(kPredecessorBody, panels_, stitches_, -kPredecessorOrigin) : kBody;
    // Trousers are drawn lower than they are worn. If a GarmentCode pattern would start lower than kMinStartHeight, it
    // is raised to this height. A jumpsuit is drawn at its height: only its legs are too long (shorten_low_legs()).
    const bool hangs_from_shoulders = highest > 0.5 * (kWaistHeightRatio + kNeckHeightRatio) * *kBody.height;
    const double floor = from_predecessor
                             ? -kPredecessorOrigin
                             : std::min(0.0, (hangs_from_shoulders ? lowest_without_legs : lowest) - kMinStartHeight);
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      SpecPanel& of = panels_[p];
      findings_.add_entry("panel", "pattern.panels." + of.name);
      Panel panel;
      panel.name = of.name;
      panel.around = of.around;
      // Panels of limbs start at the front or the back, unless they face sideways.
      const bool sideways = std::abs(of.outward.z()) < 0.5;
      double angle = std::atan2(of.outward.x(), of.outward.z());
      if (of.is_limb() && !sideways) angle = of.outward.z() > 0 ? 0 : std::numbers::pi;
      if (std::hypot(of.outward.x(), of.outward.z()) < 0.1) angle = std::atan2(of.middle.x(), of.middle.z());
      panel.angle = std::round(angle / kDegree * 1e6) * 1e-6;
      Eigen::Affine2d map = map_to_worn(p);
      const Vec3 across(std::cos(angle), 0, -std::sin(angle));
      panel.position = Vec2(across.dot(of.translation), of.translation.y() - floor);
      if (of.is_limb()) {
        // Centres the lower end of a limb panel on the axis of the limb.
        double low = std::numeric_limits<double>::infinity();
        std::vector<Vec2> points;
        for (const auto& each : of.points)
          for (const Vec2& x : each) points.emplace_back(map * x), low = std::min(low, points.back().y());
        double left = std::numeric_limits<double>::infinity(), right = -left;
        for (const Vec2& x : points)
          if (x.y() < low + 0.02) left = std::min(left, x.x()), right = std::max(right, x.x());
        map.pretranslate(Vec2(-0.5 * (left + right), 0));
        panel.position->x() = 0;
      }
      // Seams determine the positions of panels around arms and neck, because bodies differ too much there for the
      // positions of the file.
      if (is_arm(of.around) || of.around == Around::neck) panel.position.reset();
      panel.path = path_of(of, map);
      panel.turned = of.turned;
      of.worn = map;
      for (std::size_t e = 0; e < of.edges.size(); ++e)
        if (of.edges[e].has_length()) panel.edge_names += fmt::format("{} ", e);
      pattern.panels.push_back(std::move(panel));
    }
    for (std::size_t s = 0; s < stitches_.size(); ++s) {
      const auto& p = stitches_[s].panel;
      const auto& e = stitches_[s].edge;
      if (!panels_[p[0]].edges[e[0]].has_length() || !panels_[p[1]].edges[e[1]].has_length()) continue;
      findings_.add_entry("seam", fmt::format("pattern.stitches.{}", s));
      Seam& seam = pattern.seams.emplace_back();
      seam.a = fmt::format("{}.{}", panels_[p[0]].name, e[0]);
      seam.b = fmt::format("{}.{}", panels_[p[1]].name, e[1]);
    }
  }

  /// If legs would start below kMinStartHeight, shortens the start of all leg panels to end there. The highest point of
  /// the legs keeps its height.
  void shorten_low_legs(Pattern& pattern) const {
    double low = kMinStartHeight, high = low;
    for (std::size_t p = 0; p < panels_.size(); ++p)
      for (const auto& points : panels_[p].points)
        for (const Vec2& x : points) {
          if (!panels_[p].is_leg()) continue;
          const double height = pattern.panels[p].position->y() + (panels_[p].worn * x).y();
          low = std::min(low, height), high = std::max(high, height);
        }
    if (!(low < kMinStartHeight - kRoundoff && kMinStartHeight < high)) return;
    const double factor = (high - kMinStartHeight) / (high - low);
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      if (!panels_[p].is_leg()) continue;
      Panel& panel = pattern.panels[p];
      panel.scale.y() = factor;
      panel.position->y() = high - factor * (high - panel.position->y());
    }
  }

  /// Places each turned panel one layer above the panels to which right_wrong stitches join it. Both edges of such a
  /// stitch run in the same direction, so that their points correspond in order.
  void place_turned_panels(Pattern& pattern) const {
    for (std::size_t p = 0; p < panels_.size(); ++p) {
      Panel& panel = pattern.panels[p];
      std::vector<Vec2> own, other;
      for (const SpecStitch& stitch : stitches_)
        for (const std::size_t k : {0, 1}) {
          const std::size_t q = stitch.panel[1 - k];
          const Panel& under = pattern.panels[q];
          if (stitch.panel[k] != p || !stitch.right_wrong || !panels_[p].turned || !under.position) continue;
          panel.around = under.around, panel.angle = under.angle, panel.layer = under.layer + 1;
          for (const Vec2& x : ends_as_worn(p, stitch.edge[k])) own.push_back(x);
          for (const Vec2& x : ends_as_worn(q, stitch.edge[1 - k])) other.push_back(*under.position + x);
        }
      if (own.empty()) continue;
      // Finds the rigid motion in the plane that maps the edges of the turned panel to those of the panels below it, by
      // least squares (W. Kabsch, "A solution for the best rotation to relate two sets of vectors", 1976).
      const auto count = static_cast<double>(own.size());
      const Vec2 from = std::accumulate(own.begin(), own.end(), Vec2(0, 0)) / count;
      const Vec2 to = std::accumulate(other.begin(), other.end(), Vec2(0, 0)) / count;
      double along = 0, across = 0;
      for (std::size_t i = 0; i < own.size(); ++i) {
        const Vec2 a = own[i] - from, b = other[i] - to;
        along += a.dot(b), across += a.x() * b.y() - a.y() * b.x();
      }
      panel.rotation = std::atan2(across, along) / kDegree;
      panel.position = to - Eigen::Rotation2Dd(panel.rotation * kDegree) * from;
    }
  }
  /// Start, middle and end of an edge in the orientation of map_to_worn().
  std::array<Vec2, 3> ends_as_worn(std::size_t p, std::size_t e) const {
    const auto& points = panels_[p].points;
    const Eigen::Affine2d& worn = panels_[p].worn;
    return {worn * points[e][0], worn * points[e][points[e].size() / 2], worn * points[(e + 1) % points.size()][0]};
  }

  const std::string& text_;
  Findings& findings_;
  double unit_ = 1 / kDefaultUnitsPerMetre;  // unit of the file [m]
  bool has_absolute_curvature_ = false, is_predecessor_ = false, has_mistakes_ = false;
  std::vector<SpecPanel> panels_;
  std::vector<SpecStitch> stitches_;
};

}  // namespace

bool read_specification(const std::string& text, Findings& findings, Pattern& pattern) {
  return Reader(text, findings).read(pattern);
}

}  // namespace weft::garment
