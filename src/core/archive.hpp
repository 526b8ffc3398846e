// Values to plain bytes and back. A type is described once, as `template <class Archive> void serialize(Archive&, T&)`,
// so that writing and reading cannot differ.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/types.hpp"

namespace weft {

/// Appends what it is called with, in the byte order of this machine.
struct ByteWriter {
  static constexpr bool kReads = false;
  std::string bytes;

  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  /// Plain values without padding, which would be bytes that nobody has set.
  template <class T>
  void value(T& value) {
    raw(&value, sizeof value);
  }
  template <class List>
  void size(List& list, std::size_t = 1) {
    const std::size_t count = list.size();
    raw(&count, sizeof count);
  }
};

/// Fills what it is called with. Throws std::runtime_error where the bytes are too few.
struct ByteReader {
  static constexpr bool kReads = true;
  std::string_view bytes;

  void raw(void* data, std::size_t size) {
    if (bytes.size() < size) throw std::runtime_error("the data was cut short");
    if (size > 0) std::memcpy(data, bytes.data(), size);
    bytes.remove_prefix(size);
  }
  template <class T>
  void value(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;  // of which a bool may hold but two values
      raw(&byte, 1);
      value = byte != 0;
    } else {
      raw(static_cast<void*>(&value), sizeof value);
    }
  }
  /// Each entry takes `least` bytes or more: no more memory is asked for than the bytes can fill.
  template <class List>
  void size(List& list, std::size_t least = 1) {
    std::size_t count = 0;
    raw(&count, sizeof count);
    if (count > bytes.size() / least) throw std::runtime_error("the data was cut short");
    list.resize(count);
  }
};

/// For what was read: throws std::runtime_error where it cannot be.
inline void require(bool holds, const char* expected) {
  if (!holds) throw std::runtime_error(std::string("the data does not fit: expected ") + expected);
}

/// Plain values, one after the other.
template <class Archive, class... Values>
void serialize_values(Archive& archive, Values&... values) {
  (archive.value(values), ...);
}

/// A list of plain values, or a text.
template <class Archive, class List>
void serialize_plain(Archive& archive, List& list) {
  archive.size(list, sizeof list[0]);
  if (!list.empty()) archive.raw(static_cast<void*>(list.data()), list.size() * sizeof list[0]);
}

template <class Archive, class List, class Serialize>
void serialize_each(Archive& archive, List& list, const Serialize& serialize_one, std::size_t least = 1) {
  archive.size(list, least);
  for (auto& entry : list) serialize_one(entry);
}

/// A list whose length is known before it is read, of finite points or vectors.
template <class Archive>
void serialize_points(Archive& archive, std::vector<Vec3>& points, std::size_t count) {
  serialize_plain(archive, points);
  if constexpr (Archive::kReads) {
    require(points.size() == count, "as many points as the scene has");
    for (const Vec3& point : points) require(point.allFinite(), "finite points");
  }
}

// The names of before, for the modules that still use them.
template <class Archive, class... Values>
void exchange_values(Archive& archive, Values&... values) {
  serialize_values(archive, values...);
}
template <class Archive, class List>
void exchange_plain(Archive& archive, List& list) {
  serialize_plain(archive, list);
}
template <class Archive, class List, class Serialize>
void exchange_each(Archive& archive, List& list, const Serialize& serialize_one, std::size_t least = 1) {
  serialize_each(archive, list, serialize_one, least);
}
template <class Archive>
void exchange_points(Archive& archive, std::vector<Vec3>& points, std::size_t count) {
  serialize_points(archive, points, count);
}

}  // namespace weft
