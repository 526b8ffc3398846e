#include "assets/character_reader.hpp"
#include "core/archive.hpp"

namespace weft::assets {
namespace {

template <class Archive, class Value>
void exchange(Archive& archive, character::Curve<Value>& curve) {
  exchange_plain(archive, curve.times);
  exchange_plain(archive, curve.values);
}

template <class Archive>
void exchange(Archive& archive, character::Clip& clip) {
  exchange_plain(archive, clip.name);
  archive.value(clip.duration);
  exchange_each(archive, clip.channels, [&](character::Channel& channel) {
    archive.value(channel.node);
    exchange(archive, channel.position);
    exchange(archive, channel.rotation);
    exchange(archive, channel.scale);
  });
  exchange_each(archive, clip.morphs, [&](character::MorphChannel& channel) {
    archive.value(channel.target);
    exchange(archive, channel.weight);
  });
}

/// Writing and reading are the same list of parts, so that they cannot differ.
template <class Archive>
void exchange(Archive& archive, ReadCharacter& read) {
  character::Character& character = read.character;
  exchange_each(archive, character.nodes, [&](character::Node& node) {
    exchange_plain(archive, node.name);
    archive.value(node.parent);
    archive.value(node.local);
  });
  exchange_plain(archive, character.bones);
  exchange_plain(archive, character.mesh.topology.quads);
  exchange_plain(archive, character.mesh.topology.triangles);
  exchange_plain(archive, character.mesh.positions);
  exchange_plain(archive, character.first_influence);
  exchange_plain(archive, character.influences);
  exchange_each(archive, character.morphs, [&](character::MorphTarget& target) {
    exchange_plain(archive, target.name);
    archive.value(target.weight);
    exchange_plain(archive, target.displacements);
  });
  exchange_each(archive, character.clips, [&](character::Clip& clip) { exchange(archive, clip); });
  archive.value(read.metres_per_unit);
  archive.value(read.up);
  exchange_each(archive, read.warnings, [&](std::string& warning) { exchange_plain(archive, warning); });
}

}  // namespace

std::string to_bytes(ReadCharacter& read) {
  ByteWriter writer;
  exchange(writer, read);
  return std::move(writer.bytes);
}

ReadCharacter character_from_bytes(std::string_view bytes) {
  ReadCharacter read;
  ByteReader reader{bytes};
  exchange(reader, read);
  return read;
}

}  // namespace weft::assets
