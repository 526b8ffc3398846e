#include "character/joints.hpp"

#include <algorithm>
#include <cctype>
#include <map>

namespace weft::character {
namespace {

/// A part of the body, and its names, in the order in which they are preferred where a rig has several.
struct Part {
  std::string name;
  std::vector<std::string> aliases;
};

const std::vector<Part> kMiddle = {
    {"Hips", {"hips", "pelvis", "hip"}},
    {"Spine", {"spine", "abdomen", "lowerback", "spine01", "waist", "ab", "spine1"}},
    {"Chest", {"chest", "spine03", "spine3", "spine2", "spine1", "thorax"}},
    {"Neck", {"neck", "neck01", "neck1"}},
    {"Head", {"head"}},
};
const std::vector<Part> kSides = {
    {"Shoulder", {"clavicle", "collar", "shoulder"}},
    {"UpperArm", {"upperarm", "arm", "shldr", "uparm", "shoulder"}},
    {"LowerArm", {"lowerarm", "forearm", "elbow"}},
    {"Hand", {"hand", "wrist"}},
    {"UpperLeg", {"upperleg", "upleg", "thigh", "hip"}},
    {"LowerLeg", {"lowerleg", "leg", "calf", "shin", "knee"}},
    {"Foot", {"foot", "ankle"}},
    {"Toes", {"toes", "toe", "toebase", "toe0", "ball"}},
};

/// The words of a name in lower case: "Bip01 L UpperArm" and "upper_arm.L" have "upper", "arm" and "l". Digits stay
/// with the word before them. What stands before a colon is the name of a rig.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  bool inside = false;
  const std::size_t start = name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1;
  for (std::size_t i = start; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isalnum(c) == 0) {
      inside = inside && i + 1 < name.size() && std::isdigit(static_cast<unsigned char>(name[i + 1])) != 0;
      continue;
    }
    // A capital begins a word after a small letter, and before one: "LeftArm", "LHipJoint".
    const bool after_small = i > start && std::isupper(static_cast<unsigned char>(name[i - 1])) == 0;
    const bool before_small = i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1])) != 0;
    if (!inside || (std::isupper(c) != 0 && (after_small || before_small))) words.emplace_back();
    inside = true;
    words.back() += static_cast<char>(std::tolower(c));
  }
  return words;
}

/// "", "Left" or "Right", and the rest of a name in one word.
std::pair<std::string, std::string> side_and_part(const std::string& name) {
  std::string side, part;
  for (const std::string& word : words_of(name)) {
    if (word == "l" || word == "left") {
      side = "Left";
    } else if (word == "r" || word == "right") {
      side = "Right";
    } else if (!word.starts_with("bip0") && word != "b" && word != "def") {
      part += word;
    }
  }
  return {side, part};
}

}  // namespace

const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const Part& part : kMiddle) names.push_back(part.name);
    for (const char* side : {"Left", "Right"})
      for (const Part& part : kSides) names.push_back(side + part.name);
    return names;
  }();
  return kNames;
}

Index joint_number(const std::string& name) {
  const auto& names = joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<Index>(found - names.begin());
}

std::vector<Index> find_joints(std::span<const Node> nodes) {
  std::map<std::pair<std::string, std::string>, Index> known;  // the first of each name counts
  for (std::size_t n = 0; n < nodes.size(); ++n) known.emplace(side_and_part(nodes[n].name), static_cast<Index>(n));
  std::vector<Index> joints;
  const auto find = [&](const std::string& side, const Part& part) {
    for (const std::string& alias : part.aliases)
      if (const auto found = known.find({side, alias}); found != known.end()) return found->second;
    return Index{-1};
  };
  for (const Part& part : kMiddle) joints.push_back(find("", part));
  for (const char* side : {"Left", "Right"}) {
    const std::size_t shoulder = joints.size();
    for (const Part& part : kSides) joints.push_back(find(side, part));
    // What some call the shoulder is the upper arm where there is no other.
    if (joints[shoulder] == joints[shoulder + 1]) joints[shoulder] = -1;
  }
  return joints;
}

}  // namespace weft::character
