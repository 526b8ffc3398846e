#include "film/assets/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/input_file.hpp"
#include "film/assets/source.hpp"

namespace weft::assets {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf", kSpace = " \t\r";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    words.push_back(line.substr(0, line.find_first_of(kSpace)));
    line.remove_prefix(words.back().size());
  }
  return words;
}

// A line of OBJ without the comment after its numbers. Lines without numbers are not changed, because names may contain
// the character #.
std::string_view without_comment(std::string_view line) {
  constexpr std::array<std::string_view, 6> kWithNumbers{"v", "vt", "vn", "f", "l", "p"};
  const std::string_view start = trimmed(line);
  const std::string_view keyword = start.substr(0, start.find_first_of(kSpace));
  return std::ranges::count(kWithNumbers, keyword) > 0 ? line.substr(0, line.find('#')) : line;
}

// The statements in a line of the hierarchy of BVH: a brace, or a keyword with what follows it. Most files have one
// statement in each line.
std::vector<std::string> statements_of(std::string_view line) {
  constexpr std::array<std::string_view, 7> kFirstWords{"hierarchy", "root", "joint", "offset",
                                                        "channels",  "end",  "motion"};
  std::string spaced;  // braces are words of their own
  for (const char c : line) spaced += c == '{' || c == '}' ? std::string{' ', c, ' '} : std::string(1, c);
  std::vector<std::string> statements;
  bool in_name = false;  // names of joints may contain spaces and keywords
  for (const std::string_view word : words_of(spaced)) {
    const std::string lower = lower_case(word);
    const bool is_brace = word == "{" || word == "}";
    if (is_brace || statements.empty() || (!in_name && std::ranges::count(kFirstWords, std::string_view(lower)) > 0)) {
      statements.emplace_back(word);
      in_name = lower == "root" || lower == "joint";
    } else {
      statements.back() += ' ' + std::string(word);
    }
  }
  return statements;
}

// A statement of the hierarchy of BVH, in the usual spelling.
std::string usual_bvh_statement(std::string_view statement) {
  constexpr std::array<std::string_view, 14> kUsual{"HIERARCHY", "ROOT",      "JOINT",     "OFFSET",    "CHANNELS",
                                                    "End",       "Site",      "MOTION",    "Xposition", "Yposition",
                                                    "Zposition", "Xrotation", "Yrotation", "Zrotation"};
  std::string text;
  const std::vector<std::string_view> words = words_of(statement);
  const std::string first = words.empty() ? "" : lower_case(words[0]);
  const bool names_joint = first == "root" || first == "joint";
  for (std::size_t w = 0; w < words.size(); ++w) {
    const bool in_name = names_joint && w > 0;
    std::string word(words[w]);
    for (const std::string_view usual : kUsual)
      if (!in_name && lower_case(word) == lower_case(usual)) word = usual;
    if (w > 0) text += in_name && w > 1 ? '_' : ' ';
    text += word;
  }
  return text;
}

// A line of BVH between "MOTION" and the frames, in the usual spelling.
std::string usual_bvh_header(std::string_view line) {
  std::string name;
  const std::size_t colon = line.find(':');
  for (const char c : lower_case(line.substr(0, colon)))
    if (kSpace.find(c) == std::string_view::npos) name += c;
  if (colon != std::string_view::npos && name == "frames") return "Frames:" + std::string(line.substr(colon + 1));
  if (colon != std::string_view::npos && name == "frametime")
    return "Frame Time:" + std::string(line.substr(colon + 1));
  return std::string(line);
}

// A joint of BVH: the number of its values in each frame, and the values that follow them in the rewritten file.
struct BvhJoint {
  std::size_t values = 0;
  std::string added;
};

// A line of channels of BVH, completed to three positions and three rotations if it has positions: assimp reads the
// positions of a joint only if it has six channels. Missing positions are those of the joint's `offset`, missing
// rotations 0. Appends the joint to `joints`, unless it has no channels.
std::string with_all_channels(const std::string& line, const std::array<std::string, 3>& offset,
                              std::vector<BvhJoint>& joints) {
  constexpr std::array<std::string_view, 6> kChannels{"Xposition", "Yposition", "Zposition",
                                                      "Xrotation", "Yrotation", "Zrotation"};
  const std::vector<std::string_view> words = words_of(line);
  BvhJoint joint;
  if (words.size() > 1) std::from_chars(words[1].data(), words[1].data() + words[1].size(), joint.values);
  if (joint.values == 0) return line;
  std::string completed = "CHANNELS 6";
  for (std::size_t w = 2; w < words.size(); ++w) completed += ' ' + std::string(words[w]);
  std::size_t missing = 0, missing_positions = 0;
  for (std::size_t k = 0; k < kChannels.size(); ++k) {
    if (std::ranges::find(words, kChannels[k]) != words.end()) continue;
    ++missing;
    missing_positions += k < offset.size() ? 1 : 0;
    completed += ' ' + std::string(kChannels[k]);
    joint.added += (k < offset.size() ? offset[k] : "0") + ' ';
  }
  const bool has_each_once = words.size() == 2 + joint.values && missing + joint.values == kChannels.size();
  const bool completes = missing > 0 && missing_positions < offset.size() && has_each_once;
  if (!completes) joint.added.clear();
  joints.push_back(joint);
  return completes ? completed : line;
}

