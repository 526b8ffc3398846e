#include "film/assets/gltf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "core/input_file.hpp"
#include "core/json.hpp"
#include "core/nesting.hpp"
#include "film/assets/gltf_nodes.hpp"
#include "film/assets/import.hpp"
#include "film/assets/source.hpp"

namespace weft::assets {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kStart = "glTF";
// Binary layout: "glTF", version, length; then chunks: length, "JSON" or "BIN\0", content.
constexpr std::size_t kHeader = 12, kChunkHeader = 8;

/// A required extension is accepted if its name contains one of these texts. Such an extension changes only the
/// appearance, or is supported.
constexpr std::array kAllowedExtensions = {"_materials_",           "_texture_", "_technique", "_lights_", "_xmp",
                                           "KHR_mesh_quantization", "VRM"};

/// The two parts of a glTF file.
struct Gltf {
  bool is_binary = false;
  std::string text;  // JSON; empty if the file is no glTF
  std::string data;  // content of the binary chunk
};

std::uint32_t length_at(std::string_view bytes, std::size_t at) {
  std::uint32_t length = 0;
  if (at + sizeof length <= bytes.size()) std::memcpy(&length, &bytes[at], sizeof length);
  return length;
}

Gltf split(const std::filesystem::path& file) {
  Gltf gltf;
  gltf.is_binary = read_start(file, kStart.size()) == kStart;
  if (!gltf.is_binary && ending_of(file) != ".gltf") return gltf;
  const std::string bytes = read_bytes(file);
  if (!gltf.is_binary) {
    gltf.text = bytes;
  } else if (bytes.size() > kHeader + kChunkHeader) {
    gltf.text = bytes.substr(kHeader + kChunkHeader, length_at(bytes, kHeader));
    const std::size_t chunk = kHeader + kChunkHeader + gltf.text.size();
    if (chunk + kChunkHeader < bytes.size()) gltf.data = bytes.substr(chunk + kChunkHeader, length_at(bytes, chunk));
  }
  return gltf;
}

/// The entry of a list; throws if there is none.
const Json& entry_of(const Json& gltf, const char* list, int number) {
  const Json& entries = part_of(gltf, list);
  if (!entries.is_array() || number < 0 || std::cmp_greater_equal(number, entries.size()))
    throw std::runtime_error(fmt::format("expected one of {} {}, got number {}", entries.size(), list, number));
  return entries[static_cast<std::size_t>(number)];
}

/// Throws if a file requires an extension that is not supported.
void check_extensions(const Json& gltf) {
  for (const Json& required : part_of(gltf, "extensionsRequired")) {
    if (!required.is_string()) continue;
    const std::string name = required;
    if (std::ranges::any_of(kAllowedExtensions, [&](const char* part) { return name.find(part) != std::string::npos; }))
      continue;
    const bool packs = name.find("compression") != std::string::npos;
    throw std::runtime_error(fmt::format("expected {}, got {}, which is not read; export the file without it",
                                         packs ? "meshes without compression" : "no extension that the file requires",
                                         name));
  }
}

std::string base64_decoded(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string_view::npos) break;  // the padding
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// An integer type of the components of an accessor.
struct Component {
  int code;
  std::size_t bytes;
  bool is_signed;
};
constexpr int kFloat = 5126;
constexpr std::array<Component, 5> kIntegers{
    {{5120, 1, true}, {5121, 1, false}, {5122, 2, true}, {5123, 2, false}, {5125, 4, false}}};

const Component* integer_of(const Json& accessor) {
  const auto found = std::ranges::find(kIntegers, value_or<int>(accessor, "componentType", kFloat), &Component::code);
  return found == kIntegers.end() ? nullptr : &*found;
}

std::size_t size_of(const Json& json, const char* key) {
  return static_cast<std::size_t>(std::max(0, value_or<int>(json, key, 0)));
}

std::size_t components_of(const Json& accessor) {
  const std::string type = value_or<std::string>(accessor, "type", "");
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  if (type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4')
    return static_cast<std::size_t>(type[3] - '0');
  throw std::runtime_error(fmt::format("expected SCALAR or VEC2 to VEC4 as the type of integers, got \"{}\"", type));
}

/// Maximum time between the keys that replace a spline [s], and maximum number of such keys for one interval of the
/// spline.
constexpr double kSplineInterval = 1.0 / 60, kMaxSplinePieces = 1000;
/// Duration of the linear change that replaces a step [s]. It is shorter than a frame.
constexpr double kStepDuration = 1e-3;

/// Rewrites a glTF file as a binary one in which integers that assimp would read as floats are floats, the values of
/// all animations change linearly, and joints and animated nodes have names of their own.
class Rewriter {
 public:
  Rewriter(Json& gltf, std::string data, const std::filesystem::path& file) : gltf_(gltf), file_(file) {
    own_data_ = std::move(data);
  }

  /// The bytes of the new file; nullopt if nothing needs to change.
  std::optional<std::string> rewritten() {
    bool changed = add_missing_scene(gltf_);
    changed |= remove_other_channels(gltf_);
    changed |= copy_shared_parts(gltf_);
    changed |= name_nodes_apart(gltf_);
    add_bind_matrices();
    for (Json& mesh : list_of(gltf_, "meshes"))
      for (Json& primitive : list_of(mesh, "primitives")) {
        changed |= has_second_sets(part_of(primitive, "attributes"));
        use_floats(list_of(primitive, "attributes"));
        for (Json& target : list_of(primitive, "targets")) use_floats(target);
      }
    for (Json& animation : list_of(gltf_, "animations"))
      for (Json& sampler : list_of(animation, "samplers")) {
        make_linear(sampler);
        use_floats(sampler);
      }
    if (!changed && new_accessors_.empty() && floats_.empty()) return std::nullopt;
    return to_binary();
  }

 private:
  /// Whether attributes have second sets. assimp refuses such a set if it is before the first one in the text; the new
  /// text is sorted.
  static bool has_second_sets(const Json& attributes) {
    constexpr std::array kSecondSets{"TEXCOORD_1", "COLOR_1", "JOINTS_1", "WEIGHTS_1"};
    return std::ranges::any_of(kSecondSets, [&](const char* name) { return attributes.contains(name); });
  }

  /// Adds the matrices of skins that have none: the identity for each joint, which glTF prescribes then. assimp would
  /// read a null pointer.
  void add_bind_matrices() {
    for (Json& skin : list_of(gltf_, "skins")) {
      if (!skin.is_object() || skin.contains("inverseBindMatrices")) continue;
      std::vector<double> matrices(16 * part_of(skin, "joints").size(), 0.0);
      for (std::size_t i = 0; i < matrices.size(); ++i) matrices[i] = i % 16 % 5 == 0 ? 1 : 0;
      Json accessor;
      accessor["type"] = "MAT4";
      skin["inverseBindMatrices"] = append_floats(std::move(accessor), matrices);
    }
  }

  /// Replaces accessors of integers by new accessors of floats. Joints and colours keep their integers, since assimp
  /// reads joints as integers and converts colours.
  void use_floats(Json& accessors) {
    if (!accessors.is_object()) return;
    for (auto& [name, accessor] : accessors.items()) {
      if (!accessor.is_number_integer() || name.starts_with("JOINTS_") || name.starts_with("COLOR_")) continue;
      accessor = with_floats(accessor.get<int>());
    }
  }

  int with_floats(int accessor) {
    if (integer_of(entry_of(gltf_, "accessors", accessor)) == nullptr) return accessor;
    const auto known = new_accessors_.find(accessor);
    if (known != new_accessors_.end()) return known->second;
    const Json copy = entry_of(gltf_, "accessors", accessor);
    return new_accessors_[accessor] = append_floats(copy, values_of(copy));
  }

  /// Appends an accessor of floats, and returns its index. `copy`: an accessor with the same type of elements.
  int append_floats(Json copy, const std::vector<double>& values) {
    for (const char* key : {"normalized", "byteOffset", "min", "max", "sparse"}) copy.erase(key);
    copy["componentType"] = kFloat;
    copy["count"] = values.size() / components_of(copy);
    copy["bufferView"] = gltf_["bufferViews"].size();
    gltf_["bufferViews"].push_back(
        {{"buffer", -1}, {"byteOffset", floats_.size()}, {"byteLength", values.size() * sizeof(float)}});
    for (const double value : values) {
      const auto number = static_cast<float>(value);
      floats_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    gltf_["accessors"].push_back(std::move(copy));
    return static_cast<int>(gltf_["accessors"].size()) - 1;
  }

  /// Replaces the keys of a spline or of steps by more keys with linear interpolation, because assimp interpolates the
  /// keys of any sampler linearly. Does not change steps between equal values, which some programs write for objects
  /// that do not move.
  void make_linear(Json& sampler) {
    const std::string kind = value_or<std::string>(sampler, "interpolation", "");
    const bool spline = kind == "CUBICSPLINE";
    if (!spline && kind != "STEP") return;
    const Json input = entry_of(gltf_, "accessors", value_or<int>(sampler, "input", -1)),
               output = entry_of(gltf_, "accessors", value_or<int>(sampler, "output", -1));
    const std::vector<double> times = numbers_of(input), values = numbers_of(output);
    // A key of a spline has three parts: the tangent before the key, the value, and the tangent after the key.
    const std::size_t parts = spline ? 3 : 1, value_part = spline ? 1 : 0, keys = times.size();
    if (keys < 2 || values.empty() || values.size() % (parts * keys) != 0) return;
    if (!std::ranges::all_of(times, [](double t) { return std::isfinite(t); })) return;
    const std::size_t width = values.size() / (parts * keys);
    const auto part = [&](std::size_t key, std::size_t which) {
      return std::span(values).subspan((parts * key + which) * width, width);
    };
    bool still = !spline;
    for (std::size_t i = width; still && i < values.size(); ++i) still = values[i] == values[i - width];
    if (still) return;
    std::vector<double> new_times, new_values;
    for (std::size_t key = 0; key + 1 < keys; ++key) {
      const double begin = times[key], duration = times[key + 1] - begin;
      if (!spline) {
        for (const double t : {begin, begin + duration - std::min(kStepDuration, 0.5 * duration)}) {
          new_times.push_back(t);
          for (const double value : part(key, 0)) new_values.push_back(value);
        }
        continue;
      }
      const int pieces =
          static_cast<int>(std::clamp(std::ceil(duration / kSplineInterval - 1e-6), 1.0, kMaxSplinePieces));
      for (int piece = 0; piece < pieces; ++piece) {
        const double u = static_cast<double>(piece) / pieces;
        new_times.push_back(begin + u * duration);
        for (std::size_t i = 0; i < width; ++i)  // glTF 2.0, appendix C.5
          new_values.push_back((2 * u * u * u - 3 * u * u + 1) * part(key, 1)[i] +
                               duration * (u * u * u - 2 * u * u + u) * part(key, 2)[i] +
                               (3 * u * u - 2 * u * u * u) * part(key + 1, 1)[i] +
                               duration * (u * u * u - u * u) * part(key + 1, 0)[i]);
      }
    }
    new_times.push_back(times.back());
    for (const double value : part(keys - 1, value_part)) new_values.push_back(value);
    sampler["interpolation"] = "LINEAR";
    sampler["input"] = append_floats(input, new_times);
    sampler["output"] = append_floats(output, new_values);
  }

  /// The values of an accessor of integers or floats.
  std::vector<double> numbers_of(const Json& accessor) {
    if (integer_of(accessor) != nullptr) return values_of(accessor);
    // Reads each float as an integer with the same bits, then converts the bits back.
    Json bits = accessor;
    bits.erase("normalized");
    bits["componentType"] = kIntegers.back().code;
    std::vector<double> values = values_of(bits);
    for (double& value : values) value = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
    return values;
  }

  /// The values of an accessor of integers, including the replacements of its sparse part.
  std::vector<double> values_of(const Json& accessor) {
    const std::size_t components = components_of(accessor), count = size_of(accessor, "count");
    const bool normalised = accessor.contains("normalized") && accessor["normalized"] == true;
    std::vector<double> values(count * components, 0.0);
    if (accessor.contains("bufferView"))
      values = integers(accessor, *integer_of(accessor), count, components, normalised);
    const Json& sparse = part_of(accessor, "sparse");
    if (!sparse.is_object()) return values;
    const std::size_t replaced = size_of(sparse, "count");
    const Component* index = integer_of(part_of(sparse, "indices"));
    if (index == nullptr) throw std::runtime_error("expected integers as indices of a sparse accessor, got floats");
    const std::vector<double> at = integers(part_of(sparse, "indices"), *index, replaced, 1, false),
                              by = integers(part_of(sparse, "values"), *integer_of(accessor), replaced, components,
                                            normalised);
    for (std::size_t i = 0; i < replaced; ++i) {
      if (at[i] >= static_cast<double>(count))
        throw std::runtime_error(fmt::format(
            "expected indices of a sparse accessor below {}, its number of elements, got {}", count, at[i]));
      for (std::size_t k = 0; k < components; ++k)
        values[static_cast<std::size_t>(at[i]) * components + k] = by[i * components + k];
    }
    return values;
  }

  /// Reads integers as doubles. `from`: an accessor or a part of one, which states the buffer view and the offset in
  /// it.
  std::vector<double> integers(const Json& from, const Component& type, std::size_t count, std::size_t components,
                               bool normalised) {
    const Json& view = entry_of(gltf_, "bufferViews", value_or<int>(from, "bufferView", -1));
    const std::string& data = data_of(value_or<int>(view, "buffer", -1));
    const std::size_t element = components * type.bytes, stated = size_of(view, "byteStride"),
                      stride = stated > 0 ? stated : element,
                      start = size_of(view, "byteOffset") + size_of(from, "byteOffset");
    if (count > 0 &&
        (start > data.size() || data.size() - start < element || (data.size() - start - element) / stride < count - 1))
      throw std::runtime_error(
          fmt::format("expected {} elements of {} bytes in a buffer, which has {} bytes", count, element, data.size()));
    const double largest = std::pow(2.0, static_cast<double>(8 * type.bytes - (type.is_signed ? 1 : 0))) - 1;
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < components; ++k) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &data[start + i * stride + k * type.bytes], type.bytes);
        double value = bits;
        if (type.is_signed && value > largest) value -= 2 * (largest + 1);
        values.push_back(normalised ? std::max(value / largest, -1.0) : value);
      }
    return values;
  }

