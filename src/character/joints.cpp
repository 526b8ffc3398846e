#include "character/joints.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "character/nameless.hpp"

namespace weft::character {
namespace {

/// A part of the body, and its names, in the order in which they are preferred where a rig has several.
struct Part {
  std::string name;
  std::vector<std::string> aliases;
};

// Mixamo, Rokoko and MotionBuilder; Rigify; Character Creator; Unreal; Unity, VRM and Bandai; SMPL; CMU as BVH and as
// Acclaim; 100STYLE and Xsens; Biped, Truebones and Source; Poser and DAZ; MakeHuman; our mannequin.
const std::vector<Part> kMiddle = {
    {"Hips", {"hips", "pelvis", "hip"}},
    {"Spine",
     {"spine", "abdomen", "lowerback", "spine01", "spine001", "waist", "ab", "abdomenlower", "spine1", "torso"}},
    {"Chest",
     {"upperchest", "chest", "spine03", "spine003", "spine3", "spine2", "spine02", "spine1", "thorax", "chestupper"}},
    {"Neck", {"neck", "neck01", "neck1", "necktwist01", "lowerneck", "necklower", "spine004"}},
    {"Head", {"head", "spine006"}},
};
const std::vector<Part> kSides = {
    {"Shoulder", {"clavicle", "collar", "shoulder", "thorax"}},
    {"UpperArm", {"upperarm", "arm", "shldr", "shldrbend", "uparm", "upperarm01", "humerus", "shoulder"}},
    {"LowerArm", {"lowerarm", "forearm", "forearmbend", "lowarm", "lowerarm01", "radius", "elbow"}},
    {"Hand", {"wrist", "hand"}},
    {"UpperLeg", {"upperleg", "upleg", "thigh", "thighbend", "upperleg01", "femur", "hip", "leg"}},
    {"LowerLeg", {"lowerleg", "lowleg", "calf", "shin", "lowerleg01", "tibia", "knee", "leg"}},
    {"Foot", {"ankle", "foot"}},
    {"Toes", {"toes", "toe", "toebase", "toe0", "ball", "forefoot", "foot"}},
};

/// What stands in names of nodes beside side and part: of Biped, Rigify, Source, VRM, Character Creator, Meebits, and
/// of Mixamo where a program has left out the colon.
bool says_nothing(const std::string& word) {
  static const std::vector<std::string> kWords = {"b", "bn",  "c",     "cc",    "base", "def",
                                                  "j", "bip", "biped", "valve", "m",    "bone"};
  return word.starts_with("bip0") || word.starts_with("mixamorig") || std::ranges::find(kWords, word) != kWords.end();
}

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
    } else if (!says_nothing(word) || (word == "base" && !part.empty())) {
      part += word;
    }
  }
  // "lfemur", "righthand": where nothing but the case could part them.
  for (const auto& [letters, which] : {std::pair{"left", "Left"}, {"right", "Right"}, {"l", "Left"}, {"r", "Right"}})
    if (side.empty() && part.starts_with(letters)) {
      const std::string rest = part.substr(std::string(letters).size());
      for (const Part& known : kSides)
        if (std::ranges::find(known.aliases, rest) != known.aliases.end()) return {which, rest};
    }
  return {side, part};
}

/// A node and its ancestors, from itself upward.
std::vector<Index> line_of(std::span<const Node> nodes, Index node) {
  std::vector<Index> line;
  for (; node >= 0; node = nodes[node].parent) line.push_back(node);
  return line;
}

/// The lowest node above, or the same as, both; -1 without one.
Index common_ancestor(std::span<const Node> nodes, Index a, Index b) {
  if (a < 0 || b < 0) return -1;
  const std::vector<Index> line = line_of(nodes, a);
  for (const Index node : line_of(nodes, b))
    if (std::ranges::find(line, node) != line.end()) return node;
  return -1;
}

bool is_above(std::span<const Node> nodes, Index above, Index node) {
  const std::vector<Index> line = line_of(nodes, node);
  return above >= 0 && above != node && std::ranges::find(line, above) != line.end();
}

