#include "film/environment/rope_object.hpp"

#include <algorithm>
#include <utility>

#include "film/scene/ropes.hpp"

namespace weft::environment {

void fill_from_rope(const scene::Scene& scene, const scene::Rope& rope, MadeCloth& made) {
  model::Cloth& object = made.cloth;
  scene::RopeShape shape = scene::start_shape(rope, scene.up);
  const auto count = static_cast<Index>(shape.places.size()), pieces = static_cast<Index>(shape.lengths.size());
  object.spacing = *std::ranges::min_element(shape.lengths);
  object.grid = {.nu = count, .nv = 1, .lu = object.spacing, .lv = object.spacing};
  double along = 0;
  for (Index i = 0; i < count; ++i) {
    made.details.fractions.emplace_back(static_cast<double>(i) / pieces, 0.5);
    object.mesh.uv.emplace_back(along, 0);
    if (i < pieces) along += shape.lengths[static_cast<std::size_t>(i)];
  }
  for (Index p = 0; p < pieces; ++p) {
    const Index next = (p + 1) % count;
    object.mesh.topology.triangles.push_back({p, next, next});
  }
  object.mesh.positions = std::move(shape.places);
  const scene::RopeNumbers numbers = scene::numbers_of(rope);
  object.rope = model::Rope{.lengths = std::move(shape.lengths),
                            .closed = rope.closed,
                            .mass = numbers.mass,
                            .stretch = numbers.stretch,
                            .bend = numbers.bend,
                            .damping = rope.damping,
                            .diameter = rope.diameter,
                            .drag = rope.drag,
                            .interpolation = rope.interpolation,
                            .keys = rope.keys};
}

}  // namespace weft::environment
