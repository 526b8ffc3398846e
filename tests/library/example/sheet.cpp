// Simulates a sheet that is made in memory, with the physics library alone, and prints the positions of its particles.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <weft/simulation.hpp>

namespace {

/// A square of n by n particles and a side of 1 m, held by two corners.
weft::Model hanging_sheet(int n) {
  weft::Cloth cloth;
  cloth.name = "sheet";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) cloth.mesh.positions.push_back({i / (n - 1.0), j / (n - 1.0), 0});
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const int corner = n * j + i;
      cloth.mesh.triangles.push_back({corner, corner + 1, corner + n});
      cloth.mesh.triangles.push_back({corner + 1, corner + n + 1, corner + n});
    }
  cloth.material.density = 0.2;
  weft::Model model;
  model.cloths = {cloth};
  model.pins = {{.cloth = "sheet", .particles = {0, n - 1}, .body = ""}};
  return model;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    weft::Simulation simulation(hanging_sheet(argc > 1 ? std::atoi(argv[1]) : 16));
    for (int k = 0; k < 10; ++k) simulation.advance();
    for (const weft::Vector& x : simulation.frame().object("sheet").positions)
      std::printf("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
  return 0;
}
