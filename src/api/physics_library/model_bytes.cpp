#include "api/physics_library/model_bytes.hpp"

#include <utility>

#include "api/physics_library/material_members.hpp"
#include "core/archive.hpp"

namespace weft::library {
namespace {

template <class Archive>
void serialize(Archive& archive, Mesh& mesh) {
  serialize_plain(archive, mesh.positions);
  serialize_plain(archive, mesh.triangles);
}

template <class Archive>
void serialize(Archive& archive, Cloth& cloth) {
  serialize_plain(archive, cloth.name);
  serialize(archive, cloth.mesh);
  serialize_plain(archive, cloth.rest);
  for (const MaterialMember& member : kMaterialMembers) archive.value(cloth.material.*member.given);
  archive.value(cloth.velocity);
}

template <class Archive>
void serialize(Archive& archive, Body& body) {
  serialize_plain(archive, body.name);
  serialize(archive, body.mesh);
  serialize_values(archive, body.pose.position, body.pose.rotation, body.mass, body.velocity, body.friction,
                   body.collide);
  serialize_each(archive, body.keys,
                 [&](PoseKey& key) { serialize_values(archive, key.time, key.pose.position, key.pose.rotation); });
}

template <class Archive>
void serialize(Archive& archive, Pin& pin) {
  serialize_plain(archive, pin.cloth);
  serialize_plain(archive, pin.particles);
  serialize_plain(archive, pin.body);
  archive.value(pin.release);
}

template <class Archive>
void serialize(Archive& archive, Model& model) {
  serialize_values(archive, model.fps, model.step, model.method, model.newton_tolerance, model.gravity, model.wind,
                   model.air_density, model.self_contact);
  serialize_each(archive, model.cloths, [&](Cloth& cloth) { serialize(archive, cloth); });
  serialize_each(archive, model.bodies, [&](Body& body) { serialize(archive, body); });
  serialize_each(archive, model.pins, [&](Pin& pin) { serialize(archive, pin); });
}

}  // namespace

std::string bytes_of(Model model) {
  ByteWriter writer;
  serialize(writer, model);
  return std::move(writer.bytes);
}

Model model_of(std::string_view bytes) {
  ByteReader reader{bytes};
  Model model;
  serialize(reader, model);
  return model;
}

}  // namespace weft::library
