#include "film/scene/common_rules.hpp"

#include <numbers>

namespace weft::scene {

Quat from_angles(const Vec3& degrees) {
  const auto turn = [&](int i, const Vec3& axis) {
    return Quat(Eigen::AngleAxisd(degrees[i] * std::numbers::pi / 180, axis));
  };
  return turn(2, Vec3::UnitZ()) * turn(1, Vec3::UnitY()) * turn(0, Vec3::UnitX());
}

const Table& obstacle_look_rules() {
  static const Table kTable =
      TableBuilder<Look>("How the obstacle is drawn.")
          .starting_from(look_of(kObstacleColor))
          .color("color", &Look::color, "color of the surface")
          .by_default("[0.76, 0.72, 0.65], of planes [0.66, 0.66, 0.65]")
          .number("roughness", &Look::roughness, within(0, 1), "", "roughness of the surface: 0 like a mirror, 1 matte")
          .number("metal", &Look::metal, within(0, 1), "",
                  "1: metal, which reflects its surroundings in its own color; 0: no metal; values between mix both")
          .by_default("0")
          .written_if([](Look& look) { return look.metal > 0; })
          .number("gloss", &Look::gloss, within(0, 1), "",
                  "strength of a smooth clear coat, as of glaze and lacquer; 1 reflects like glass")
          .by_default("0")
          .plain(Type::file, "image", &Look::image,
                 "picture (PNG, JPEG or TGA) on the surface, by the UVs of a mesh file or around a shape; relative "
                 "paths start at the scene's folder")
          .by_default("none")
          .number("image_width", &Look::tile_width, within(1e-3, 1000), "m",
                  "width of one tile of the picture on the surface; the height keeps its proportions")
          .by_default("once around, on each side of a box, or over all UVs from 0 to 1")
          .plain(Type::boolean, "checker", &Look::checker,
                 "draws a faint grid of 0.5 m tiles on an infinite plane, to show the scale")
          .plain(Type::boolean, "visible", &Look::visible, "whether it is drawn; if not, it still collides")
          .build();
  return kTable;
}

const Table& character_look_rules() {
  static const Table kTable =
      TableBuilder<Look>("How the character is drawn.")
          .color("color", &Look::color, "color of the surface")
          .when_given([](Look& look) { look.as_file = false; })
          .plain(Type::boolean, "as_file", &Look::as_file,
                 "whether it has the colors and pictures of its file, if the file has any")
          .by_default("true unless `color` is given")
          .number("roughness", &Look::roughness, within(0, 1), "", "roughness of the surface: 0 like a mirror, 1 matte")
          .plain(Type::boolean, "checker", &Look::checker, "has no effect on characters")
          .plain(Type::boolean, "visible", &Look::visible, "whether it is drawn; if not, it still collides")
          .build();
  return kTable;
}

}  // namespace weft::scene
