#include "film/garment/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "film/garment/specification.hpp"
#include "film/garment/svg.hpp"
#include "film/garment/triangulation.hpp"
#include "film/scene/document.hpp"
#include "film/scene/reader.hpp"
#include "film/scene/table_builder.hpp"

namespace weft::garment {
namespace {

using scene::Findings;
using scene::Need;
using scene::Table;
using scene::TableBuilder;
using scene::Type;
using scene::within;

// Maximum distance of control points of a fold edge from a straight line, as a fraction of the edge's length. It is not
// 0, because coordinates are rounded.
constexpr double kMaxFoldDeviation = 1e-3;
// Maximum width and height of a panel [m].
constexpr double kMaxPanelSize = 100;

const Table& panel_rules() {
  static const Table kFabric =
      TableBuilder<mesh::Reinforcement>(
          "The fabric of a panel relative to that of the garment, as for fused or heavier panels.")
          .number("stretch", &mesh::Reinforcement::stretch, scene::above(0, 1000), "",
                  "factor on the stiffness against stretch and shear")
          .number("bend", &mesh::Reinforcement::bend, scene::above(0, 1000), "",
                  "factor on the stiffness against bending")
          .number("density", &mesh::Reinforcement::density, scene::above(0, 1000), "", "factor on the mass")
          .build();
  static const Table kTable =
      TableBuilder<Panel>(
          "A flat piece of cloth. With a side, it is drawn as seen from in front of the wearer, otherwise as seen from "
          "outside.")
          .plain(Type::name, "name", &Panel::name, "unique name of the panel")
          .need(Need::required)
          .choice_by(
              "side", {"front", "back"}, "side of the wearer, or of the part, that it covers",
              [](Panel& p) { return static_cast<std::size_t>(p.side.value_or(Side::front)); },
              [](Panel& p, std::size_t index) { p.side = static_cast<Side>(index); })
          .by_default("front")
          .excludes("angle")
          .choice_by(
              "around", std::vector<std::string>(kAroundNames.begin() + 1, kAroundNames.end()),
              "part of the wearer around which the panel starts bent; if any panel of the pattern has this key, torso "
              "is the part of the others",
              [](Panel& p) { return static_cast<std::size_t>(p.around) - 1; },
              [](Panel& p, std::size_t index) { p.around = static_cast<Around>(index + 1); })
          .by_default("none: panels start flat")
          .number("angle", &Panel::angle, within(-360, 360), "degrees",
                  "angle around its part at which the panel's origin starts: 0 is the front, 90 the wearer's left, 180 "
                  "the back; the panel is drawn as seen from outside")
          .by_default("for arms the outside, else that of `side`")
          .excludes("side")
          .whole_number("layer", &Panel::layer, within(0, 20),
                        "number of panels of the same part, or of flat ones of the same side, that it starts above")
          .plain(Type::text, "path", &Panel::path, "closed outline as SVG path data, in metres, y upward")
          .excludes("file")
          .plain(Type::file, "file", &Panel::file, "SVG drawing with the outline; relative to the pattern's folder")
          .excludes("path")
          .plain(
              Type::text, "id", &Panel::id,
              "id or label, in the drawing, of the outline, or of a group with one outline and texts that name edges")
          .plain(Type::text, "mirror_of", &Panel::mirror_of,
                 "an earlier panel whose mirror image this one is; keys that are not given are taken from it, with "
                 "left and right exchanged")
          .plain(
              Type::text, "edges", &Panel::edge_names,
              "names of the curves of the outline, in their order, or in a drawing of its edges from corner to corner; "
              "neighbours with the same name are one edge")
          .by_default("those in the drawing, else 1 2 3 and so on")
          .plain(Type::text, "fold", &Panel::fold,
                 "straight edge at which the outline is half of a panel cut on the fold: the panel gets the mirror "
                 "image too; its edges are named with left and right, or _l and _r, exchanged, or with _2 appended; "
                 "edges that meet the fold continue")
          .by_default("none")
          .number("grain", &Panel::grain, within(-360, 360), "degrees",
                  "direction of the warp, counter-clockwise from the panel's y axis")
          .vector("position", &Panel::position, {"across", "up"}, within(-100, 100), "m",
                  "position of the panel's origin at the start: across, along the skin from its angle; up, above the "
                  "floor, on arms above the shoulder")
          .by_default("[0, 0]; for a bent panel, where its seams are shortest")
          .number("rotation", &Panel::rotation, within(-360, 360), "degrees",
                  "rotation at the start, counter-clockwise as seen from in front")
          .vector("scale", &Panel::scale, {"across", "up"}, scene::above(0, 10), "",
                  "factor on the lengths at the start")
          .single_fills_all()
          .table("fabric", &Panel::reinforcement, kFabric)
          .build();
  return kTable;
}

// Appends the edge name of each curve to `names`; all pieces of an arc get the same name. `text` has one name per
// curve. In a drawing (`drawn`), it may instead have one name per edge from corner to corner, because drawing programs
// split edges into many curves. If `text` is empty, the names are 1, 2, 3 and so on, one per curve. Returns a
// description of a mistake, or an empty string.
std::string name_curves(const std::string& text, const Outline& outline, bool drawn, std::vector<std::string>& names) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  const auto curves = static_cast<std::size_t>(std::ranges::count(outline, false, &Curve::continues_arc));
  const std::vector<std::size_t> edge = edges_between_corners(outline);
  const std::size_t edges = *std::ranges::max_element(edge) + 1;
  const bool by_edge = drawn && words.size() == edges && edges != curves;
  if (words.empty())
    for (std::size_t i = 1; i <= curves; ++i) words.push_back(std::to_string(i));
  if (!by_edge && words.size() != curves)
    return fmt::format(
        "expected {} names, one for each curve{}, got {}", curves,
        drawn && edges != curves ? fmt::format(", or {}, one for each edge from corner to corner", edges) : "",
        words.size());
  std::size_t word = 0;
  for (std::size_t k = 0; k < outline.size(); ++k)
    names.push_back(words[by_edge ? edge[k] : outline[k].continues_arc ? word - 1 : word++]);
  return {};
}

// Joins neighbouring curves of the same name into edges. The first edge starts at the first change of name.
std::vector<PanelEdge> join_named_curves(const Outline& outline, const std::vector<std::string>& names) {
  const std::size_t n = outline.size();
  std::size_t first = 0;
  while (first < n && names[first] == names[(first + n - 1) % n]) ++first;
  std::vector<PanelEdge> edges;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (first + i) % n;
    if (i == 0 || edges.back().name != names[k]) edges.push_back({names[k], {}});
    edges.back().curves.push_back(outline[k]);
  }
  return edges;
}

