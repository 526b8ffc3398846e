#include "core/archive.hpp"
#include "film/assets/character_reader.hpp"

namespace weft::assets {
namespace {

template <class Archive, class Value>
void serialize(Archive& archive, character::Curve<Value>& curve) {
  serialize_plain(archive, curve.times);
  serialize_plain(archive, curve.values);
}

template <class Archive>
void serialize(Archive& archive, character::Clip& clip) {
  serialize_plain(archive, clip.name);
  archive.value(clip.duration);
  serialize_each(archive, clip.channels, [&](character::Channel& channel) {
    archive.value(channel.node);
    serialize(archive, channel.position);
    serialize(archive, channel.rotation);
    serialize(archive, channel.scale);
  });
  serialize_each(archive, clip.morphs, [&](character::MorphChannel& channel) {
    archive.value(channel.target);
    serialize(archive, channel.weight);
  });
}

template <class Archive>
void serialize(Archive& archive, character::Coloring& coloring) {
  serialize_each(archive, coloring.materials, [&](character::Material& material) {
    serialize_plain(archive, material.name);
    archive.value(material.color);
    serialize_plain(archive, material.picture);
    serialize_values(archive, material.wrap_u, material.wrap_v, material.cutout);
  });
  serialize_plain(archive, coloring.material_of_triangle);
  serialize_plain(archive, coloring.uv);
}

/// Writes or reads a character, depending on the archive. One function does both, so that both use the same order.
/// Omits members that files never set, such as Material::pixels.
template <class Archive>
void serialize(Archive& archive, ReadCharacter& read) {
  character::Character& character = read.character;
  serialize_each(archive, character.nodes, [&](character::Node& node) {
    serialize_plain(archive, node.name);
    archive.value(node.parent);
    archive.value(node.local);
  });
  serialize_plain(archive, character.bones);
  serialize_plain(archive, character.mesh.topology.quads);
  serialize_plain(archive, character.mesh.topology.triangles);
  serialize_plain(archive, character.mesh.positions);
  serialize_plain(archive, character.first_influence);
  serialize_plain(archive, character.influences);
  serialize_each(archive, character.morphs, [&](character::MorphTarget& target) {
    serialize_plain(archive, target.name);
    archive.value(target.weight);
    serialize_plain(archive, target.displacements);
  });
  serialize_each(archive, character.materials, [&](std::string& name) { serialize_plain(archive, name); });
  serialize_plain(archive, character.material_of_vertex);
  serialize(archive, character.coloring);
  serialize_each(archive, character.clips, [&](character::Clip& clip) { serialize(archive, clip); });
  archive.value(read.metres_per_unit);
  archive.value(read.up);
  serialize_each(archive, read.warnings, [&](std::string& warning) { serialize_plain(archive, warning); });
}

}  // namespace

std::string to_bytes(ReadCharacter& read) {
  ByteWriter writer;
  serialize(writer, read);
  return std::move(writer.bytes);
}

ReadCharacter character_from_bytes(std::string_view bytes) {
  ReadCharacter read;
  ByteReader reader{bytes};
  serialize(reader, read);
  return read;
}

}  // namespace weft::assets
