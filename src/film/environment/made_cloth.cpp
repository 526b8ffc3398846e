#include "film/environment/made_cloth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.hpp"
#include "core/grading.hpp"
#include "film/assets/mending.hpp"
#include "film/environment/chosen_particles.hpp"
#include "film/environment/orientation.hpp"
#include "film/environment/rope_object.hpp"
#include "film/garment/fit.hpp"
#include "film/garment/garment.hpp"
#include "film/garment/uv_rest.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/quads.hpp"

namespace weft::environment {
namespace {

// A pseudorandom number in [−1, 1) that depends only on the argument: splitmix64 mixing (Steele, Lea & Flood, 2014).
double noise(std::uint64_t z) {
  z = (z + 1) * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

// Positions of the particles at the start [m]: those of `rest` (the mesh placed in the scene), scaled about the
// position of the cloth's pose, plus noise. A garment that starts at its wearer, `worn_by`, is scaled about the origin
// of the wearer, along its axes; null: none.
std::vector<Vec3> start_positions(scene::UpAxis up, const scene::Cloth& cloth, const garment::Wearer* worn_by,
                                  const mesh::Mesh& rest) {
  std::vector<Vec3> x = rest.positions;
  if (cloth.start_scale == Vec2(1, 1) && cloth.start_noise == 0) return x;
  Vec3 factors(cloth.start_scale.x(), cloth.start_scale.y(), 1);
  // A pattern stands upright, with warp along the up axis, which is z for a wearer. If y is up, factors.y() already
  // scales this axis.
  if (worn_by != nullptr || (cloth.shape == scene::ClothShape::pattern && up == scene::UpAxis::z))
    std::swap(factors.y(), factors.z());
  Eigen::Isometry3d frame = Eigen::Translation3d(cloth.pose.position) * cloth.pose.rotation;
  if (worn_by != nullptr) frame = frame * worn_by->to_world;
  const Mat3 axes = frame.linear();
  const Vec3 origin = frame.translation();
  const Mat3 scale = axes * factors.asDiagonal() * axes.transpose();
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = origin + scale * (x[i] - origin);
    for (int axis = 0; axis < 3; ++axis)
      x[i][axis] += cloth.start_noise * noise(3 * i + static_cast<std::size_t>(axis));
  }
  return x;
}

void fill_from_grid(const mesh::Grid& grid, MadeCloth& made) {
  made.cloth.grid = grid;
  made.cloth.mesh = mesh::make_sheet(grid);
  made.cloth.spacing = grid.min_spacing();
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i)
      made.details.fractions.emplace_back(graded_fraction(i, grid.nu, grid.weft_grading),
                                          graded_fraction(j, grid.nv, grid.warp_grading));
}

void fill_from_triangles(mesh::Mesh mesh, MadeCloth& made) {
  made.cloth.sheet = mesh::make_sheet_from_mesh(mesh);
  made.cloth.spacing = std::numbers::sqrt2 * mesh::min_height(made.cloth.sheet);
  const Box3 box = mesh::bounding_box(mesh.positions);
  const Vec3 size = box.sizes();
  mesh.uv.clear();
  for (const Vec3& x : mesh.positions) {
    const Vec3 from_corner = x - box.min();
    mesh.uv.emplace_back(from_corner.x(), from_corner.y());
    made.details.fractions.emplace_back(size.x() > 0 ? from_corner.x() / size.x() : 0,
                                        size.y() > 0 ? from_corner.y() / size.y() : 0);
  }
  made.cloth.mesh = std::move(mesh);
}

/// Makes cloth from a pattern. The garment is upright. If it is fitted to its wearer or has panels around parts of the
/// wearer, it is at the position of the wearer. Sets made.details.fractions to the positions in the bounding box of
/// Garment::sheet.rest, from 0 to 1 along x and z. Returns the wearer at which the garment starts, or null.
const garment::Wearer* fill_from_pattern(const scene::Scene& scene, const scene::Cloth& cloth, const std::string& where,
                                         Wearers& wearers, MadeCloth& made) {
  garment::Pattern pattern = garment::load_pattern(cloth.file, where);
  const garment::Wearer* wearer = pattern.has_bent_panels() ? &wearers.of(cloth, where) : nullptr;
  const garment::Wearer* fitted = cloth.fit ? &wearers.of(cloth, where) : nullptr;
  Vec2 factors(cloth.scale, cloth.scale);
  double below_armholes = 1, rise = 0;
  if (fitted != nullptr) {
    const garment::Wearer& body = *fitted;
    const garment::Fit fit = garment::fit(pattern, body, where);
    const garment::Measures own = garment::measure(body);
    made.details.fitted = fmt::format(
        "{:.3g} times as wide and {:.3g} times as long as drawn{}; its wearer has {:.2f} m around the chest, {:.2f} "
        "around the waist, {:.2f} around the hips, {}and is {:.2f} m tall",
        fit.factors.x(), fit.factors.y(),
        fit.below_armholes == 1 ? ""
                                : fmt::format(" ({:.3g} below the armholes)", fit.factors.y() * fit.below_armholes),
        *own.chest, *own.waist, *own.hip, own.arm ? fmt::format("{:.2f} around the arms, ", *own.arm) : "",
        *own.height);
    factors = factors.cwiseProduct(fit.factors);
    rise = cloth.scale * fit.rise + (1 - cloth.scale) * fit.anchor;
    below_armholes = fit.below_armholes;
    pattern.gap *= fit.gap;
  }
  if (const garment::Wearer* body = fitted != nullptr ? fitted : wearer; body != nullptr && cloth.pins.empty())
    if (const std::string warning = garment::warn_if_hips_do_not_hold(pattern, factors, *body); !warning.empty())
      made.details.warnings.push_back(fmt::format("{}: {}", where, warning));
  if (below_armholes != 1) garment::shorten_below_armholes(pattern, below_armholes);
  pattern.scale_by(factors, rise);
  garment::Garment garment = garment::sew(pattern, cloth.edge_length, where, wearer);
  // A garment with bent panels lies around its wearer, in world coordinates. Other garments have z up.
  std::vector<Vec3> upright = garment.sheet.rest;
  if (wearer != nullptr)
    for (Vec3& x : upright) x = wearer->to_world.inverse() * x;
  const Box3 box = mesh::bounding_box(upright);
  for (const Vec3& x : upright) {
    const Vec3 fraction = (x - box.min()).cwiseQuotient(box.sizes());
    made.details.fractions.emplace_back(fraction.x(), fraction.z());
  }
  made.cloth.mesh.topology.triangles = garment.sheet.triangles;
  made.cloth.mesh.positions = garment.sheet.rest;
  made.cloth.mesh.uv = std::move(garment.uv);
  made.details.edges = std::move(garment.edges);
  made.details.closures = std::move(garment.closures);
  for (const garment::Panel& panel : pattern.panels) made.details.panels.push_back(panel.name);
  made.details.panel_of = std::move(garment.panel_of);
  made.details.paint_uv = garment.sheet.material;
  if (wearer == nullptr && fitted != nullptr)
    for (Vec3& x : made.cloth.mesh.positions) x = fitted->to_world * x;
  else if (wearer == nullptr)
    made.cloth.mesh = rotate_to_up_axis(std::move(made.cloth.mesh), scene.up);
  made.cloth.sheet = std::move(garment.sheet);
  made.cloth.spacing = std::numbers::sqrt2 * mesh::min_height(made.cloth.sheet);
  for (const scene::PanelPaint& panel : cloth.look.panels)
    if (std::ranges::find(made.details.panels, panel.name) == made.details.panels.end())
      refuse_name(panel.name, made.details.panels, where, "look.panel", "a panel of its pattern");
  return fitted != nullptr ? fitted : wearer;
}

/// Loads the triangles of the file of a cloth and mends them to a manifold sheet. Throws Error(asset_unreadable) if
/// that fails.
assets::LoadedMesh load_sheet(const scene::Scene& scene, const scene::Cloth& cloth, const std::string& where,
                              MadeCloth& made) {
  assets::LoadedMesh loaded =
      assets::load_mesh(cloth.file, axes_of(scene, cloth.file, cloth.scale, cloth.up), where, cloth.object);
  mesh::Mesh& mesh = loaded.mesh;
  mesh.topology.quads.clear();
  if (loaded.lost_vertices > 0)
    made.details.warnings.push_back(
        fmt::format("{}: mesh file {}: {} of {} vertices left out, which are in no triangle that has an area; faces "
                    "there cross themselves or have all corners on a line",
                    where, cloth.file.string(), loaded.lost_vertices, mesh.positions.size()));
  if (const assets::MendingReport mended = assets::mend_sheet(loaded, 1 / mesh::kMaxEdgeToHeightRatio); mended.any())
    made.details.warnings.push_back(
        fmt::format("{}: mesh file {}: repaired to a sheet: {}", where, cloth.file.string(), mended.describe()));
  const mesh::TopologyReport report = mesh::inspect(mesh.topology.triangles, mesh.positions.size());
  if (!report.manifold())
    throw Error(
        ExitCode::asset_unreadable,
        "{}: mesh file {}: expected edges of one or two triangles that face the same way, got {} of more and {} "
        "that face both ways",
        where, cloth.file.string(), report.non_manifold.size(), report.misoriented.size());
  return loaded;
}

/// Whether the panels that the UVs of a cloth define are its rest shape. Records the choice and its reason, and warns
/// of UVs that do not fit. Throws Error(asset_unreadable) if the scene demands UVs that are missing or unusable.
bool uses_uv(const scene::Cloth& cloth, const garment::UvRest& rest, const std::string& where, MadeCloth& made) {
  constexpr double kMaxUnusableArea = 0.1;  // fraction of the area of the mesh
  const std::string in_file = fmt::format("{}: mesh file {}", where, cloth.file.string());
  const bool asked = cloth.rest == scene::ClothRest::uv;
  if (rest.islands == 0) {
    if (asked)
      throw Error(ExitCode::asset_unreadable, "{}: expected texture coordinates (UVs) for rest = \"uv\", got none",
                  in_file);
    made.details.rest_from = "the mesh: it has no UVs";
    return false;
  }
  if (asked && rest.unusable_area > kMaxUnusableArea)
    throw Error(ExitCode::asset_unreadable,
                "{}: expected UVs in which triangles have an area, for rest = \"uv\", got {} of {} without, {:.0f} % "
                "of the surface",
                in_file, rest.unusable, rest.material.size(), 100 * rest.unusable_area);
  const bool takes = asked || (cloth.rest == scene::ClothRest::automatic && rest.has_panel_lengths());
  made.details.rest_from = fmt::format("{}{}: {}", takes ? "UVs" : "the mesh",
                                       cloth.rest != scene::ClothRest::automatic ? ""
                                       : takes                                   ? ", which fit it as panels do"
                                               : ", which its UVs do not fit as panels do",
                                       rest.describe());
  if (!takes) return false;
  constexpr double kMaxDrapeStretch = 0.25;  // relative to the panels; draping stretches cloth less
  if (!rest.has_panel_lengths())
    made.details.warnings.push_back(
        fmt::format("{}: its UVs may not be the pattern that it was sewn from: {}; rest = \"mesh\" uses the shape of "
                    "the mesh instead",
                    in_file, rest.describe()));
  else if (rest.stretch_quantile_95 > kMaxDrapeStretch && cloth.sewing == 0)
    made.details.warnings.push_back(
        fmt::format("{}: the mesh differs much from its UVs: {}; sewing = 1 gives it a second to change to them",
                    in_file, rest.describe()));
  if (rest.unusable > 0)
    made.details.warnings.push_back(
        fmt::format("{}: {} of {} triangles have no area in its UVs and keep that of the mesh", in_file, rest.unusable,
                    rest.material.size()));
  return true;
}

/// Makes cloth from a mesh file. The cloth starts as the mesh; if the mesh is an object in the file of a character, it
/// is moved as the body is. Its rest shape is the mesh, or the flat panels that its UVs define. Moves the mesh into
/// `made`, and returns the other data of the file, such as colours and vertex groups.
assets::LoadedMesh fill_from_mesh_file(const scene::Scene& scene, const scene::Cloth& cloth, const std::string& where,
                                       Wearers& wearers, MadeCloth& made) {
  assets::LoadedMesh loaded = load_sheet(scene, cloth, where, made);
  const Vec3 offset = wearers.offset_in_file(cloth);
  if (!offset.isZero(0))
    for (Vec3& x : loaded.mesh.positions) x += offset;
  garment::UvRest rest;
  if (cloth.rest != scene::ClothRest::mesh)
    rest = garment::rest_from_uv(loaded.mesh, loaded.uv, cloth.uv_scale, 1 / mesh::kMaxEdgeToHeightRatio);
  if (cloth.rest == scene::ClothRest::mesh) made.details.rest_from = "the mesh: the scene says so";
  const bool panels = cloth.rest != scene::ClothRest::mesh && uses_uv(cloth, rest, where, made);
  if (panels) {
    constexpr double kMaxSeamGap = 0.1;  // gap / shortest border edge at the gap; seams in files have smaller gaps
    if (const assets::Welded welded = assets::weld_borders(loaded, kMaxSeamGap); welded.vertices > 0)
      made.details.rest_from += fmt::format("; {} vertices of its borders are joined to others, at most {:.2g} mm away",
                                            welded.vertices, 1e3 * welded.widest);
  }
  fill_from_triangles(std::move(loaded.mesh), made);
  if (panels) {
    made.cloth.sheet.material = std::move(rest.material);
    made.cloth.sheet.sewn = true;
    made.details.paint_uv = made.cloth.sheet.material;
    made.cloth.spacing = std::numbers::sqrt2 * mesh::min_height(made.cloth.sheet);
    for (std::size_t t = made.cloth.sheet.triangles.size(); t-- > 0;)
      for (std::size_t k = 0; k < 3; ++k)
        made.cloth.mesh.uv[static_cast<std::size_t>(made.cloth.sheet.triangles[t][k])] =
            made.cloth.sheet.material[t][k];
  }
  return loaded;
}

bool can_touch_obstacles(const scene::Scene& scene) {
  return scene.contact.obstacles &&
         (std::ranges::any_of(scene.obstacles, [](const scene::Obstacle& o) { return o.collide; }) ||
          std::ranges::any_of(scene.characters, [](const scene::Character& c) { return c.collide; }));
}

/// Throws Error(scene_invalid) if triangles are too flat. The message gives their number and the flattest one.
void check_triangles(const mesh::Sheet& sheet, const std::string& where) {
  const mesh::FlatTriangles flat = mesh::find_flat_triangles(sheet);
  if (flat.count == 0) return;
  const Vec3& at = sheet.rest[static_cast<std::size_t>(sheet.triangles[flat.flattest][0])];
  throw Error(
      ExitCode::scene_invalid,
      "{}: expected triangles at least {:.3g} mm high, a {:g}th of the longest edge ({:.4g} mm), where cloth "
      "meets obstacles; got {} flatter, the flattest number {} at ({:.4g}, {:.4g}, {:.4g}) with {:.3g} mm; mesh "
      "it evenly or merge vertices that are closer",
      where, 1e3 * flat.longest_edge / mesh::kMaxEdgeToHeightRatio, mesh::kMaxEdgeToHeightRatio,
      1e3 * flat.longest_edge, flat.count, flat.flattest + 1, at.x(), at.y(), at.z(), 1e3 * flat.least_height);
}

}  // namespace

