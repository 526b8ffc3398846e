#include "film/character/joints.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <string_view>

#include "film/character/structural_joints.hpp"

namespace weft::character {
namespace {

/// The names of a joint in rigs. If a rig has several of these names, the first one counts.
using Aliases = std::vector<std::string>;

// The names of the joints of the trunk and of a side, in the order of Joint. They are those of Mixamo, Rokoko and
// MotionBuilder; Rigify; Character Creator; Unreal; Unity, VRM and Bandai; SMPL; CMU as BVH and as Acclaim; 100STYLE
// and Xsens; Biped, Truebones and Source; Poser and DAZ; MakeHuman; Quaternius; the built-in mannequin.
const std::vector<Aliases> kMiddle = {
    {"hips", "pelvis", "hip"},
    {"spine", "abdomen", "lowerback", "spine01", "spine001", "waist", "ab", "abdomenlower", "spine1", "torso"},
    {"upperchest", "chest", "spine03", "spine003", "spine3", "spine2", "spine02", "spine1", "thorax", "chestupper"},
    {"neck", "neck01", "neck1", "necktwist01", "lowerneck", "necklower", "spine004"},
    {"head", "spine006"},
};
const std::vector<Aliases> kSides = {
    {"clavicle", "collar", "shoulder", "thorax"},
    {"upperarm", "arm", "shldr", "shldrbend", "uparm", "upperarm01", "humerus", "shoulder"},
    {"lowerarm", "forearm", "forearmbend", "lowarm", "lowerarm01", "radius", "elbow"},
    {"wrist", "hand", "palm", "palm2", "fist"},
    {"upperleg", "upleg", "thigh", "thighbend", "upperleg01", "femur", "hip", "leg"},
    {"lowerleg", "lowleg", "calf", "shin", "lowerleg01", "tibia", "knee", "leg"},
    {"ankle", "foot"},
    {"toes", "toe", "toebase", "toe0", "ball", "forefoot", "foot"},
};

/// Whether a word in the name of a node means neither a side nor a joint. Such words occur in Biped, Rigify, Source,
/// VRM, Character Creator, Meebits, and in Mixamo rigs from which a program has removed the colon.
bool is_filler_word(const std::string& word) {
  static const std::vector<std::string> kWords = {"b", "bn",  "c",     "cc",    "base", "def",
                                                  "j", "bip", "biped", "valve", "m",    "bone"};
  return word.starts_with("bip0") || word.starts_with("mixamorig") || std::ranges::find(kWords, word) != kWords.end();
}

// Decodes characters that FBX does not allow in a name. Programs write such a character as "FBXASC" and its ASCII code,
// with three decimal digits: "Arm.L" becomes "ArmFBXASC046L".
std::string without_fbx_escapes(std::string name) {
  constexpr std::string_view kEscape = "FBXASC";
  constexpr std::size_t kDigits = 3;
  for (std::size_t at = name.find(kEscape); at != std::string::npos; at = name.find(kEscape, at + 1)) {
    int code = 0;
    const char* digits = name.data() + at + kEscape.size();
    if (at + kEscape.size() + kDigits > name.size()) break;
    const auto [end, error] = std::from_chars(digits, digits + kDigits, code);
    if (error == std::errc() && end == digits + kDigits && code >= 0 && code < 128)
      name.replace(at, kEscape.size() + kDigits, 1, static_cast<char>(code));
  }
  return name;
}

/// The words of a name in lower case: "Bip01 L UpperArm" and "upper_arm.L" contain "upper", "arm" and "l". Digits
/// belong to the preceding word. Ignores the name of a rig before a colon.
std::vector<std::string> words_of(const std::string& written) {
  const std::string name = without_fbx_escapes(written);
  std::vector<std::string> words;
  bool inside = false;
  const std::size_t start = name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1;
  for (std::size_t i = start; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isalnum(c) == 0) {
      inside = inside && i + 1 < name.size() && std::isdigit(static_cast<unsigned char>(name[i + 1])) != 0;
      continue;
    }
    // A capital letter begins a word if the character before it is no capital letter, or if the character after it is a
    // lower-case letter: "LeftArm", "LHipJoint".
    const bool after_small = i > start && std::isupper(static_cast<unsigned char>(name[i - 1])) == 0;
    const bool before_small = i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1])) != 0;
    if (!inside || (std::isupper(c) != 0 && (after_small || before_small))) words.emplace_back();
    inside = true;
    words.back() += static_cast<char>(std::tolower(c));
  }
  return words;
}

