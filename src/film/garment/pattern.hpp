// Sewing patterns: the checked content of a pattern file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "film/garment/outline.hpp"
#include "film/garment/wearer.hpp"
#include "film/scene/rule.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::garment {

enum class Side { front, back };

/// A named edge of a panel: consecutive curves of its outline.
struct PanelEdge {
  std::string name;
  std::vector<Curve> curves;  ///< counter-clockwise around the panel [m]
};

/// A flat piece of cloth. If it has a side, its outline is drawn as seen from in front of the wearer, otherwise as seen
/// from outside the garment. "Part" means a part of the wearer's body, such as an arm.
struct Panel {
  std::string name;
  std::optional<Side> side;    ///< side of the wearer that the panel covers; absent: see `angle`
  std::string path;            ///< SVG path data of the outline in metres, y upward; empty: see `file`
  std::filesystem::path file;  ///< SVG drawing with the outline; empty: see `path`
  std::string id;              ///< id, label or number of the element in the drawing
  /// Names of the curves, separated by spaces, in the order of the outline. For a `file`, the text may instead have one
  /// name for each edge from corner to corner. Empty: the names in the drawing; without those, 1, 2, 3 and so on.
  std::string edge_names;
  std::string fold;       ///< edge at which the outline must be mirrored for the whole panel; empty: none
  double grain = 0;       ///< warp direction, counter-clockwise from the panel's y axis [degrees]
  std::string mirror_of;  ///< panel of which this one is the mirror image; empty: none
  /// Part around which the panel starts bent. If any panel of the pattern has a part or an `angle`, `none` means the
  /// torso. Otherwise all panels start flat, in front of and behind the wearer.
  Around around = Around::none;
  /// Angle of the panel's origin around its part [degrees]: 0 the front, 90 the left. Absent: that of `side`; without
  /// `side`, the outside for arms, else the front.
  std::optional<double> angle;
  /// Number of layers of panels between this panel and the skin of its part, or of flat panels nearer to the wearer.
  int layer = 0;
  /// Start position of the panel's origin: across, up [m]. Absent: for a flat panel (0, 0); for a bent panel, the
  /// height at which its seams are shortest, and 0 across or, for ties and the like, the place there (wrapping.hpp).
  std::optional<Vec2> position;
  double rotation = 0;  ///< rotation of the drawing at the start, counter-clockwise [degrees]
  Vec2 scale{1, 1};     ///< factors on the lengths of the start shape, across and up the drawing
  /// Whether the panel is folded over like a lapel: its outer side continues the inner side of the panel to which it is
  /// sewn.
  bool turned = false;

  /// Stiffness and density of the panel relative to those of the garment, such as for an ironed-on lining (fusing).
  mesh::Reinforcement reinforcement;

  std::vector<PanelEdge> edges;  ///< around the outline, counter-clockwise

  /// Whether the drawing shows the inner side of the cloth.
  bool from_inside() const { return (side == Side::back) != turned; }
};

/// Sews two edges together. Both edges get mesh points at the same fractions of their lengths, so that the additional
/// length of the longer edge is distributed evenly. A seam with `buttons`, `open`, `closed` or `tearing_load` is a
/// closure: its edges stay separate, and ties (mesh::Tie) hold their points together while the closure is closed.
struct Seam {
  std::string a, b;  ///< the edges, as "panel.edge"
  /// Number of ties, at most one for each pair of points. 0: one for each pair, as in a zip.
  int buttons = 0;
  std::optional<double> open, closed;  ///< times at which the closure opens and closes [s]; absent: never
  double strength = 2;                 ///< maximum force of each tie [N]; unused if there is a `tearing_load`
  std::optional<double> tearing_load;  ///< force per length at which ties break for ever [N/m]; absent: never
  /// Width of the seam allowances, both sides together [m]; unused for closures.
  double allowance = 0.02;

  bool is_closure() const { return buttons > 0 || open || closed || tearing_load; }
};

/// An elastic band that gathers an edge.
struct Elastic {
  std::string edge;
  double ratio = 0.9;     ///< rest length of the band / length of the edge
  double stiffness = 50;  ///< force per strain [N]
};

/// A hem: an edge that is turned up, and thus heavier and stiffer than the cloth.
struct Hem {
  std::string edge;
  double mass = 0.01;  ///< mass per length, in addition to that of the cloth [kg/m]
  double bend = 2e-6;  ///< stiffness against bending of the edge in any direction [N·m²]
};

/// Measures of a body: girths, and the height from floor to crown [m].
struct Measures {
  std::optional<double> chest, waist, hip, arm, height;
};

/// The content of a pattern file.
struct Pattern {
  std::filesystem::path file;
  Measures measures;  ///< measures of the body for which the pattern is drawn; each may be absent
  /// Start distance of flat front and back panels from the wearer's coronal plane, which separates front from back [m].
  /// The distance decreases to 0 toward the seams that join front and back.
  double depth = 0.16;
  double gap = 0.015;  ///< distance of bent panels of layer 0 from the skin at the start [m]
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<Elastic> elastics;
  std::vector<Hem> hems;

  /// Whether panels start bent around parts of the wearer; otherwise they start flat.
  bool has_bent_panels() const;
  /// Multiplies outlines and start positions by `factors`: across and up at the start, that is, after `rotation`.
  /// Multiplies `depth` by the factor across. Then moves the start positions of all panels except those around arms
  /// upward by `rise` [m]. The position of a bent panel without a position follows from its seams. All other members
  /// keep their values.
  void scale_by(const Vec2& factors, double rise = 0);
  /// Indices of the panel and of its edge for a name "panel.edge" of a checked pattern. Throws Error(internal) if the
  /// pattern has no such edge.
  std::pair<std::size_t, std::size_t> find(const std::string& name) const;
};

/// The rule table of pattern files.
const scene::Table& pattern_rules();

/// A pattern and the mistakes in its files.
struct ReadPattern {
  Pattern pattern;  ///< valid only if there are no mistakes
  /// One line per mistake, starting with file:line:column. Mistakes of the pattern file come before those of its
  /// drawings.
  std::vector<std::string> mistakes;
  bool only_in_drawings = false;  ///< whether there are mistakes, but none in the pattern file itself
};

/// Reads and checks a pattern file and its drawings. The file is TOML, or a specification in JSON
/// (garment/specification.hpp). The result lists all mistakes, also unreadable files. Throws Error(asset_unreadable)
/// only if a parser throws an unexpected exception.
ReadPattern read_pattern(const std::filesystem::path& file);

/// Reads a pattern that must be free of mistakes. Otherwise throws Error with all mistakes after `where`, which names
/// the scene entry: asset_unreadable if only drawings have mistakes, else scene_invalid.
Pattern load_pattern(const std::filesystem::path& file, const std::string& where);

}  // namespace weft::garment