/// Name of the mirror image of an edge across a fold.
std::string name_across_fold(const std::string& name) {
  for (const auto& [one, other] : {std::pair{"left", "right"}, std::pair{"right", "left"}})
    if (const std::size_t at = name.find(one); at != std::string::npos)
      return std::string(name).replace(at, std::string_view(one).size(), other);
  for (const auto& [one, other] : {std::pair{"_l", "_r"}, std::pair{"_r", "_l"}})
    if (name.ends_with(one)) return name.substr(0, name.size() - 2) + other;
  return name + "_2";
}

/// Completes a panel whose outline is only one half: removes the edge named `fold` and appends the mirror image of the
/// other edges. An edge that ends at the fold and its mirror image become one edge. Returns a description of a mistake,
/// or an empty string.
std::string unfold(const std::string& fold, Outline& outline, std::vector<std::string>& names) {
  const std::size_t n = outline.size();
  std::size_t first = 0;
  while (first < n && (names[first] != fold || names[(first + n - 1) % n] == fold)) ++first;
  if (first == n) return fmt::format("expected the name of an edge, got {}", scene::in_quotes(fold));
  std::size_t count = 1;
  while (count < n && names[(first + count) % n] == fold) ++count;
  const Vec2 a = outline[first].start(), b = outline[(first + count - 1) % n].end();
  const Vec2 along = (b - a).normalized();
  const auto off = [&](const Vec2& p) { return along.x() * (p - a).y() - along.y() * (p - a).x(); };
  for (std::size_t i = 0; i < count; ++i)
    for (const Vec2& p : outline[(first + i) % n].control)
      if (!(std::abs(off(p)) <= kMaxFoldDeviation * (b - a).norm()))
        return fmt::format("expected a straight edge, got one that is {:.3g} m off a line", std::abs(off(p)));
  Outline whole;
  std::vector<std::string> named;
  for (std::size_t i = count; i < n; ++i) {
    whole.push_back(outline[(first + i) % n]);
    named.push_back(names[(first + i) % n]);
  }
  const std::string at_b = named.front(), at_a = named.back();
  for (std::size_t i = named.size(); i-- > 0;) {
    Curve other = whole[i].reversed();
    for (Vec2& p : other.control) p -= 2 * off(p) * Vec2(-along.y(), along.x());
    whole.push_back(other);
    named.push_back(named[i] == at_a || named[i] == at_b ? named[i] : name_across_fold(named[i]));
  }
  outline = std::move(whole);
  names = std::move(named);
  return {};
}