/// The side in a name ("", "Left" or "Right"), and its remaining words without filler words, joined. Keeps
/// the filler word "base" if it is not the first of the remaining words, as in "ToeBase".
std::pair<std::string, std::string> side_and_part(const std::string& name) {
  std::string side, part;
  for (const std::string& word : words_of(name)) {
    if (word == "l" || word == "left") {
      side = "Left";
    } else if (word == "r" || word == "right") {
      side = "Right";
    } else if (!is_filler_word(word) || (word == "base" && !part.empty())) {
      part += word;
    }
  }
  // "lfemur", "righthand": side and part without any separator.
  for (const auto& [letters, which] : {std::pair{"left", "Left"}, {"right", "Right"}, {"l", "Left"}, {"r", "Right"}})
    if (side.empty() && part.starts_with(letters)) {
      const std::string rest = part.substr(std::string(letters).size());
      for (const Aliases& known : kSides)
        if (std::ranges::find(known, rest) != known.end()) return {which, rest};
    }
  return {side, part};
}

/// A node and its ancestors, upward.
std::vector<Index> ancestors_of(std::span<const Node> nodes, Index node) {
  std::vector<Index> line;
  for (; node >= 0; node = nodes[node].parent) line.push_back(node);
  return line;
}

/// Lowest common ancestor of two nodes; a node counts as its own ancestor. -1 if there is none.
Index common_ancestor(std::span<const Node> nodes, Index a, Index b) {
  if (a < 0 || b < 0) return -1;
  const std::vector<Index> line = ancestors_of(nodes, a);
  for (const Index node : ancestors_of(nodes, b))
    if (std::ranges::find(line, node) != line.end()) return node;
  return -1;
}

bool is_above(std::span<const Node> nodes, Index above, Index node) {
  const std::vector<Index> line = ancestors_of(nodes, node);
  return above >= 0 && above != node && std::ranges::find(line, above) != line.end();
}

/// Determines the joints of the trunk from the tree. Hips: the node at which legs and spine branch, or an ancestor of
/// it that has a name of the hips. Chest: the node at which the arms branch. Spine: the node halfway between hips and
/// chest, or the lower one of two middle nodes; -1 if there is no node between them.
void determine_trunk(std::span<const Node> nodes, std::vector<Index>& joints) {
  const auto at = [&](Joint joint) -> Index& { return joints[joint_index(joint)]; };
  Index arms = common_ancestor(nodes, at(Joint::left_upper_arm), at(Joint::right_upper_arm));
  const Index legs = common_ancestor(nodes, at(Joint::left_upper_leg), at(Joint::right_upper_leg));
  const Index branching = common_ancestor(nodes, legs, arms);
  if (branching >= 0 && branching != arms && at(Joint::hips) != branching &&
      !is_above(nodes, at(Joint::hips), branching))
    at(Joint::hips) = branching;
  if (at(Joint::hips) < 0) at(Joint::hips) = legs;
  // In Biped, arms are children of the neck.
  if (arms >= 0 && arms == at(Joint::neck)) arms = nodes[arms].parent;
  if (!is_above(nodes, at(Joint::hips), arms)) return;
  at(Joint::chest) = arms;
  std::vector<Index> between;  // from the chest down, without a node at the same position as the hips
  for (Index n = nodes[arms].parent; n != at(Joint::hips); n = nodes[n].parent)
    if (!nodes[n].local.translation().isZero() || nodes[n].parent != at(Joint::hips)) between.push_back(n);
  at(Joint::spine) = between.empty() ? -1 : between[between.size() / 2];
}

/// Whether all upper and lower arms and legs are found.
bool has_all_limbs(const std::vector<Index>& joints) {
  return std::ranges::all_of(
      std::array{Joint::left_upper_arm, Joint::left_lower_arm, Joint::left_upper_leg, Joint::left_lower_leg},
      [&](Joint left) { return joints[joint_index(left)] >= 0 && joints[joint_index(on_side(left, true))] >= 0; });
}

/// A prefix or suffix counts as the name of a rig if at least this number of nodes have it. This is the size of a
/// minimal skeleton.
constexpr std::size_t kMinRigNodes = 15;