/// The tree says which nodes are trunk: hips are where legs and spine part, or above, the chest is where the arms part,
/// and the spine is halfway, the lower one of two.
void settle_trunk(std::span<const Node> nodes, std::vector<Index>& joints) {
  const auto at = [&](Joint joint) -> Index& { return joints[place_of(joint)]; };
  Index arms = common_ancestor(nodes, at(Joint::left_upper_arm), at(Joint::right_upper_arm));
  const Index legs = common_ancestor(nodes, at(Joint::left_upper_leg), at(Joint::right_upper_leg));
  const Index parting = common_ancestor(nodes, legs, arms);
  if (parting >= 0 && parting != arms && at(Joint::hips) != parting && !is_above(nodes, at(Joint::hips), parting))
    at(Joint::hips) = parting;
  if (at(Joint::hips) < 0) at(Joint::hips) = legs;
  // Arms of Biped hang from its neck.
  if (arms >= 0 && arms == at(Joint::neck)) arms = nodes[arms].parent;
  if (!is_above(nodes, at(Joint::hips), arms)) return;
  at(Joint::chest) = arms;
  std::vector<Index> between;  // from the chest down, without what turns in the hips
  for (Index n = nodes[arms].parent; n != at(Joint::hips); n = nodes[n].parent)
    if (!nodes[n].local.translation().isZero() || nodes[n].parent != at(Joint::hips)) between.push_back(n);
  at(Joint::spine) = between.empty() ? -1 : between[between.size() / 2];
}

/// Whether names say all that a body needs to be moved.
bool is_whole(const std::vector<Index>& joints) {
  return std::ranges::all_of(
      std::array{Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_upper_leg, Joint::left_lower_leg},
      [&](Joint left) { return joints[place_of(left)] >= 0 && joints[place_of(on_side(left, true))] >= 0; });
}

/// What names of this many nodes begin with may be the name of a rig: of a body and nothing else.
constexpr std::size_t kRig = 15;

/// Shorter beginnings without a mark are chance, or the sides of a body.
constexpr std::size_t kLeastName = 3;

/// Beginnings of names up to a mark, which so many nodes share, the longest first.
std::vector<std::string> shared_beginnings(std::span<const Node> nodes) {
  std::map<std::string, std::size_t> counts;
  for (const Node& node : nodes)
    for (std::size_t i = 1; i < node.name.size(); ++i)
      if (std::isalnum(static_cast<unsigned char>(node.name[i - 1])) == 0) ++counts[node.name.substr(0, i)];
  std::vector<std::string> beginnings;
  for (const auto& [text, count] : counts)
    if (count >= kRig) beginnings.push_back(text);
  std::ranges::stable_sort(beginnings, std::greater(), &std::string::size);
  return beginnings;
}

/// Beginnings without a mark ("EthanHips", "EthanLeftArm"), which so many nodes share and no longer one does, the
/// longest first.
std::vector<std::string> unmarked_beginnings(const std::vector<std::string>& names) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& name : names)
    for (std::size_t i = 1; i < name.size(); ++i) ++counts[name.substr(0, i)];
  std::vector<std::string> beginnings;
  for (const auto& [text, count] : counts) {
    if (text.size() < kLeastName || count < kRig) continue;
    // The next texts in order that begin with it are one letter longer, or more.
    bool ends_here = true;
    for (auto next = counts.upper_bound(text); next != counts.end() && next->first.starts_with(text); ++next)
      ends_here = ends_here && next->second < count;
    if (ends_here) beginnings.push_back(text);
  }
  std::ranges::stable_sort(beginnings, std::greater(), &std::string::size);
  return beginnings;
}

/// What stands around the parts of the body in the names of a rig: its name at the beginning, at the end, or both.
struct Affixes {
  std::string beginning, end;

  /// What is between both; empty where a name has not both.
  std::string strip(const std::string& name) const {
    if (name.size() <= beginning.size() + end.size() || !name.starts_with(beginning) || !name.ends_with(end)) return {};
    return name.substr(beginning.size(), name.size() - beginning.size() - end.size());
  }
};

/// Beginnings up to a mark come first, then those without one, then ends.
std::vector<Affixes> shared_affixes(std::span<const Node> nodes) {
  std::vector<std::string> names, reversed;
  for (const Node& node : nodes) {
    names.push_back(node.name);
    reversed.emplace_back(node.name.rbegin(), node.name.rend());
  }
  std::vector<std::string> beginnings = shared_beginnings(nodes);
  for (std::string& text : unmarked_beginnings(names))
    if (std::ranges::find(beginnings, text) == beginnings.end()) beginnings.push_back(std::move(text));
  std::vector<Affixes> affixes;
  for (const std::string& beginning : beginnings) affixes.push_back({beginning, {}});
  beginnings.insert(beginnings.begin(), std::string());
  for (const std::string& end : unmarked_beginnings(reversed))
    for (const std::string& beginning : beginnings)
      affixes.push_back({beginning, std::string(end.rbegin(), end.rend())});
  return affixes;
}

}  // namespace