/// Completes `panel`, a mirror image of `from`: copies the keys that it lacks, with left and right exchanged. `entry`:
/// key path of `panel`.
void copy_from_original(const Panel& from, const std::string& entry, const Findings& findings, Panel& panel) {
  const auto is_given = [&](const char* key) { return findings.has(fmt::format("{}.{}", entry, key)); };
  panel.path = from.path, panel.file = from.file, panel.id = from.id;
  if (!is_given("edges")) panel.edge_names = from.edge_names;
  if (!is_given("fold")) panel.fold = from.fold;
  if (!panel.side && !panel.angle) {
    panel.side = from.side;
    if (from.angle) panel.angle = -*from.angle;
  }
  if (!is_given("around")) panel.around = mirrored(from.around);
  if (!is_given("layer")) panel.layer = from.layer;
  if (!is_given("grain")) panel.grain = -from.grain;
  if (!is_given("rotation")) panel.rotation = -from.rotation;
  if (!is_given("scale")) panel.scale = from.scale;
  if (!panel.position && from.position) panel.position = Vec2(-from.position->x(), from.position->y());
  if (!is_given("fabric.stretch")) panel.reinforcement.stretch = from.reinforcement.stretch;
  if (!is_given("fabric.bend")) panel.reinforcement.bend = from.reinforcement.bend;
  if (!is_given("fabric.density")) panel.reinforcement.density = from.reinforcement.density;
}

/// Reads the outline of a panel. If there is a mistake, returns nothing, and reports the mistake to
/// `in_drawings` if the outline is in a drawing, else to `findings`.
std::optional<DrawnPanel> read_outline(const Panel& panel, const std::string& path, Findings& findings,
                                       std::vector<std::string>& in_drawings) {
  if (panel.path.empty()) try {
      return load_svg_panel(panel.file, panel.id);
    } catch (const Error& error) {
      // Reports a message only once, because all panels of an unreadable drawing cause the same message.
      if (std::ranges::find(in_drawings, error.what()) == in_drawings.end()) in_drawings.emplace_back(error.what());
      return std::nullopt;
    }
  ParsedPath parsed = parse_path(panel.path);
  if (parsed.mistake.empty()) return DrawnPanel{std::move(parsed.outline), {}};
  findings.report(path + ".path", parsed.mistake);
  return std::nullopt;
}

/// Completes panel `i` from its original, if it is a mirror image.
void complete_mirror_image(std::vector<Panel>& panels, std::size_t i, Findings& findings) {
  Panel& panel = panels[i];
  if (panel.mirror_of.empty()) return;
  const std::string& entry = findings.entry("panel", i);
  const std::string key = entry + ".mirror_of";
  if (!panel.path.empty() || !panel.file.empty() || !panel.id.empty())
    return findings.report(key, "expected an outline of its own or of another panel, got both");
  std::vector<std::string> known;
  for (std::size_t k = 0; k < i; ++k) {
    if (!panels[k].mirror_of.empty()) continue;
    if (panels[k].name == panel.mirror_of) return copy_from_original(panels[k], entry, findings, panel);
    known.push_back(panels[k].name);
  }
  findings.report(key, fmt::format("expected a panel before it that has an outline, got {}{}",
                                   scene::in_quotes(panel.mirror_of), scene::suggestion(panel.mirror_of, known)));
}

