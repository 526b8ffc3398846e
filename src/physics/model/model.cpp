#include "physics/model/model.hpp"

#include <algorithm>
#include <utility>

#include "core/parallel.hpp"

namespace weft::model {
namespace {

/// Position of a number in a list; nothing if the list does not contain it.
std::optional<std::size_t> position_of(std::size_t number, std::span<const std::size_t> numbers) {
  const auto found = std::ranges::find(numbers, number);
  if (found == numbers.end()) return std::nullopt;
  return static_cast<std::size_t>(found - numbers.begin());
}

}  // namespace

bool Model::air_acts() const {
  return physics.air_density > 0 &&
         std::ranges::any_of(cloths, [](const Cloth& cloth) { return cloth.material.drag > 0; });
}

bool Model::may_be_untangled() const {
  return std::ranges::any_of(cloths, &Cloth::may_be_untangled);
}

Model Model::with_cloths(std::span<const std::size_t> numbers) const {
  Model part{.source = source,
             .up = up,
             .time = time,
             .physics = physics,
             .fans = fans,
             .solver = solver,
             .contact = contact,
             .cloths = {},
             .bodies = bodies,
             .attachments = {},
             .layers = {},
             .start_advice = start_advice,
             .untangle_advice = untangle_advice};
  for (const std::size_t number : numbers) part.cloths.push_back(cloths[number]);
  for (Attachment attachment : attachments) {
    const auto own = position_of(attachment.cloth, numbers);
    if (!own) continue;
    attachment.cloth = *own;
    if (attachment.to_cloth) {
      attachment.to_cloth = position_of(*attachment.to_cloth, numbers);
      if (!attachment.to_cloth) continue;
    }
    part.attachments.push_back(std::move(attachment));
  }
  return part;
}

void Model::place(std::size_t body, double t, std::span<Vec3> positions) const {
  const Body& placed = bodies[body];
  if (!placed.may_move) t = 0;
  if (const auto* keys = std::get_if<motion::KeyFrames>(placed.mover.get())) return keys->at(t, positions);
  const motion::PoseSample now = pose(body, t);
  const Mat3 rotation = now.rotation.toRotationMatrix();
  const std::vector<Vec3>& mesh = placed.mesh.positions;
  parallel_for(mesh.size(), kGrainSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions[i] = now.position + rotation * mesh[i];
  });
}

motion::PoseSample Model::pose(std::size_t body, double t) const {
  const motion::PoseSample own = std::get<motion::Track>(*bodies[body].mover).at(t);
  const Parent& parent = bodies[body].parent;
  return parent.is_any() ? compose(pose(parent, t), parent.start, own) : own;
}

motion::PoseSample Model::pose(const Parent& parent, double t) const {
  return parent.part ? parent.part->at(t) : pose(parent.body, t);
}

void Model::set_motion(std::size_t body, const motion::PoseTrack& motion) {
  bodies[body].mover = std::make_shared<const Mover>(motion::Track(motion));
  bodies[body].parent = {};
}

}  // namespace weft::model