void check_spacing(const scene::Scene& scene, const scene::Cloth& cloth) {
  if (!can_touch_obstacles(scene) || scene::rectangle_particles(cloth) == 0) return;
  const mesh::Grid grid = grid_of(cloth);
  const double longest = std::max({grid.du(0), grid.du(grid.nu - 2), grid.dv(0), grid.dv(grid.nv - 2)});
  if (longest <= mesh::kMaxEdgeToHeightRatio * grid.min_spacing()) return;
  throw Error(ExitCode::scene_invalid,
              "{}:{}:{}: cloth.{}: expected cells at least a {:g}th as long as the longest ({:.4g} mm), where cloth "
              "meets obstacles; got {:.3g} mm; choose a grading closer to 1, or particles that are as far apart along "
              "weft as along warp",
              scene.file.string(), cloth.line, cloth.column, cloth.name, mesh::kMaxEdgeToHeightRatio, 1e3 * longest,
              1e3 * grid.min_spacing());
}

MadeCloth make_cloth(const scene::Scene& scene, const scene::Cloth& cloth, Wearers& wearers) {
  check_spacing(scene, cloth);
  MadeCloth made;
  made.cloth.name = cloth.name;
  const std::string where = fmt::format("{}:{}:{}: {}.{}", scene.file.string(), cloth.line, cloth.column,
                                        cloth.rope ? "rope" : "cloth", cloth.name);
  made.cloth.source = where;
  made.cloth.material = cloth.material;
  made.cloth.crossed = cloth.shape == scene::ClothShape::crossed_triangles;
  if (cloth.shape == scene::ClothShape::pattern || cloth.shape == scene::ClothShape::mesh)
    made.cloth.sewing = cloth.sewing;
  made.cloth.untangle = starts_untangled(cloth);
  made.cloth.pressure = cloth.pressure;
  const mesh::Grid grid = grid_of(cloth);
  assets::LoadedMesh file;
  const garment::Wearer* worn_by = nullptr;
  switch (cloth.shape) {
    case scene::ClothShape::quads:
      fill_from_grid(grid, made);
      break;
    case scene::ClothShape::aligned_triangles:
      fill_from_triangles(mesh::make_triangle_sheet(grid, mesh::Pattern::aligned), made);
      break;
    case scene::ClothShape::crossed_triangles:
      fill_from_triangles(mesh::make_triangle_sheet(grid, mesh::Pattern::crossed), made);
      break;
    case scene::ClothShape::mesh:
      file = fill_from_mesh_file(scene, cloth, where, wearers, made);
      break;
    case scene::ClothShape::pattern:
      worn_by = fill_from_pattern(scene, cloth, where, wearers, made);
      break;
    case scene::ClothShape::rope:
      fill_from_rope(scene, *cloth.rope, made);
      break;
  }
  choose_particles(scene, cloth, file, where, made);
  if (can_touch_obstacles(scene) && scene::rectangle_particles(cloth) == 0) check_triangles(made.cloth.sheet, where);
  for (Vec3& x : made.cloth.mesh.positions) x = cloth.pose.position + cloth.pose.rotation * x;
  made.cloth.start = start_positions(scene.up, cloth, worn_by, made.cloth.mesh);
  made.cloth.velocity = cloth.velocity;
  made.cloth.spin = kDegree * cloth.spin;
  return made;
}

mesh::Grid grid_of(const scene::Cloth& cloth) {
  return {.nu = cloth.particles_weft,
          .nv = cloth.particles_warp,
          .lu = cloth.size.x() / (cloth.particles_weft - 1),
          .lv = cloth.size.y() / (cloth.particles_warp - 1),
          .weft_grading = cloth.grading.x(),
          .warp_grading = cloth.grading.y()};
}

}  // namespace weft::environment
