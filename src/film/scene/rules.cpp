// The rules of the scene format: each key with its unit, range and documentation. Defaults are the initialisers in
// scene.hpp. Because of the upper bounds, no single value can exhaust memory or time.
#include <array>
#include <cmath>

#include "film/scene/character_rules.hpp"
#include "film/scene/common_rules.hpp"
#include "film/scene/contact_rules.hpp"
#include "film/scene/material_rules.hpp"
#include "film/scene/physics_rules.hpp"
#include "film/scene/pin_rules.hpp"
#include "film/scene/pressure_rules.hpp"
#include "film/scene/rope_rules.hpp"
#include "film/scene/rule.hpp"
#include "film/scene/table_builder.hpp"
#include "film/scene/view_rules.hpp"

namespace weft::scene {

namespace {

/// Converts a vector from axes with z up to the axes of the scene.
Vec3 rotate_to_up_axis(UpAxis up, const Vec3& z_up) {
  return up == UpAxis::z ? z_up : Vec3(z_up.x(), z_up.z(), -z_up.y());
}

const Table& time_rules() {
  static const Table kTable =
      TableBuilder<Time>("Length, frames and time steps.")
          .number("duration", &Time::duration, within(0, 3600), "s",
                  "length of the film; 0: only frame 0, the initial state")
          .not_simulated()
          .number("fps", &Time::fps, above(0, 1000), "Hz", "frames per second; frame k is the state at time k / fps")
          .number("preroll", &Time::preroll, within(0, 3600), "s",
                  "time simulated before frame 0 and not shown, for example to dress a character; keys with negative "
                  "times act in it")
          .number("step", &Time::step, within(model::kMinStep, 1), "s",
                  "maximum time step; each frame is divided into equal steps no longer than this; with implicit_euler, "
                  "a frame in which all cloth rests can be one step")
          .excludes("tolerance")
          .written_if([](Time& time) { return !time.tolerance; })
          .number("tolerance", &Time::tolerance, within(1e-8, 1), "m",
                  "in place of step: maximum estimated error of positions that one step adds, as root mean square over "
                  "each cloth; step lengths follow from it")
          .by_default("none: `step` sets the step length")
          .excludes("step")
          .choice("integrator", &Time::integrator, integrator::kMethodNames,
                  "method of time integration; implicit_midpoint has no damping, therefore steps with contacts use "
                  "bdf2 instead")
          .build();
  return kTable;
}

const Table& solver_rules() {
  static const Table kTable =
      TableBuilder<Solver>("How accurately each time step is solved.")
          .number("newton_tolerance", &Solver::newton_tolerance, above(0, 1), "",
                  "error that the solver may leave in a step, relative to the time integration error of that step, "
                  "with a visibility threshold as floor; smaller: more accurate and slower")
          .whole_number("newton_iterations", &Solver::newton_iterations, within(1, 1000),
                        "maximum number of Newton iterations in one solve of a step; a step that needs more is halved")
          .number("linear_tolerance", &Solver::linear_tolerance, above(0, 1), "",
                  "allowed error of one linear solve, relative to its solution")
          .whole_number("linear_iterations", &Solver::linear_iterations, within(1, 1e6),
                        "maximum number of conjugate gradient iterations in one linear solve")
          .whole_number("halvings", &Solver::halvings, within(0, 30),
                        "how often a rejected step is halved before the run ends with exit code 5")
          .build();
  return kTable;
}

/// Adds the keys that the look of a cloth and the look of a panel share.
template <class Painted>
void paint_rows(TableBuilder<Painted>& rows) {
  rows.color("color", &Painted::color, "color of the front, the side to which weft x warp points")
      .color("back_color", &Painted::back_color, "color of the back")
      .by_default("that of the front, paler, with its picture")
      .plain(Type::file, "image", &Painted::image,
             "picture (PNG, JPEG or TGA) along weft and warp; relative paths start at the scene's folder")
      .by_default("none")
      .number("image_width", &Painted::image_width, within(1e-3, 1000), "m",
              "width of one tile of the picture along weft; the height along warp keeps its proportions")
      .vector("image_offset", &Painted::image_offset, kWeftWarp, within(-1000, 1000), "m",
              "position of the lower left corner of a tile, in the coordinates of the sheet or panel")
      .number("image_rotation", &Painted::image_rotation, within(-360, 360), "degrees",
              "rotation of the picture, counter-clockwise about that corner")
      .plain(Type::boolean, "image_repeat", &Painted::image_repeat,
             "whether the tiles repeat; false: one tile, with `color` around it, or a hole if `cutout` is true")
      .plain(Type::boolean, "cutout", &Painted::cutout,
             "true: transparent parts of the picture are holes, as in lace; false: they show `color`");
}

const Table& panel_look_rules() {
  static const Table kTable =
      TableBuilder<PanelPaint>("How one panel of a pattern is drawn; keys that are not given are those of the cloth.")
          .plain(Type::text, "name", &PanelPaint::name, "name of the panel")
          .need(Need::required)
          .with(paint_rows<PanelPaint>)
          .build();
  return kTable;
}

const Table& cloth_look_rules() {
  static const Table kTable =
      TableBuilder<Look>("How the cloth is drawn.")
          .starting_from(look_of(kClothColor))
          .with(paint_rows<Look>)
          .number("roughness", &Look::roughness, within(0, 1), "", "roughness of the surface: 0 like a mirror, 1 matte")
          .number("gloss", &Look::gloss, within(0, 1), "", "strength of the highlights of the threads; 1 as of satin")
          .by_default("that of its fabric")
          .number("fuzz", &Look::fuzz, within(0, 1), "", "amount of fibres that stand out; 1 as of felt")
          .by_default("that of its fabric")
          .number("sheer", &Look::sheer, within(0, 1), "", "how much light comes through; 0.9 as of chiffon")
          .by_default("that of its fabric")
          .number("thread_spacing", &Look::thread_spacing, within(0, 10), "m",
                  "distance between the drawn threads; 0: no threads are drawn")
          .number("hem", &Look::hem, within(0, 1), "m", "width of the drawn hems; 0: cut edges")
          .by_default("0.015 for a pattern, else 0.01; 0 for fabrics that do not fray")
          .plain(Type::boolean, "visible", &Look::visible, "whether it is drawn")
          .list(Type::list, "panel", &Look::panels, panel_look_rules(),
                [](Look& look, std::size_t) {
                  look.panels.push_back({static_cast<const Paint&>(look), {}});
                })
          .build();
  return kTable;
}

const Table& pose_key_rules() {
  static const Table kTable =
      TableBuilder<PoseKey>("The pose at one time.")
          .with(key_time_row<PoseKey>)
          .with([](auto& rows) { pose_rows(rows, &PoseKey::pose, "position at this time", kDefaultOfKey); })
          .build();
  return kTable;
}

/// Adds the rows `interpolation` and `keys` of a PoseTrack. `start` returns the defaults of the first key frame.
template <class S, class Member, class Start>
void track_rows(TableBuilder<S>& rows, Member track, Start start) {
  const auto keys = [track](S& s) -> std::vector<PoseKey>& { return std::invoke(track, s).keys; };
  rows.choice(
      "interpolation", [track](S& s) -> Interpolation& { return std::invoke(track, s).interpolation; }, kInterpolations,
      kBetweenKeys);
  rows.list(Type::keys, "keys", keys, pose_key_rules(), [keys, start](S& s, std::size_t i) {
    keys(s).push_back(i == 0 ? PoseKey{0, start(s)} : PoseKey(keys(s).back()));
  });
}

/// Adds the keys of each shape of cloth, in the order of ClothShape.
void cloth_shape_rows(TableBuilder<Cloth>& rows) {
  using Rows = TableBuilder<Cloth>;
  for (const char* name : {"quads", "aligned_triangles", "crossed_triangles"})
    rows.variant(name,
                 Rows()
                     .vector("size", &Cloth::size, kWeftWarp, kSizeRange, "m", "size along weft and warp, at rest")
                     .single_fills_all()
                     .pair("particles", &Cloth::particles_weft, &Cloth::particles_warp, within(2, 2000), "",
                           "number of particles along weft and warp")
                     .whole()
                     .vector("grading", &Cloth::grading, kWeftWarp, within(1e-4, 1e4), "",
                             "ratio of the last to the first spacing of particles, along weft and warp; "
                             "successive spacings have a constant ratio")
                     .single_fills_all());
  rows.variant(
      "mesh",
      Rows()
          .plain(Type::file, "file", &Cloth::file,
                 "mesh file with the start shape of the cloth; relative paths start at the scene's folder")
          .need(Need::required)
          .number("scale", &Cloth::scale, above(0, 1e6), "",
                  "factor on all lengths of the file; if the file states its unit, they are converted to metres first")
          .choice("up", &Cloth::up, {"as_file", "x", "y", "z"},
                  "axis of the file that points up; as_file: as glTF, FBX and Collada files state it, other formats "
                  "have the axes of the scene")
          .plain(Type::text, "object", &Cloth::object, "name of the mesh, or of its node, in the file")
          .by_default("all in the file")
          .choice("rest", &Cloth::rest, {"auto", "mesh", "uv"},
                  "source of the shape at rest: the mesh, with weft along x, or its UVs, as the flat panels that it "
                  "was sewn from; auto uses the UVs if they fit the mesh")
          .vector("uv_scale", &Cloth::uv_scale, {"u", "v"}, above(0, 1e6), "m", "length of one unit of the UVs")
          .single_fills_all()
          .by_default("measured against the mesh")
          .number("sewing", &Cloth::sewing, within(0, 1000), "s",
                  "time in which it changes, without weight, from the shape of the mesh to the measures of its UVs")
          .by_default("0"));
  rows.variant(
      "pattern",
      Rows()
          .plain(Type::file, "file", &Cloth::file,
                 "sewing pattern (TOML), or a GarmentCode specification (JSON); relative paths start at the scene's "
                 "folder")
          .need(Need::required)
          .number("scale", &Cloth::scale, above(0, 1000), "",
                  "factor on all lengths of the pattern, the heights of its panels included")
          .number("edge_length", &Cloth::edge_length, within(1e-4, 10), "m", "edge length of the triangles of the mesh")
          .plain(Type::text, "wearer", &Cloth::wearer,
                 "character around whose parts the panels start bent, if the pattern names these parts")
          .by_default("the only character")
          .plain(Type::boolean, "fit", &Cloth::fit,
                 "true: scales the pattern from the body measures that it states to those of the wearer, and then by "
                 "`scale`")
          .number("sewing", &Cloth::sewing, within(0, 1000), "s",
                  "time in which the panels change, without weight, from the start shape to their own measures"));
}

const Table& cloth_rules() {
  static const Table kTable =
      TableBuilder<Cloth>("A sheet of cloth: a rectangle, the shape of a mesh file, or sewn from a pattern.")
          .plain(Type::name, "name", &Cloth::name, "unique name among cloths, ropes, obstacles and characters")
          .need(Need::required)
          .choice("shape", &Cloth::shape, {"quads", "aligned_triangles", "crossed_triangles", "mesh", "pattern"},
                  "a rectangle of quads or of triangles, the triangles of a mesh file, or a sewing pattern")
          .when_given([](Cloth& c) {
            if (c.shape == ClothShape::mesh) c.sewing = 0;  // the file contains the sewn shape
          })
          .selects()
          .with(cloth_shape_rows)
          .with([](auto& rows) {
            pose_rows(rows, &Cloth::pose,
                      "position of the middle of the sheet, whose weft lies along x and warp along y before it is "
                      "rotated; of a mesh or pattern, of its origin");
          })
          .vector("velocity", &Cloth::velocity, kXyz, within(-1e4, 1e4), "m/s", "initial velocity")
          .vector("spin", &Cloth::spin, kXyz, within(-36000, 36000), "degrees/s",
                  "initial angular velocity about its centre of mass: a vector along the axis")
          .written_if([](Cloth& cloth) { return cloth.spin != Vec3::Zero(); })
          .choice_by(
              "start", {"as_given", "untangle"},
              "what to do if it touches or crosses itself, other cloth or an obstacle at the start: refuse the "
              "scene (as_given), or move it out before the first step (untangle)",
              [](Cloth& cloth) -> std::size_t { return starts_untangled(cloth) ? 1 : 0; },
              [](Cloth& cloth, std::size_t index) { cloth.start = static_cast<ClothStart>(index); })
          .by_default("untangle for patterns, else as_given")
          .plain(Type::texts, "over", &Cloth::over,
                 "names of the cloths that it is worn over; the layers share the preroll: each is put on after those "
                 "below it, and moved outside of them")
          .by_default("none")
          .vector("start_scale", &Cloth::start_scale, kWeftWarp, above(0, 1000), "",
                  "initial lengths along weft and warp, relative to those at rest")
          .single_fills_all()
          .number("start_noise", &Cloth::start_noise, within(0, 1000), "m",
                  "maximum random displacement of a particle at the start, along each axis; the same in every run")
          .table("material", &Cloth::material, material_rules())
          .table("pressure", &Cloth::pressure, pressure_rules())
          .written_if([](Cloth& cloth) { return cloth.pressure.has_effect(); })
          .table("look", &Cloth::look, cloth_look_rules())
          .not_simulated()
          .list(Type::list, "pin", &Cloth::pins, pin_rules())
          .list(Type::list, "weight", &Cloth::weights, weight_rules())
          .build();
  return kTable;
}

/// Returns a function that returns a member of the shape of an obstacle.
template <class Kind, class Field>
auto of_shape(Field Kind::*field) {
  return [field](Obstacle& o) -> Field& { return std::get<Kind>(o.shape).*field; };
}

/// Adds the keys of each shape of an obstacle, in the order of scene::Shape.
void shape_rows(TableBuilder<Obstacle>& rows) {
  using Rows = TableBuilder<Obstacle>;
  const auto segments = [](Rows& r) {
    r.whole_number("segments", &Obstacle::segments, within(3, 512), "number of faces around it; more make it rounder");
  };
  rows.variant(
      "sphere",
      Rows().number("radius", of_shape(&Sphere::radius), kSizeRange, "m", "radius of the sphere").with(segments));
  rows.variant("box", Rows()
                          .vector("size", of_shape(&BoxShape::size), kXyz, kSizeRange, "m", "edge lengths")
                          .number("bevel", of_shape(&BoxShape::bevel), within(0, 1e4), "m",
                                  "radius of the rounded edges; less than half the shortest edge"));
  rows.variant("cone", Rows()
                           .number("radius", of_shape(&Cone::radius), kSizeRange, "m", "radius of the base")
                           .number("height", of_shape(&Cone::height), kSizeRange, "m",
                                   "height along the up axis; the position is at half the height")
                           .with(segments));
  rows.variant("torus", Rows()
                            .number("radius", of_shape(&Torus::radius), kSizeRange, "m",
                                    "distance from the centre of the ring to the middle of the tube")
                            .number("tube_radius", of_shape(&Torus::tube_radius), kSizeRange, "m",
                                    "radius of the tube; less than `radius`")
                            .with(segments));
  rows.variant("cylinder",
               Rows()
                   .number("radius", of_shape(&Cylinder::radius), kSizeRange, "m", "radius of the cylinder")
                   .number("height", of_shape(&Cylinder::height), kSizeRange, "m", "height along the up axis")
                   .with(segments));
  rows.variant("half_pipe", Rows()
                                .number("radius", of_shape(&HalfPipe::radius), kSizeRange, "m", "inner radius")
                                .number("length", of_shape(&HalfPipe::length), kSizeRange, "m", "length along x")
                                .number("thickness", of_shape(&HalfPipe::thickness), kSizeRange, "m",
                                        "thickness of the wall, outside of `radius`")
                                .with(segments));
  rows.variant("plane", Rows()
                            .vector("size", of_shape(&Plane::size), {"x", "y"}, kSizeRange, "m", "edge lengths")
                            .single_fills_all()
                            .plain(Type::boolean, "infinite", of_shape(&Plane::infinite),
                                   "whether it is drawn up to the horizon; it collides only within `size`. Of several "
                                   "such planes only the first visible one is drawn"));
  rows.variant(
      "mesh",
      Rows()
          .plain(Type::file, "file", of_shape(&MeshFile::path), "mesh file; relative paths start at the scene's folder")
          .need(Need::required)
          .number("scale", of_shape(&MeshFile::scale), above(0, 1e6), "",
                  "factor on all lengths of the file; if the file states its unit, they are converted to metres first")
          .choice("up", of_shape(&MeshFile::up), {"as_file", "x", "y", "z"},
                  "axis of the file that points up; as_file: as glTF, FBX and Collada files state it, other formats "
                  "have the axes of the scene"));
}

const Table& obstacle_rules() {
  static const std::array<Shape, 8> kShapes = {Sphere{},   BoxShape{}, Cone{},  Torus{},
                                               Cylinder{}, HalfPipe{}, Plane{}, MeshFile{}};
  static const Table kTable =
      TableBuilder<Obstacle>(
          "A rigid body: still, moved by key frames, or, if it has a mass or density, moved by forces.")
          .plain(Type::name, "name", &Obstacle::name, "unique name among cloths, ropes, obstacles and characters")
          .need(Need::required)
          .choice_by(
              "shape", {"sphere", "box", "cone", "torus", "cylinder", "half_pipe", "plane", "mesh"},
              "kind of body; it decides which other keys are allowed", [](Obstacle& o) { return o.shape.index(); },
              [](Obstacle& o, std::size_t index) {
                o.shape = kShapes[index];
                if (std::holds_alternative<Plane>(o.shape)) o.look.color = kFloorColor;
              })
          .need(Need::required)
          .selects()
          .with(shape_rows)
          .with([](auto& rows) {
            pose_rows(rows, &Obstacle::pose, "position of its centre; of a mesh file, that of the file's origin");
          })
          .number("mass", &Obstacle::mass, within(0, 1e6), "kg",
                  "mass; if given, gravity, cloth and other bodies move it; its surface must be closed")
          .written_if([](Obstacle& o) { return o.mass > 0; })
          .number("density", &Obstacle::density, within(0, 1e5), "kg/m³",
                  "density of its interior, in place of mass: wood 700, steel 7800")
          .written_if([](Obstacle& o) { return o.density > 0; })
          .vector("velocity", &Obstacle::velocity, kXyz, within(-1e4, 1e4), "m/s",
                  "initial velocity, at the start or at `release`; needs a mass or density, and no motion by keys")
          .written_if([](Obstacle& o) { return o.velocity != Vec3::Zero(); })
          .vector("spin", &Obstacle::spin, kXyz, within(-36000, 36000), "degrees/s",
                  "likewise, initial angular velocity about its centre of mass: a vector along the axis")
          .written_if([](Obstacle& o) { return o.spin != Vec3::Zero(); })
          .number("release", &Obstacle::release, within(0, 3600), "s",
                  "time from which forces move it; until then it stands still, or its keys move it; needs a mass or "
                  "density")
          .plain(Type::text, "follow", &Obstacle::follow,
                 "obstacle, or part of a character such as \"man.head\", with which it moves; its own pose and keys "
                 "say where it would be if the followed body stayed where it is at the start of the run")
          .by_default("none")
          .number("friction", &Obstacle::friction, within(0, 10), "", kFrictionOfBoth)
          .plain(Type::boolean, "collide", &Obstacle::collide, kWhetherItCollides)
          .table("look", &Obstacle::look, obstacle_look_rules())
          .not_simulated()
          .with([](auto& rows) { track_rows(rows, &Obstacle::motion, [](Obstacle& o) { return o.pose; }); })
          .build();
  return kTable;
}

void append_cloth(Scene& s, std::size_t) {
  s.cloths.emplace_back().look.color = kClothColor;
}

void append_rope(Scene& s, std::size_t) {
  s.ropes.emplace_back().look = rope_look();
}

void append_light(Scene& s, std::size_t) {
  LightKey key;
  key.direction = rotate_to_up_axis(s.up, key.direction);
  key.position = rotate_to_up_axis(s.up, key.position);
  s.lights.push_back({.name = {}, .color = Light{}.color, .keys = {key}});
}

void append_camera(Scene& s, std::size_t) {
  s.cameras.push_back({.name = {}, .keys = {CameraKey{}}});
}

}  // namespace

const Table& scene_rules() {
  // The rule of the up axis comes first, because the defaults of later keys depend on it.
  static const Table kTable =
      TableBuilder<Scene>("A scene of Weft: SI units, angles in degrees, colors in sRGB.")
          .choice("up", &Scene::up, {"y", "z"}, "axis that points up")
          .when_given([](Scene& s) { s.physics.gravity = rotate_to_up_axis(s.up, Physics{}.gravity); })
          .plain(Type::text, "title", &Scene::title, "title, for human readers; it is stored in videos")
          .not_simulated()
          .table("time", &Scene::time, time_rules())
          .table("physics", &Scene::physics, physics_rules())
          .table("solver", &Scene::solver, solver_rules())
          .table("contact", &Scene::contact, contact_rules())
          .table("render", &Scene::render, render_rules())
          .list(Type::list, "fan", &Scene::fans, fan_rules())
          .list(Type::list, "obstacle", &Scene::obstacles, obstacle_rules())
          .list(Type::list, "character", &Scene::characters, character_rules())
          .list(Type::list, "cloth", &Scene::cloths, cloth_rules(), append_cloth)
          .list(Type::list, "rope", &Scene::ropes, rope_rules(), append_rope)
          .list(Type::list, "attach", &Scene::attachments, attachment_rules())
          .list(Type::list, "camera", &Scene::cameras, camera_rules(), append_camera)
          .not_simulated()
          .list(Type::list, "light", &Scene::lights, light_rules(), append_light)
          .not_simulated()
          .build();
  return kTable;
}

}  // namespace weft::scene