/// Derives the edges of a panel from its outline, and reports mistakes in the outline.
void derive_edges(Panel& panel, const std::string& path, Findings& findings, std::vector<std::string>& in_drawings) {
  if (panel.path.empty() == panel.file.empty()) {
    if (!panel.mirror_of.empty()) return;  // the mistake in the original is already reported
    if (!findings.has_mistake(path + ".path") && !findings.has_mistake(path + ".file"))
      findings.report(path, "expected an outline, as path, as file and id or as mirror_of, got none");
    return;
  }
  const std::string key = panel.path.empty() ? path + ".file" : path + ".path";
  std::optional<DrawnPanel> drawn = read_outline(panel, path, findings, in_drawings);
  if (!drawn) return;
  auto& [outline, names] = *drawn;
  if (!panel.mirror_of.empty())
    for (Curve& curve : outline)
      for (Vec2& p : curve.control) p.x() = -p.x();
  if (names.empty() || !panel.edge_names.empty()) {
    names.clear();
    if (const std::string mistake = name_curves(panel.edge_names, outline, panel.path.empty(), names); !mistake.empty())
      return findings.report(path + ".edges", mistake);
  }
  if (!panel.fold.empty())
    if (const std::string mistake = unfold(panel.fold, outline, names); !mistake.empty())
      return findings.report(path + ".fold", mistake);
  const std::vector<Vec2> points = sample_points(outline);
  Vec2 low = points[0], high = points[0];
  for (const Vec2& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  if ((high - low).maxCoeff() > kMaxPanelSize)
    return findings.report(key, fmt::format("expected a panel of at most {} m, got one of {:.4g} m", kMaxPanelSize,
                                            (high - low).maxCoeff()));
  if (const auto crossing = self_crossing(points))
    return findings.report(
        key, fmt::format("expected an outline that does not cross itself, got a crossing near "
                         "({:.4g}, {:.4g}) m, of the edges {} and {}",
                         points[crossing->first].x(), points[crossing->first].y(),
                         names[crossing->first / kPointsPerCurve], names[crossing->second / kPointsPerCurve]));
  if (polygon_area(points) < 0) {
    std::ranges::reverse(outline);
    std::ranges::reverse(names);
    for (Curve& curve : outline) curve = curve.reversed();
  }
  panel.edges = join_named_curves(outline, names);
  std::set<std::string> seen;
  for (const PanelEdge& edge : panel.edges)
    if (!seen.insert(edge.name).second)
      findings.report(path + ".edges", fmt::format("expected curves of one name side by side, got {} apart",
                                                   scene::in_quotes(edge.name)));
}

/// Checks that names of edges exist, and that no edge is in two seams.
class EdgeNames {
 public:
  EdgeNames(const Pattern& pattern, Findings& findings) : findings_(findings) {
    for (const Panel& panel : pattern.panels) {
      has_invalid_panel_ |= panel.edges.empty();
      for (const PanelEdge& edge : panel.edges) known_.push_back(panel.name + "." + edge.name);
    }
  }
  void check(const std::string& name, const std::string& key) {
    // A panel with a mistake in its outline has no edges. If there is such a panel, unknown edges are not reported,
    // because they may be edges of this panel, whose mistake is already reported.
    if (has_invalid_panel_ || findings_.has_mistake(key) || std::ranges::find(known_, name) != known_.end()) return;
    findings_.report(key, fmt::format("expected an edge such as {}, got {}{}", known_.empty() ? "front.hem" : known_[0],
                                      scene::in_quotes(name), scene::suggestion(name, known_)));
  }
  void check_sewn_once(const std::string& name, const std::string& key) {
    check(name, key);
    if (!sewn_.insert(name).second && !findings_.has_mistake(key))
      findings_.report(key, fmt::format("expected each edge in one seam, got {} again", scene::in_quotes(name)));
  }

 private:
  Findings& findings_;
  std::vector<std::string> known_;
  std::set<std::string> sewn_;
  bool has_invalid_panel_ = false;
};

void check(Pattern& pattern, Findings& findings, std::vector<std::string>& in_drawings) {
  if (pattern.panels.empty() && !findings.has("panel"))
    findings.report("", "expected at least one [[panel]], got none");
  for (std::size_t i = 0; i < pattern.panels.size(); ++i) complete_mirror_image(pattern.panels, i, findings);
  for (std::size_t i = 0; i < pattern.panels.size(); ++i)
    derive_edges(pattern.panels[i], findings.entry("panel", i), findings, in_drawings);
  EdgeNames names(pattern, findings);
  for (std::size_t i = 0; i < pattern.seams.size(); ++i) {
    const std::string entry = findings.entry("seam", i);
    names.check_sewn_once(pattern.seams[i].a, entry + ".a");
    names.check_sewn_once(pattern.seams[i].b, entry + ".b");
    if (pattern.seams[i].tearing_load && findings.has(entry + ".strength"))
      findings.report(entry + ".strength", "expected either strength or tearing_load, got both");
  }
  for (std::size_t i = 0; i < pattern.elastics.size(); ++i)
    names.check(pattern.elastics[i].edge, findings.entry("elastic", i) + ".edge");
  for (std::size_t i = 0; i < pattern.hems.size(); ++i)
    names.check(pattern.hems[i].edge, findings.entry("hem", i) + ".edge");
}

}  // namespace