template <class Change>
std::string change_lines(std::string_view text, const Change& change) {
  std::string changed;
  changed.reserve(text.size());
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    changed += change(line);
    text.remove_prefix(line.size());
    if (text.empty()) break;
    changed += '\n';
    text.remove_prefix(1);
  }
  return changed;
}

std::string usual_bvh(std::string_view text) {
  enum class Part { hierarchy, header, frames } part = Part::hierarchy;
  std::array<std::string, 3> offset{"0", "0", "0"};
  std::vector<BvhJoint> joints;
  std::set<std::string> names;       // of joints
  std::size_t joint = 0, value = 0;  // of the next value in the frames
  return change_lines(text, [&](std::string_view line) -> std::string {
    if (part == Part::hierarchy) {
      std::string completed;
      for (const std::string& statement : statements_of(line)) {
        std::string usual = usual_bvh_statement(statement);
        if (usual == "MOTION") part = Part::header;
        // assimp finds the joint of a channel by its name.
        if (usual.starts_with("ROOT ") || usual.starts_with("JOINT "))
          while (!names.insert(usual.substr(usual.find(' '))).second) usual += '_';
        const std::vector<std::string_view> words = words_of(usual);
        if (usual.starts_with("OFFSET"))
          for (std::size_t k = 1; k < std::min(words.size(), offset.size() + 1); ++k) offset[k - 1] = words[k];
        if (usual.starts_with("CHANNELS")) usual = with_all_channels(usual, offset, joints);
        completed += (completed.empty() ? "" : " ") + usual;
      }
      return completed;
    }
    if (part == Part::frames) {
      if (std::ranges::all_of(joints, [](const BvhJoint& each) { return each.added.empty(); }))
        return std::string(line);
      std::string completed;
      for (const std::string_view word : words_of(line)) {
        completed += std::string(word) + ' ';
        if (++value < joints[joint].values) continue;
        completed += joints[joint].added;
        joint = (joint + 1) % joints.size(), value = 0;
      }
      return completed;
    }
    std::string usual = usual_bvh_header(line);
    if (usual.starts_with("Frame Time:")) part = Part::frames;
    return usual;
  });
}

}  // namespace

void check_bvh(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  std::string_view text = bytes;
  bool in_hierarchy = true;
  int roots = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (in_hierarchy) {
      for (const std::string& statement : statements_of(line)) {
        const std::string usual = usual_bvh_statement(statement);
        roots += usual.starts_with("ROOT") ? 1 : 0;
        if (usual == "MOTION") in_hierarchy = false;
      }
    } else if (const std::string usual = usual_bvh_header(line); usual.starts_with("Frames:")) {
      const std::string_view count = trimmed(std::string_view(usual).substr(usual.find(':') + 1));
      double frames = 1;
      std::from_chars(count.data(), count.data() + count.size(), frames);
      if (!(frames >= 1)) throw std::runtime_error(fmt::format("expected at least one frame, got Frames: {}", count));
      break;
    }
  }
  if (roots > 1)
    throw std::runtime_error(
        fmt::format("expected one skeleton, got {} (ROOT); export each to a file of its own", roots));
}

std::optional<std::string> readable_text(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  const bool has_byte_order_mark = read_start(file, kByteOrderMark.size()) == kByteOrderMark;
  if (!has_byte_order_mark && ending != ".obj" && ending != ".bvh") return std::nullopt;
  const std::string bytes = read_bytes(file);
  const std::string_view text = std::string_view(bytes).substr(has_byte_order_mark ? kByteOrderMark.size() : 0);
  std::string readable = ending == ".obj"   ? change_lines(text, without_comment)
                         : ending == ".bvh" ? usual_bvh(text)
                                            : std::string(text);
  return readable == bytes ? std::nullopt : std::optional(std::move(readable));
}

}  // namespace weft::assets
