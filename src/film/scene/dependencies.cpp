#include "film/scene/dependencies.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "core/input_file.hpp"
#include "film/scene/sequence_files.hpp"

namespace weft::scene {
namespace {

namespace fs = std::filesystem;

/// Maximum size of a dependency [bytes]. Larger files are skipped, because the readers of all formats refuse them.
constexpr std::uintmax_t kMaxDependencyBytes = std::uintmax_t{256} << 20;

/// Maximum length of a file name with its folders [bytes]. Longer texts are not taken for file names.
constexpr std::size_t kMaxFileNameBytes = 1024;

bool is_alphanumeric(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

/// Whether a text may be a file name. It must end with a dot and 2 to 12 letters and digits, at least one of them a
/// letter. It must not begin with this dot, and must not be longer than kMaxFileNameBytes.
bool has_extension(std::string_view text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos || dot == 0 || text.size() > kMaxFileNameBytes) return false;
  const std::string_view ending = text.substr(dot + 1);
  return ending.size() >= 2 && ending.size() <= 12 && std::ranges::all_of(ending, is_alphanumeric) &&
         !std::ranges::all_of(ending, [](char c) { return c >= '0' && c <= '9'; });
}

/// Decodes escapes such as %20, which addresses in glTF and Collada files contain. Replaces
/// backslashes by slashes.
std::string decode_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(&text[i + 1], &text[i + 3], byte, 16).ptr == &text[i + 3]) {
      plain += static_cast<char>(byte);
      i += 2;
    } else {
      plain += text[i] == '\\' ? '/' : text[i];
    }
  }
  return plain;
}

/// Finds possible file names in text or binary content. Splits the content twice: first at quotes and control
/// characters, then also at brackets, commas, equals signs and bars. Returns the pieces, and the words in pieces, for
/// which has_extension() is true.
std::set<std::string> find_possible_names(std::string_view content) {
  std::set<std::string> names;
  const auto add = [&](std::string_view text) {
    if (has_extension(text)) names.insert(decode_escapes(text));
  };
  const auto split = [](std::string_view text, const auto& is_end, const auto& use) {
    for (std::size_t begin = 0; begin < text.size();) {
      std::size_t end = begin;
      while (end < text.size() && !is_end(text[end])) ++end;
      if (end > begin) use(text.substr(begin, end - begin));
      begin = end + 1;
    }
  };
  for (const std::string_view separators : {"\"'\x7F", "\"'<>(),=|\x7F"}) {
    const auto ends_text = [&](char c) {
      return (static_cast<unsigned char>(c) < 0x20) || separators.find(c) != std::string_view::npos;
    };
    split(content, ends_text, [&](std::string_view text) {
      const std::size_t first = text.find_first_not_of(' ');
      if (first == std::string_view::npos || text.find('.') == std::string_view::npos) return;
      text = text.substr(first, text.find_last_not_of(' ') + 1 - first);
      add(text);
      if (text.find(' ') != std::string_view::npos)
        split(
            text, [](char c) { return c == ' '; }, add);
    });
  }
  return names;
}

/// Visits files and the files that they name, each file once.
class DependencyWalk {
 public:
  explicit DependencyWalk(const DependencyVisitor& each) : each_(each) {}

  /// Visits a file and all files that it names, directly or through other files.
  void visit(const fs::path& file, FileUse use = FileUse::simulation) {
    const std::optional<std::string> content = visit_alone(file, use);
    if (!content) return;
    for (const std::string& name : find_possible_names(*content)) visit(file.parent_path() / name, use);
    // The library assimp also reads the motion file that has the same name, but this extension.
    if (file.extension() == ".md5mesh") visit(fs::path(file).replace_extension(".md5anim"), use);
  }

  /// Visits a file without the files that it names. Returns its content; nothing if the file was
  /// visited before, cannot be read or is too large.
  std::optional<std::string> visit_alone(const fs::path& file, FileUse use) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || !visited_.insert(fs::weakly_canonical(file, error)).second) return {};
    if (fs::file_size(file, error) > kMaxDependencyBytes) return {};
    std::string content;
    try {
      content = read_bytes(file, kMaxDependencyBytes);
    } catch (const std::runtime_error&) {
      return {};  // the reader of its format reports the reason
    }
    each_(file, content, use);
    return content;
  }

 private:
  const DependencyVisitor& each_;
  std::set<fs::path> visited_;
};

}  // namespace

void for_each_dependency(const Scene& scene, const DependencyVisitor& each) {
  DependencyWalk walk(each);
  for (const Obstacle& obstacle : scene.obstacles)
    if (const auto* mesh = std::get_if<MeshFile>(&obstacle.shape)) walk.visit(mesh->path);
  for (const Cloth& cloth : scene.cloths) {
    if (!cloth.file.empty()) walk.visit(cloth.file);
    for (const Pin& pin : cloth.pins)
      if (pin.mask) walk.visit_alone(*pin.mask, FileUse::simulation);
    for (const Weight& weight : cloth.weights)
      if (weight.mask) walk.visit_alone(*weight.mask, FileUse::simulation);
  }
  for (const Attachment& attachment : scene.attachments)
    if (attachment.mask) walk.visit_alone(*attachment.mask, FileUse::simulation);
  for (const Character& character : scene.characters) {
    if (const auto* file = std::get_if<CharacterFile>(&character.source)) walk.visit(file->path);
    if (const SkeletonMotion* skeleton_motion = skeleton_motion_of(character);
        skeleton_motion != nullptr && skeleton_motion->motion)
      walk.visit(*skeleton_motion->motion);
    if (const auto* sequence = std::get_if<MeshSequence>(&character.source))
      for (const fs::path& file : sequence_files(sequence->files)) walk.visit(file);
  }
  const auto visit_picture = [&](const Paint& paint) {
    if (paint.image) walk.visit_alone(*paint.image, FileUse::pictures);
  };
  const auto visit_pictures = [&](const auto& objects) {
    for (const auto& object : objects) {
      visit_picture(object.look);
      for (const PanelPaint& panel : object.look.panels) visit_picture(panel);
    }
  };
  visit_pictures(scene.cloths);
  visit_pictures(scene.obstacles);
  visit_pictures(scene.characters);
  for (const Camera& camera : scene.cameras)
    if (!camera.file.empty()) walk.visit(camera.file, FileUse::pictures);
}

}  // namespace weft::scene