  const std::string& data_of(int buffer) {
    const auto [known, is_new] = buffers_.try_emplace(buffer);
    if (!is_new) return known->second;
    const std::string uri = value_or<std::string>(entry_of(gltf_, "buffers", buffer), "uri", "");
    const std::size_t inside = uri.find(";base64,");
    if (uri.empty())
      known->second = own_data_;
    else if (uri.starts_with("data:") && inside != std::string::npos)
      known->second = base64_decoded(std::string_view(uri).substr(uri.find(',') + 1));
    else
      known->second = read_bytes(file_.parent_path() / percent_decode(uri), kMaxMeshFileBytes);
    return known->second;
  }

  std::string to_binary() {
    std::string data;
    std::vector<std::size_t> starts;
    const auto append = [&](const std::string& bytes) {
      starts.push_back(data.size());
      data += bytes;
      data.resize((data.size() + 3) / 4 * 4, '\0');
    };
    for (std::size_t b = 0; b < part_of(gltf_, "buffers").size(); ++b) append(data_of(static_cast<int>(b)));
    append(floats_);
    for (Json& view : list_of(gltf_, "bufferViews")) {
      const int buffer = value_or<int>(view, "buffer", 0);
      if (buffer >= 0) entry_of(gltf_, "buffers", buffer);  // checks the number
      const std::size_t start = buffer < 0 ? starts.back() : starts[static_cast<std::size_t>(buffer)];
      view["buffer"] = 0;
      view["byteOffset"] = start + size_of(view, "byteOffset");
    }
    gltf_["buffers"] = Json::array({{{"byteLength", data.size()}}});
    std::string text = sorted_json_text(gltf_);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes(kStart);
    const auto append_number = [&](std::size_t number) {
      const auto value = static_cast<std::uint32_t>(number);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    append_number(2);
    append_number(kHeader + 2 * kChunkHeader + text.size() + data.size());
    append_number(text.size());
    bytes += "JSON" + text;
    append_number(data.size());
    bytes.append("BIN\0", 4);
    return bytes + data;
  }

  Json& gltf_;
  std::string own_data_;
  const std::filesystem::path& file_;
  std::map<int, std::string> buffers_;
  std::map<int, int> new_accessors_;  // index of an accessor of integers -> index of its accessor of floats
  std::string floats_;
};

}  // namespace

std::optional<std::string> readable_gltf(const std::filesystem::path& file) {
  const Gltf parts = split(file);
  if (nests_too_deep(parts.text))
    throw std::runtime_error(
        fmt::format("expected JSON of at most {} levels of lists and objects, got more", kMaxDepth));
  Json gltf;
  try {
    if (!parts.text.empty()) gltf = parse_json<Json>(parts.text);
  } catch (const std::exception&) {
    // assimp reports the mistake when it reads the file
  }
  check_extensions(gltf);
  if (auto bytes = Rewriter(gltf, parts.data, file).rewritten()) return bytes;
  return parts.is_binary && file.extension() != ".glb" ? std::optional(read_bytes(file)) : std::nullopt;
}

}  // namespace weft::assets
