#include <cstring>
#include <stdexcept>

#include "assets/character_reader.hpp"

namespace weft::assets {
namespace {

/// Appends what it is called with.
struct Writer {
  std::string bytes;

  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  template <class T>
  void value(T& value) {
    raw(&value, sizeof value);
  }
  template <class List>
  void size(List& list) {
    const std::size_t count = list.size();
    raw(&count, sizeof count);
  }
};

/// Fills what it is called with.
struct Reader {
  std::string_view bytes;

  void raw(void* data, std::size_t size) {
    if (bytes.size() < size) throw std::runtime_error("the reader's answer was cut short");
    if (size > 0) std::memcpy(data, bytes.data(), size);
    bytes.remove_prefix(size);
  }
  template <class T>
  void value(T& value) {
    raw(static_cast<void*>(&value), sizeof value);
  }
  template <class List>
  void size(List& list) {
    std::size_t count = 0;
    raw(&count, sizeof count);
    if (count > bytes.size())
      throw std::runtime_error("the reader's answer was cut short");  // each takes a byte or more
    list.resize(count);
  }
};

/// A list of plain values, or a text.
template <class Archive, class List>
void plain(Archive& archive, List& list) {
  archive.size(list);
  if (!list.empty()) archive.raw(static_cast<void*>(list.data()), list.size() * sizeof list[0]);
}

template <class Archive, class List, class Each>
void each(Archive& archive, List& list, const Each& exchange) {
  archive.size(list);
  for (auto& entry : list) exchange(entry);
}

template <class Archive, class Value>
void exchange(Archive& archive, character::Curve<Value>& curve) {
  plain(archive, curve.times);
  plain(archive, curve.values);
}

template <class Archive>
void exchange(Archive& archive, character::Clip& clip) {
  plain(archive, clip.name);
  archive.value(clip.duration);
  each(archive, clip.channels, [&](character::Channel& channel) {
    archive.value(channel.node);
    exchange(archive, channel.position);
    exchange(archive, channel.rotation);
    exchange(archive, channel.scale);
  });
  each(archive, clip.morphs, [&](character::MorphChannel& channel) {
    archive.value(channel.target);
    exchange(archive, channel.weight);
  });
}

/// Writing and reading are the same list of parts, so that they cannot differ.
template <class Archive>
void exchange(Archive& archive, ReadCharacter& read) {
  character::Character& character = read.character;
  each(archive, character.nodes, [&](character::Node& node) {
    plain(archive, node.name);
    archive.value(node.parent);
    archive.value(node.local);
  });
  plain(archive, character.bones);
  plain(archive, character.mesh.topology.quads);
  plain(archive, character.mesh.topology.triangles);
  plain(archive, character.mesh.positions);
  plain(archive, character.first_influence);
  plain(archive, character.influences);
  each(archive, character.morphs, [&](character::MorphTarget& target) {
    plain(archive, target.name);
    archive.value(target.weight);
    plain(archive, target.displacements);
  });
  each(archive, character.clips, [&](character::Clip& clip) { exchange(archive, clip); });
  archive.value(read.metres_per_unit);
  archive.value(read.up);
  each(archive, read.warnings, [&](std::string& warning) { plain(archive, warning); });
}

}  // namespace

std::string to_bytes(ReadCharacter& read) {
  Writer writer;
  exchange(writer, read);
  return std::move(writer.bytes);
}

ReadCharacter character_from_bytes(std::string_view bytes) {
  ReadCharacter read;
  Reader reader{bytes};
  exchange(reader, read);
  return read;
}

}  // namespace weft::assets
