// Simulates a scene with the installed library and prints the positions of a cloth's particles in the last frame.
#include <cstdio>
#include <exception>
#include <weft/scene.hpp>
#include <weft/simulation.hpp>

namespace {

void simulate(const char* file, const char* cloth) {
  const weft::Scene scene = weft::Scene::load(file, {"cloth.0.material.fabric=silk"});
  weft::Simulation simulation(scene);
  while (simulation.frame().number() + 1 < scene.frames()) {
    const weft::Frame& frame = simulation.advance();
    const weft::Report& report = frame.report();
    std::fprintf(stderr, "%.2f s: %d steps, %d pairs near each other, strain %.3f, %.4f J\n", frame.time(),
                 report.steps, report.near_pairs, report.max_strain, report.kinetic_energy);
  }
  for (const weft::Vector& x : simulation.frame().object(cloth).positions)
    std::printf("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: drape SCENE CLOTH\n"), 2;
  try {
    simulate(argv[1], argv[2]);
  } catch (const weft::SceneError& error) {
    for (const weft::Mistake& mistake : error.mistakes())
      std::fprintf(stderr, "%s, line %d, %s: %s\n", mistake.file.c_str(), mistake.line, mistake.key.c_str(),
                   mistake.text.c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