bool Pattern::has_bent_panels() const {
  return std::ranges::any_of(panels, [](const Panel& p) { return p.around != Around::none || p.angle; });
}

const scene::Table& pattern_rules() {
  static const Table kSeams =
      TableBuilder<Seam>(
          "Two edges that are sewn together. With buttons, open, closed or tearing_load, it is a closure, which holds "
          "them "
          "together while it is closed.")
          .plain(Type::text, "a", &Seam::a, "one edge, as panel.edge")
          .need(Need::required)
          .plain(Type::text, "b", &Seam::b, "the other edge, of any panel")
          .need(Need::required)
          .whole_number("buttons", &Seam::buttons, within(0, 1000),
                        "number of buttons that hold the edges together, evenly from end to end, none at an end that "
                        "is sewn; 0: a zip, or a sewn seam")
          .number("open", &Seam::open, within(-1e6, 1e6), "s", "time of the scene from which the closure is open")
          .by_default("never")
          .number("closed", &Seam::closed, within(-1e6, 1e6), "s",
                  "time of the scene from which the closure is closed; before the earlier of both times, it is in the "
                  "other state")
          .by_default("never")
          .number("strength", &Seam::strength, scene::above(0, 1e4), "N",
                  "maximum force of each button, or of each point of a zip")
          .number("tearing_load", &Seam::tearing_load, scene::above(0, 1e6), "N/m",
                  "load per length at which the seam tears, point by point; 300: seams of light clothes")
          .by_default("never")
          .number("allowance", &Seam::allowance, within(0, 1), "m",
                  "width of the cloth turned in along the seam, both sides together; it has mass and resists stretch "
                  "like other cloth")
          .build();
  static const Table kElastics =
      TableBuilder<Elastic>("An elastic band along an edge.")
          .plain(Type::text, "edge", &Elastic::edge, "the edge, as panel.edge")
          .need(Need::required)
          .number("ratio", &Elastic::ratio, within(0.1, 1), "", "rest length of the band, relative to that of the edge")
          .number("stiffness", &Elastic::stiffness, within(0, 1e6), "N", "force per strain of the band")
          .build();
  static const Table kHems =
      TableBuilder<Hem>("A hem along an edge: heavier and stiffer than the cloth.")
          .plain(Type::text, "edge", &Hem::edge, "the edge, as panel.edge")
          .need(Need::required)
          .number("mass", &Hem::mass, within(0, 100), "kg/m", "mass per length, in addition to that of the cloth")
          .number("bend", &Hem::bend, within(0, 1), "N·m²", "stiffness against bending of the edge")
          .build();
  static const Table kMeasures =
      TableBuilder<Measures>(
          "Measures of the body for which the pattern is drawn; with `fit` of a scene's cloth, the pattern is scaled "
          "from them.")
          .number("chest", &Measures::chest, scene::above(0, 100), "m", "largest girth below the armpits")
          .by_default("not given")
          .number("waist", &Measures::waist, scene::above(0, 100), "m", "smallest girth of the trunk")
          .by_default("not given")
          .number("hip", &Measures::hip, scene::above(0, 100), "m", "largest girth below the waist")
          .by_default("not given")
          .number("arm", &Measures::arm, scene::above(0, 100), "m",
                  "girth of the upper arms in their middle; sleeves and armholes give way to thicker arms")
          .by_default("not given")
          .number("height", &Measures::height, scene::above(0, 100), "m",
                  "height from the floor to the top of the head")
          .by_default("not given")
          .build();
  static const Table kTable =
      TableBuilder<Pattern>("A sewing pattern.")
          .number("depth", &Pattern::depth, scene::above(0, 10), "m",
                  "distance of flat panels in front of and behind the middle of the wearer at the start")
          .number("gap", &Pattern::gap, scene::above(0, 1), "m",
                  "distance from the skin of panels that start bent around the wearer")
          .table("measures", &Pattern::measures, kMeasures)
          .list(Type::list, "panel", &Pattern::panels, panel_rules())
          .list(Type::list, "seam", &Pattern::seams, kSeams)
          .list(Type::list, "elastic", &Pattern::elastics, kElastics)
          .list(Type::list, "hem", &Pattern::hems, kHems)
          .build();
  return kTable;
}

