#include <fmt/format.h>

#include "lab/bench/stability.hpp"

namespace weft::bench {
namespace {

constexpr const char* kSecond = "duration = 1.0\nfps = 25\nstep = 0.01";

/// A square sheet of cotton, 0.5 m wide, held at two corners, without contact. `cloth`: further keys of the cloth;
/// `rest`: further tables of the scene.
std::string hanging(const std::string& cloth, const std::string& rest = {}) {
  return fmt::format(
      "[time]\n{}\n\n[contact]\nself = false\nobstacles = false\n{}\n"
      "[[cloth]]\nname = \"sheet\"\nsize = 0.5\nparticles = 21\nposition = [0, 0, 1]\n{}\n"
      "[[cloth.pin]]\nlow = [0, 1]\nhigh = [0, 1]\n\n[[cloth.pin]]\nlow = [1, 1]\nhigh = [1, 1]\n",
      kSecond, rest.empty() ? "" : "\n" + rest + "\n", cloth);
}

/// The sheet of hanging() without pins.
std::string free_sheet(const std::string& cloth) {
  return fmt::format(
      "[time]\n{}\n\n[contact]\nself = false\nobstacles = false\n\n"
      "[[cloth]]\nname = \"sheet\"\nsize = 0.5\nparticles = 21\nposition = [0, 0, 1]\n{}\n",
      kSecond, cloth);
}

/// A sheet above a floor, with contact.
std::string above_floor(const std::string& cloth, const std::string& time) {
  return fmt::format(
      "[time]\n{}\n\n[[cloth]]\nname = \"sheet\"\n{}\n[[obstacle]]\nname = \"floor\"\nshape = \"plane\"\n", time,
      cloth);
}

/// A sheet that falls on an obstacle (by default a ball) and rests there or slides off. `top`: further tables of the
/// scene.
std::string falling(const std::string& cloth, const std::string& top = {},
                    const std::string& obstacle = "shape = \"sphere\"\nradius = 0.15\n") {
  return fmt::format(
      "[time]\n{}\n{}\n[[cloth]]\nname = \"sheet\"\nsize = 0.5\n{}\n[[obstacle]]\nname = \"below\"\n{}\n", kSecond,
      top.empty() ? "" : "\n" + top, cloth, obstacle);
}

// Contact and friction at their extremes.
template <class Add>
void add_contact_cases(const Add& add) {
  const std::string sheet = "particles = 21\nposition = [0, 0, 0.17]\n", ball = "shape = \"sphere\"\nradius = 0.15\n";
  const auto slope = [&](double friction) {
    const std::string key = fmt::format("friction = {}\n", friction);
    return falling("particles = 21\nposition = [0, 0, 0.05]\nrotation = [40, 0, 0]\nmaterial = { " +
                       key.substr(0, key.size() - 1) + " }\n",
                   {}, "shape = \"plane\"\nrotation = [40, 0, 0]\n" + key);
  };
  add("slope_friction_0", "on a slope of 40° without friction", slope(0), 25);
  add("slope_friction_10", "on a slope of 40° with friction 10", slope(10), 25);
  add("ball_friction_0", "on a ball without friction",
      falling(sheet + "material = { friction = 0 }\n", {}, ball + "friction = 0\n"), 25);
  add("ball_friction_10", "on a ball with friction 10",
      falling(sheet + "material = { friction = 10 }\n", {}, ball + "friction = 10\n"), 25);
  add("solved_loosely", "on a ball, both tolerances 1",
      falling(sheet, "[solver]\nnewton_tolerance = 1\nlinear_tolerance = 1\n"), 25);
  add("solved_exactly", "on a ball, tolerances 1e-6 and 1e-4",
      falling(sheet, "[solver]\nnewton_tolerance = 1e-6\nlinear_tolerance = 1e-4\n"), 25);
  for (const char* shape : {"aligned", "crossed"})
    add(fmt::format("{}_triangles", shape), fmt::format("{} triangles on a ball", shape),
        falling(fmt::format("shape = \"{}_triangles\"\n", shape) + sheet), 25);
  add("far_away", "on a ball 1 km from the origin along each axis",
      falling("particles = 21\nposition = [1000, 1000, 1000.17]\n", {}, ball + "position = [1000, 1000, 1000]\n"), 25);
  add("blade", "on the edge of a plate 1 mm thick", falling(sheet, {}, "shape = \"box\"\nsize = [1, 0.001, 0.3]\n"),
      25);
  add("needle_below", "on the tip of a cone 5 mm wide and 0.3 m high",
      falling("particles = 21\nposition = [0, 0, 0.32]\n", {}, "shape = \"cone\"\nradius = 0.0025\nheight = 0.3\n"),
      25);
  add("needles_on_ball", "cells of 50 mm by 2 mm on a ball",
      falling("particles = [11, 251]\nposition = [0, 0, 0.17]\n"), 10);
}

std::vector<ExtremeCase> make_cases() {
  std::vector<ExtremeCase> cases;
  const auto add = [&](std::string name, std::string what, std::string text, int frames, double driven = 0) {
    cases.push_back({std::move(name), std::move(what), std::move(text), frames, driven});
  };
  add("light", "density 1e-4 kg/m²", hanging("material = { density = 1e-4 }\n"), 25);
  add("heavy", "density 1e4 kg/m²", hanging("material = { density = 1e4 }\n"), 25);
  for (int decade : {0, 2, 4, 6, 8})
    add(fmt::format("ratio_1e{}", decade), fmt::format("warp 1e{} times as stiff as weft", decade),
        hanging(fmt::format("material = {{ stretch = [1, 1e{}] }}\n", decade)), 25);
  add("needles", "cells of 0.1 m by 1e-5 m",
      "[time]\nduration = 1.0\nfps = 25\nstep = 0.01\n\n[contact]\nself = false\n\n[[cloth]]\nname = \"sheet\"\n"
      "size = [1.0, 1e-3]\nparticles = [11, 101]\nposition = [0, 0, 1]\n\n[[cloth.pin]]\nhigh = [0, 1]\n",
      25);
  add("one_element", "a single cell",
      "[time]\nduration = 1.0\nfps = 25\nstep = 0.01\n\n[[cloth]]\nname = \"sheet\"\nsize = 0.5\nparticles = 2\n"
      "position = [0, 0, 1]\n\n[[cloth.pin]]\nhigh = 0\n",
      25);
  add("many", "200,704 particles fall on a ball",
      "[time]\nduration = 0.2\nfps = 25\nstep = 0.02\n\n[[cloth]]\nname = \"sheet\"\nsize = 2\nparticles = 448\n"
      "position = [0, 0, 0.52]\n\n[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 0.5\n",
      3);
  add("load", "1e5 kg on a chain of 20 particles of 1 kg",
      "[time]\nduration = 2.0\nfps = 25\nstep = 0.01\n\n[contact]\nself = false\n\n[[cloth]]\nname = \"chain\"\n"
      "size = [0.01, 0.2]\nparticles = [2, 21]\nposition = [0, 0, 1]\nrotation = [90, 0, 0]\n"
      "material = { density = 10000, stretch = 1e9, bend = 0, bend_viscosity = 0, bend_friction = 0 }\n\n"
      "[[cloth.pin]]\nlow = [0, 1]\n\n[[cloth.weight]]\nhigh = [1, 0]\nmass = 1e5\n",
      50);
  add("gravity", "gravity a thousand times as strong", hanging("", "[physics]\ngravity = [0, 0, -9810]\n"), 25);
  add("flattened", "pressed to a thousandth of its width", free_sheet("start_scale = [1e-3, 1]\n"), 25);
  add("point", "pressed to a thousandth of its size", free_sheet("start_scale = 1e-3\n"), 25);
  add("randomised", "each particle up to 0.5 m off its place", free_sheet("start_noise = 0.5\n"), 25);
  add("stretched", "strain 10", free_sheet("start_scale = 11\n"), 25);
  add("impact", "hits the floor at 300 m/s",
      above_floor("size = 0.5\nparticles = 31\nposition = [0, 0, 2]\nrotation = [40, 10, 0]\nvelocity = [0, 0, -300]\n",
                  kSecond),
      25);
  add("pin_jumps", "the corner that holds it goes 10 m within a frame",
      free_sheet("\n[[cloth.pin]]\nlow = [1, 1]\ninterpolation = \"linear\"\n"
                 "keys = [ { time = 0.2 }, { time = 0.24, position = [10, 0, 0] } ]\n"),
      25,
      // Energy that the pin can add [J]: ½ m v² of the whole sheet at the speed of the pin, times three, because
      // stretched threads can accelerate the sheet beyond that speed.
      3 * 0.5 * 0.05 * 250 * 250);
  add("no_stiffness", "no stiffness at all",
      hanging("material = { stretch = 0, shear = 0, bend = 0, stretch_viscosity = 0, shear_viscosity = 0, "
              "bend_viscosity = 0, bend_friction = 0 }\n"),
      25);
  add("no_gravity", "no gravity, nothing moves", hanging("", "[physics]\ngravity = [0, 0, 0]\n"), 25);
  add("resting", "at rest on a floor for 10,000 steps",
      above_floor("size = 0.3\nparticles = 11\nposition = [0, 0, 0.003]\n", "duration = 100\nfps = 1\nstep = 0.01"),
      100);
  add_contact_cases(add);
  return cases;
}

}  // namespace

const std::vector<ExtremeCase>& extreme_cases() {
  static const std::vector<ExtremeCase> kCases = make_cases();
  return kCases;
}

}  // namespace weft::bench