/// Minimum length of a prefix or suffix without a separator. Names have shorter prefixes and suffixes in common by
/// chance, or as names of the sides of a body.
constexpr std::size_t kMinPrefixLength = 3;

/// Prefixes that end with a separator and that at least kMinRigNodes nodes have in common, longest first.
std::vector<std::string> prefixes_with_separator(std::span<const Node> nodes) {
  std::map<std::string, std::size_t> counts;
  for (const Node& node : nodes)
    for (std::size_t i = 1; i < node.name.size(); ++i)
      if (std::isalnum(static_cast<unsigned char>(node.name[i - 1])) == 0) ++counts[node.name.substr(0, i)];
  std::vector<std::string> prefixes;
  for (const auto& [text, count] : counts)
    if (count >= kMinRigNodes) prefixes.push_back(text);
  std::ranges::stable_sort(prefixes, std::greater(), &std::string::size);
  return prefixes;
}

/// Prefixes without a separator ("Ethan" in "EthanHips", "EthanLeftArm") that at least kMinRigNodes names have in
/// common, longest first. Omits a prefix if a longer prefix begins with it and the same number of names have both.
std::vector<std::string> prefixes_without_separator(const std::vector<std::string>& names) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& name : names)
    for (std::size_t i = 1; i < name.size(); ++i) ++counts[name.substr(0, i)];
  std::vector<std::string> prefixes;
  for (const auto& [text, count] : counts) {
    if (text.size() < kMinPrefixLength || count < kMinRigNodes) continue;
    // The map is sorted. Entries that begin with this text therefore follow it directly.
    bool is_maximal = true;
    for (auto next = counts.upper_bound(text); next != counts.end() && next->first.starts_with(text); ++next)
      is_maximal = is_maximal && next->second < count;
    if (is_maximal) prefixes.push_back(text);
  }
  std::ranges::stable_sort(prefixes, std::greater(), &std::string::size);
  return prefixes;
}

/// Prefix and suffix that a rig adds to the names of body parts.
struct Affixes {
  std::string prefix, end;

  /// The name without prefix and suffix; empty if the name lacks one of them.
  std::string strip(const std::string& name) const {
    if (name.size() <= prefix.size() + end.size() || !name.starts_with(prefix) || !name.ends_with(end)) return {};
    return name.substr(prefix.size(), name.size() - prefix.size() - end.size());
  }
};

/// Candidates for the affixes of a rig, in this order: prefixes with a separator; prefixes without one; each suffix,
/// alone and with each prefix.
std::vector<Affixes> shared_affixes(std::span<const Node> nodes) {
  std::vector<std::string> names, reversed;
  for (const Node& node : nodes) {
    names.push_back(node.name);
    reversed.emplace_back(node.name.rbegin(), node.name.rend());
  }
  std::vector<std::string> prefixes = prefixes_with_separator(nodes);
  for (std::string& text : prefixes_without_separator(names))
    if (std::ranges::find(prefixes, text) == prefixes.end()) prefixes.push_back(std::move(text));
  std::vector<Affixes> affixes;
  for (const std::string& prefix : prefixes) affixes.push_back({prefix, {}});
  prefixes.insert(prefixes.begin(), std::string());
  for (const std::string& end : prefixes_without_separator(reversed))
    for (const std::string& prefix : prefixes) affixes.push_back({prefix, std::string(end.rbegin(), end.rend())});
  return affixes;
}

}  // namespace

