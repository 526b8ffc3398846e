// Sewing patterns: what a pattern file says, checked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"
#include "garment/outline.hpp"
#include "garment/wearer.hpp"
#include "mesh/sheet.hpp"
#include "scene/rule.hpp"

namespace weft::garment {

enum class Side { front, back };

/// Consecutive curves of an outline with one name.
struct PanelEdge {
  std::string name;
  std::vector<Curve> curves;  ///< counter-clockwise around the panel [m]
};

/// A flat piece of cloth, drawn as seen from before the wearer where it has a side, else from outside.
struct Panel {
  std::string name;
  std::optional<Side> side;    ///< none: the front, or where `angle` says
  std::string path;            ///< SVG path data in metres, y upward; or
  std::filesystem::path file;  ///< a drawing, and in it
  std::string id;              ///< the element with this id
  std::string edge_names;      ///< one for each curve, apart by spaces, in the order they are written; empty: 1 2 3 ...
  std::string fold;            ///< edge at which the outline is half of the panel; empty: it is whole
  double grain = 0;            ///< of the warp, counter-clockwise from the panel's y axis [degrees]
  std::string mirror_of;       ///< or the panel whose outline it has, left and right exchanged
  Around around = Around::none;  ///< part of the wearer that it starts bent around; none of all panels: flat
  std::optional<double> angle;   ///< where around it the panel's origin is, from the front to the left [degrees]
  int layer = 0;                 ///< how many layers of its part it lies above
  std::optional<Vec2> position;  ///< where the panel's origin starts: across and up the wearer [m]
  double rotation = 0;           ///< at the start, counter-clockwise seen from before [degrees]
  Vec2 scale{1, 1};              ///< at the start, across and up, before the rotation
  bool turned = false;           ///< its right side goes on from the wrong side of what it is sewn to, as a lapel's

  mesh::Reinforcement reinforcement;  ///< fusing, or a heavier fabric

  std::vector<PanelEdge> edges;  ///< around the outline, counter-clockwise

  /// Whether it is drawn as seen from the inside of the garment.
  bool from_inside() const { return (side == Side::back) != turned; }
};

/// Sews two edges together, named "panel.edge". Both get the same points, at the same shares of their lengths: the
/// longer one is eased in. With buttons or times it is a closure: the points are held together while it is closed.
struct Seam {
  std::string a, b;
  int buttons = 0;                     ///< that hold it; 0: all points do, as in a zip
  std::optional<double> open, closed;  ///< from when on [s]
  double strength = 2;                 ///< most that a button, or a point of a zip, pulls with [N]
  double allowance = 0.02;             ///< width of the cloth turned in along it, of both sides together [m]

  bool closure() const { return buttons > 0 || open || closed; }
};

/// A band that pulls an edge together.
struct Elastic {
  std::string edge;
  double ratio = 0.9;     ///< of its rest length to that of the edge
  double stiffness = 50;  ///< force per strain [N]
};

/// An edge turned up: heavier and stiffer than the cloth.
struct Hem {
  std::string edge;
  double mass = 0.01;  ///< beside the cloth's own [kg/m]
  double bend = 2e-6;  ///< against bending of the edge in any direction [N·m²]
};

/// Of a body: girths, and from the floor to the crown [m].
struct Measures {
  std::optional<double> chest, waist, hip, height;
};

struct Pattern {
  std::filesystem::path file;
  Measures measures;    ///< that it is drawn for, as far as it says
  double depth = 0.16;  ///< of the front panels before the wearer's coronal plane at the start, and of the back panels
                        ///< behind it, far from the seams that join both [m]
  double gap = 0.015;   ///< of panels that are bent around the wearer from the skin at the start [m]
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::vector<Elastic> elastics;
  std::vector<Hem> hems;

  /// Whether panels start bent around parts of a wearer; else they lie before and behind it.
  bool wraps() const;
  /// Another size: outlines, and where panels start; seams and hems stay as they are.
  /// `factors`: across and up the drawings.
  void scale_by(const Vec2& factors);
  /// The edge named "panel.edge": indices of panel and edge. The name exists in a checked pattern.
  std::pair<std::size_t, std::size_t> find(const std::string& name) const;
};

/// The format of pattern files.
const scene::Table& pattern_rules();

/// A pattern as far as it could be read.
struct ReadPattern {
  Pattern pattern;  ///< meaningful only if there are no mistakes
  /// One line each, file:line:column first, those of the pattern file before those of its drawings.
  std::vector<std::string> mistakes;
  bool only_in_drawings = false;  ///< they are all in drawings
};

/// Reads and checks a pattern file and the drawings that it names: TOML, or JSON as in garment/specification.hpp. Never
/// throws for what they can hold.
ReadPattern read_pattern(const std::filesystem::path& file);

/// The same for use. Throws Error with all mistakes after `where`, which names what refers to the file: scene_invalid,
/// or asset_unreadable where only drawings have them.
Pattern load_pattern(const std::filesystem::path& file, const std::string& where);

}  // namespace weft::garment
