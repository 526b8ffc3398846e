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

/// Consecutive curves of an outline that share a name.
struct PanelEdge {
  std::string name;
  std::vector<Curve> curves;  ///< counter-clockwise around the panel [m]
};

/// A flat piece of cloth. It is drawn as seen from in front of the wearer if it has a side, else from outside.
struct Panel {
  std::string name;
  std::optional<Side> side;    ///< empty: as `angle` states, else the front (on arms the outside)
  std::string path;            ///< SVG path data of the outline in metres, y upward; empty: see `file`
  std::filesystem::path file;  ///< SVG drawing that holds the outline; empty: see `path`
  std::string id;              ///< id of the element of the drawing
  std::string edge_names;      ///< one name per curve, separated by spaces, in drawing order; empty: 1 2 3 ...
  std::string fold;            ///< edge at which the outline is half of the panel; empty: the outline is whole
  double grain = 0;            ///< angle of the warp, counter-clockwise from the panel's y axis [degrees]
  std::string mirror_of;       ///< panel whose mirrored outline this one has, instead of its own
  /// Part of the wearer around which the panel starts bent; `none` means the torso. If no panel of the pattern has a
  /// part or an `angle`, all panels start in front of and behind the wearer instead.
  Around around = Around::none;
  std::optional<double> angle;   ///< of the panel's origin around the part, from front to left [degrees]
  int layer = 0;                 ///< number of panels of the same part below this panel
  std::optional<Vec2> position;  ///< start position of the panel's origin: across and up the wearer [m]
  double rotation = 0;           ///< at the start, counter-clockwise seen from in front [degrees]
  Vec2 scale{1, 1};              ///< at the start, across and up, before the rotation
  /// Whether the panel is folded over as a lapel: its outer side continues the inner side of its neighbour.
  bool turned = false;

  mesh::Reinforcement reinforcement;  ///< such as an ironed-on lining (fusing), or a heavier fabric

  std::vector<PanelEdge> edges;  ///< around the outline, counter-clockwise

  /// Whether the panel is drawn as seen from the inside of the garment.
  bool from_inside() const { return (side == Side::back) != turned; }
};

/// Sews two edges together, each named "panel.edge". Both get the same points, at the same fractions of their lengths,
/// so the surplus length of the longer edge is spread evenly along the seam (eased in). A seam with `buttons`, `open`,
/// `closed` or `tearing_load` is a closure: its points are held together while it is closed.
struct Seam {
  std::string a, b;
  int buttons = 0;                     ///< number of buttons that hold the seam; 0: all points hold it, as in a zip
  std::optional<double> open, closed;  ///< times at which the closure opens and closes [s]
  double strength = 2;                 ///< maximum pull of a button, or of a point of a zip [N]
  std::optional<double> tearing_load;  ///< load per length at which points of the seam come apart for good [N/m]
  double allowance = 0.02;             ///< width of the seam allowances, both sides together [m]

  bool closure() const { return buttons > 0 || open || closed || tearing_load; }
};

/// An elastic band that gathers an edge.
struct Elastic {
  std::string edge;
  double ratio = 0.9;     ///< rest length of the band / length of the edge
  double stiffness = 50;  ///< force per strain [N]
};

/// An edge turned up: heavier and stiffer than the cloth.
struct Hem {
  std::string edge;
  double mass = 0.01;  ///< in addition to that of the cloth [kg/m]
  double bend = 2e-6;  ///< stiffness against bending of the edge in any direction [N·m²]
};

/// Measures of a body: girths, and the height from floor to crown [m].
struct Measures {
  std::optional<double> chest, waist, hip, height;
};

struct Pattern {
  std::filesystem::path file;
  Measures measures;  ///< of the body that the pattern is drawn for, as far as stated
  /// Start distance of front and back panels from the wearer's coronal plane, which separates front from back [m]. It
  /// decreases to 0 toward the seams that join front and back.
  double depth = 0.16;
  double gap = 0.015;  ///< distance of bent panels from the skin at the start [m]
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<Elastic> elastics;
  std::vector<Hem> hems;

  /// Whether panels start bent around parts of a wearer; otherwise they start in front of and behind the wearer.
  bool wraps() const;
  /// Scales outlines and start positions by `factors` (across and up the drawings) and `depth` by the factor across;
  /// all other members keep their values.
  void scale_by(const Vec2& factors);
  /// Indices of panel and edge of the edge named "panel.edge". The name exists in a checked pattern; throws
  /// Error(internal) otherwise.
  std::pair<std::size_t, std::size_t> find(const std::string& name) const;
};

/// The format of pattern files.
const scene::Table& pattern_rules();

/// A pattern, as far as it could be read.
struct ReadPattern {
  Pattern pattern;  ///< valid only if there are no mistakes
  /// One line each, starting with file:line:column; first those of the pattern file, then those of its drawings.
  std::vector<std::string> mistakes;
  bool only_in_drawings = false;  ///< all mistakes are in drawings
};

/// Reads and checks a pattern file and the drawings that it names: TOML, or JSON as in garment/specification.hpp. No
/// file content makes it throw.
ReadPattern read_pattern(const std::filesystem::path& file);

/// Reads a pattern for use. Throws Error with all mistakes after `where`, which names the scene entry that refers to
/// the file: asset_unreadable if only drawings have mistakes, else scene_invalid.
Pattern load_pattern(const std::filesystem::path& file, const std::string& where);

}  // namespace weft::garment