std::string_view name(Joint joint) {
  constexpr std::array<std::string_view, kJointCount> names{
      "Hips",          "Spine",         "Chest",         "Neck",          "Head",         "LeftShoulder",
      "LeftUpperArm",  "LeftLowerArm",  "LeftHand",      "LeftUpperLeg",  "LeftLowerLeg", "LeftFoot",
      "LeftToes",      "RightShoulder", "RightUpperArm", "RightLowerArm", "RightHand",    "RightUpperLeg",
      "RightLowerLeg", "RightFoot",     "RightToes"};
  return names[joint_index(joint)];
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
      return static_cast<Joint>(joint_index(joint) - 1);
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

std::string normalise_word(const std::string& name) {
  std::string word;
  for (const char c : name)
    if (c != '_') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

Index joint_number(const std::string& name) {
  const auto found = std::ranges::find(joint_names(), normalise_word(name), normalise_word);
  return found == joint_names().end() ? -1 : static_cast<Index>(found - joint_names().begin());
}

std::vector<Index> find_named_joints(std::span<const Node> nodes, const std::vector<bool>& is_active) {
  std::map<std::pair<std::string, std::string>, Index> known;
  for (const bool active : {true, false})
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (active == (is_active.empty() || is_active[n]))
        known.emplace(side_and_part(nodes[n].name), static_cast<Index>(n));
  std::vector<Index> joints;
  const auto find = [&](const std::string& side, const Aliases& aliases) {
    for (const std::string& alias : aliases)
      if (const auto found = known.find({side, alias}); found != known.end()) return found->second;
    return Index{-1};
  };
  for (const Aliases& aliases : kMiddle) joints.push_back(find("", aliases));
  for (const char* side : {"Left", "Right"}) {
    const std::size_t shoulder = joints.size();
    for (const Aliases& aliases : kSides) joints.push_back(find(side, aliases));
    // Resolves ambiguous names. A "shoulder" is the upper arm if no other node is the upper arm. A "foot" is the toes
    // if there is an ankle. A "leg" is the lower leg if no other node is the lower leg.
    if (joints[shoulder + 4] == joints[shoulder + 5]) joints[shoulder + 4] = -1;
    if (joints[shoulder] == joints[shoulder + 1]) joints[shoulder] = -1;
    if (joints.back() == joints[joints.size() - 2]) joints.back() = -1;
  }
  if (joints[joint_index(Joint::spine)] == joints[joint_index(Joint::chest)]) joints[joint_index(Joint::chest)] = -1;
  determine_trunk(nodes, joints);
  return joints;
}

namespace {

/// Removes the number that Sketchfab appends to the name of each bone ("CC_Base_L_Calf_05", "l knee_048"). Does so only
/// if the names end with at least kMinRigNodes different numbers, and if at most 10 % of the numbers are repetitions:
/// numbers that rigs themselves give to spines and fingers are repeated more often.
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
  if (numbers.size() < kMinRigNodes || 10 * numbers.size() < 9 * count) return nodes;
  for (Node& node : nodes) node.name.resize(node.name.size() - number_of(node.name).size());
  return nodes;
}

/// Finds joints by name. If not all arms and legs are found, tries again without the affixes of a rig, as in
/// "UnityChan_LeftArm", "rig_DEF-thigh_L", "EthanLeftArm", "LeftArm_jnt". If this succeeds for several affixes, as in
/// a file with several rigs, selects the rig with most joints that influence skin or move.
std::vector<Index> find_prefixed_joints(const Character& character) {
  std::vector<bool> is_active(character.nodes.size(), false);
  for (const Bone& bone : character.bones) is_active[bone.node] = true;
  for (const Clip& clip : character.clips)
    for (const Channel& channel : clip.channels) is_active[channel.node] = true;
  std::vector<Index> best = find_named_joints(character.nodes, is_active);
  if (has_all_limbs(best)) return best;
  const std::vector<Node> plain = without_numbers(character.nodes);
  if (std::vector<Index> joints = find_named_joints(plain, is_active); has_all_limbs(joints)) return joints;
  std::size_t best_count = 0;
  for (const Affixes& affixes : shared_affixes(plain)) {
    std::vector<Node> nodes = plain;
    for (Node& node : nodes) node.name = affixes.strip(node.name);
    std::vector<Index> joints = find_named_joints(nodes, is_active);
    const auto count = static_cast<std::size_t>(
        std::ranges::count_if(joints, [&](Index node) { return node >= 0 && is_active[node]; }));
    if (!has_all_limbs(joints) || count <= best_count) continue;
    best_count = count;
    best = std::move(joints);
  }
  return best;
}

}  // namespace

std::vector<Index> find_joints(const Character& character) {
  std::vector<Index> joints = find_prefixed_joints(character);
  if (has_all_limbs(joints)) return joints;
  const std::vector<Index> by_structure = find_joints_by_structure(character);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (joints[j] < 0 && std::ranges::find(joints, by_structure[j]) == joints.end()) joints[j] = by_structure[j];
  determine_trunk(character.nodes, joints);
  return joints;
}

}  // namespace weft::character