void Pattern::scale_by(const Vec2& factors, double rise) {
  depth *= factors.x();
  const bool flat = !has_bent_panels();
  for (Panel& panel : panels) {
    if (flat && rise != 0 && !panel.position) panel.position = Vec2(0, 0);  // where such a panel starts
    if (panel.position)
      *panel.position = panel.position->cwiseProduct(factors) + Vec2(0, is_arm(panel.around) ? 0 : rise);
    const Eigen::Rotation2Dd turn(panel.rotation * std::numbers::pi / 180);
    const bool turns = panel.rotation != 0 && factors.x() != factors.y();
    for (PanelEdge& edge : panel.edges)
      for (Curve& curve : edge.curves)
        for (Vec2& p : curve.control)
          p = turns ? Vec2(turn.inverse() * Vec2((turn * p).cwiseProduct(factors))) : Vec2(p.cwiseProduct(factors));
  }
}

std::pair<std::size_t, std::size_t> Pattern::find(const std::string& name) const {
  for (std::size_t p = 0; p < panels.size(); ++p)
    for (std::size_t e = 0; e < panels[p].edges.size(); ++e)
      if (panels[p].name + "." + panels[p].edges[e].name == name) return {p, e};
  throw Error(ExitCode::internal, "pattern {}: no edge {}", file.string(), name);
}

namespace {

ReadPattern read_and_check(const std::filesystem::path& file) {
  Findings findings;
  ReadPattern read;
  std::vector<std::string> in_drawings;
  read.pattern.file = file;
  if (const auto text = scene::read_file(file, findings)) {
    bool parsed = false;
    std::string ending = file.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (ending == ".json") {
      parsed = read_specification(*text, findings, read.pattern);
    } else if (const auto document = scene::parse(*text, findings)) {
      scene::Reader(findings, file.parent_path()).read(*document, pattern_rules(), &read.pattern, "");
      parsed = true;
    }
    if (parsed) check(read.pattern, findings, in_drawings);
  }
  scene::LoadResult result;
  result.file = file;
  result.mistakes = findings.take_mistakes();
  std::istringstream lines(result.describe());
  for (std::string line; std::getline(lines, line);) read.mistakes.push_back(line);
  read.only_in_drawings = read.mistakes.empty() && !in_drawings.empty();
  read.mistakes.insert(read.mistakes.end(), in_drawings.begin(), in_drawings.end());
  return read;
}

}  // namespace

ReadPattern read_pattern(const std::filesystem::path& file) {
  return read_checked(file, [&] { return read_and_check(file); });
}

Pattern load_pattern(const std::filesystem::path& file, const std::string& where) {
  ReadPattern read = read_pattern(file);
  if (read.mistakes.empty()) return std::move(read.pattern);
  throw Error(read.only_in_drawings ? ExitCode::asset_unreadable : ExitCode::scene_invalid,
              "{}: its pattern has mistakes:\n{}", where, fmt::join(read.mistakes, "\n"));
}

}  // namespace weft::garment
