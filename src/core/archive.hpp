// Serialisation: converts values to bytes and back. Each type has one function or member `serialize`, a template over
// the archive (ByteWriter or ByteReader), so that writing and reading use the same code. In this file, a "plain value"
// is a value of a trivially copyable type with neither padding nor pointers.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/types.hpp"

namespace weft {

/// Appends values to `bytes`, in the byte order of this machine.
struct ByteWriter {
  static constexpr bool kReads = false;
  std::string bytes;

  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  /// T must be a plain value: padding bytes would be indeterminate.
  template <class T>
  void value(T& value) {
    raw(&value, sizeof value);
  }
  /// Writes the number of entries. The second parameter has no effect; ByteReader::size() uses it.
  template <class List>
  void size(List& list, std::size_t = 1) {
    const std::size_t count = list.size();
    raw(&count, sizeof count);
  }
};

/// Reads values from the front of `bytes`. Throws std::runtime_error if there are too few bytes.
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
      unsigned char byte = 0;  // reading a bool whose byte is neither 0 nor 1 is undefined behaviour
      raw(&byte, 1);
      value = byte != 0;
    } else {
      raw(static_cast<void*>(&value), sizeof value);
    }
  }
  /// Reads a count and resizes the list. `min_entry_size`: minimum size of an entry [bytes]. Rejects a count of more
  /// entries than the remaining bytes can hold, so that damaged data cannot cause a huge allocation.
  template <class List>
  void size(List& list, std::size_t min_entry_size = 1) {
    std::size_t count = 0;
    raw(&count, sizeof count);
    if (count > bytes.size() / min_entry_size) throw std::runtime_error("the data was cut short");
    list.resize(count);
  }
};

/// Checks data that was read: throws std::runtime_error if `holds` is false. `expected`: what was expected, for the
/// message.
inline void require(bool holds, const char* expected) {
  if (!holds) throw std::runtime_error(std::string("the data does not fit: expected ") + expected);
}

/// Writes or reads plain values, one after the other.
template <class Archive, class... Values>
void serialize_values(Archive& archive, Values&... values) {
  (archive.value(values), ...);
}

/// Writes or reads a list of plain values, or a string.
template <class Archive, class List>
void serialize_plain(Archive& archive, List& list) {
  archive.size(list, sizeof list[0]);
  if (!list.empty()) archive.raw(static_cast<void*>(list.data()), list.size() * sizeof list[0]);
}

/// Writes or reads a list by calling `serialize_one` for each entry. `min_entry_size`: see ByteReader::size().
template <class Archive, class List, class Serialize>
void serialize_each(Archive& archive, List& list, const Serialize& serialize_one, std::size_t min_entry_size = 1) {
  archive.size(list, min_entry_size);
  for (auto& entry : list) serialize_one(entry);
}

/// Writes or reads a list of points or vectors. When reading, throws std::runtime_error if the list
/// does not have `count` entries or contains a value that is not finite.
template <class Archive>
void serialize_points(Archive& archive, std::vector<Vec3>& points, std::size_t count) {
  serialize_plain(archive, points);
  if constexpr (Archive::kReads) {
    require(points.size() == count, "as many points as the scene has");
    for (const Vec3& point : points) require(point.allFinite(), "finite points");
  }
}

}  // namespace weft