std::string_view name(Joint joint) {
  constexpr std::array<std::string_view, kJointCount> names{
      "Hips",          "Spine",         "Chest",         "Neck",          "Head",         "LeftShoulder",
      "LeftUpperArm",  "LeftLowerArm",  "LeftHand",      "LeftUpperLeg",  "LeftLowerLeg", "LeftFoot",
      "LeftToes",      "RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand",    "RightUpperLeg",
      "RightLowerLeg", "RightFoot",     "RightToes"};
  return names[place_of(joint)];
}

Joint parent(Joint joint) {
  switch (joint) {
    case Joint::hips:
    case Joint::spine:
    case Joint::left_upper_leg:
    case Joint::right_upper_leg:
      return Joint::hips;
    case Joint::chest:
      return Joint::spine;
    case Joint::neck:
    case Joint::left_shoulder:
    case Joint::right_shoulder:
      return Joint::chest;
    case Joint::head:
      return Joint::neck;
    default:
      return static_cast<Joint>(place_of(joint) - 1);
  }
}

const std::vector<std::string>& joint_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < kJointCount; ++j) names.emplace_back(name(static_cast<Joint>(j)));
    return names;
  }();
  return kNames;
}

Index joint_number(const std::string& name) {
  const auto& names = joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<Index>(found - names.begin());
}

std::vector<Index> find_named_joints(std::span<const Node> nodes) {
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
    // What some call the shoulder is the upper arm where there is no other, what some call the foot the toes where
    // there is an ankle, and a leg without a knee below it is the lower one.
    if (joints[shoulder + 4] == joints[shoulder + 5]) joints[shoulder + 4] = -1;
    if (joints[shoulder] == joints[shoulder + 1]) joints[shoulder] = -1;
    if (joints.back() == joints[joints.size() - 2]) joints.back() = -1;
  }
  if (joints[place_of(Joint::spine)] == joints[place_of(Joint::chest)]) joints[place_of(Joint::chest)] = -1;
  settle_trunk(nodes, joints);
  return joints;
}

namespace {

/// Nodes without the number that Sketchfab puts behind the name of each bone ("CC_Base_L_Calf_05", "l knee_048"): where
/// as many as a rig has end so, hardly two of them alike, while spines and fingers count from one.
std::vector<Node> without_numbers(std::vector<Node> nodes) {
  const auto number_of = [](const std::string& name) {
    const std::size_t mark = name.rfind('_');
    const bool ends_so = mark != std::string::npos && mark > 0 && mark + 1 < name.size() &&
                         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(mark) + 1, name.end(),
                                     [](unsigned char c) { return std::isdigit(c) != 0; });
    return ends_so ? name.substr(mark) : std::string();
  };
  std::set<std::string> numbers;
  std::size_t count = 0;
  for (const Node& node : nodes)
    if (std::string number = number_of(node.name); !number.empty()) {
      ++count;
      numbers.insert(std::move(number));
    }
  if (numbers.size() < kRig || 10 * numbers.size() < 9 * count) return nodes;
  for (Node& node : nodes) node.name.resize(node.name.size() - number_of(node.name).size());
  return nodes;
}

/// Joints by name; where these do not say all, by what is left without the name of a rig ("UnityChan_LeftArm",
/// "rig_DEF-thigh_L", "EthanLeftArm", "LeftArm_jnt"), of several rigs that of which most joints hold skin or move.
std::vector<Index> find_prefixed_joints(const Character& character) {
  std::vector<Index> best = find_named_joints(character.nodes);
  if (is_whole(best)) return best;
  const std::vector<Node> plain = without_numbers(character.nodes);
  if (std::vector<Index> joints = find_named_joints(plain); is_whole(joints)) return joints;
  std::vector<bool> acts(character.nodes.size(), false);
  for (const Bone& bone : character.bones) acts[bone.node] = true;
  for (const Clip& clip : character.clips)
    for (const Channel& channel : clip.channels) acts[channel.node] = true;
  std::size_t most = 0;
  for (const Affixes& affixes : shared_affixes(plain)) {
    std::vector<Node> nodes = plain;
    for (Node& node : nodes) node.name = affixes.strip(node.name);
    std::vector<Index> joints = find_named_joints(nodes);
    const auto count =
        static_cast<std::size_t>(std::ranges::count_if(joints, [&](Index node) { return node >= 0 && acts[node]; }));
    if (!is_whole(joints) || count <= most) continue;
    most = count;
    best = std::move(joints);
  }
  return best;
}

}  // namespace

std::vector<Index> find_joints(const Character& character) {
  std::vector<Index> joints = find_prefixed_joints(character);
  if (is_whole(joints)) return joints;
  const std::vector<Index> nameless = find_nameless_joints(character);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints[j] < 0 && std::ranges::find(joints, nameless[j]) == joints.end()) joints[j] = nameless[j];
  settle_trunk(character.nodes, joints);
  return joints;
}

}  // namespace weft::character
