// Calls assimp and works around defects of its version 5.2.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

struct aiAnimMesh;
struct aiNode;
struct aiScene;
namespace Assimp {
class Importer;
}

namespace weft::assets {

/// End of a message about a part of a file that has non-finite numbers.
inline constexpr const char* kNotFinite = "has infinite or undefined numbers; export the file again";

/// Imports a file; `importer` owns the result. `steps`: flags of assimp for post-processing. Throws std::runtime_error
/// with the message of assimp. Call this function only through run_isolated(), because damaged files can crash assimp
/// or block it for ever.
const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps);

/// Decodes escapes such as %20 (RFC 3986), which glTF and Collada use in names of files.
std::string percent_decode(const std::string& name);

/// The names by which a scene can choose mesh number `k` of a node, which must exist: that of the node and that of the
/// mesh. assimp divides a mesh of glTF by its primitives, and calls the parts of "Body" "Body-0", "Body-1", ...: the
/// name without the number chooses all of them.
std::set<std::string> names_of_mesh(const aiScene& scene, const aiNode& node, unsigned k);

/// The unit that an FBX file states [m]; nullopt if the number is not finite or not positive. Also nullopt for other
/// formats: assimp converts them to metres if it finds their unit.
std::optional<double> metres_per_unit(const aiScene& scene);

/// The weight of a morph target without a clip: that in the file. A weight of 1 in FBX counts as 0, because assimp 5.2
/// sets all weights of FBX files to 1.
double rest_weight(const aiScene& scene, const aiAnimMesh& target);

/// The up axis (0 x, 1 y, 2 z): for FBX, as the file states; for glTF, y; for Collada, also y, because assimp rotates
/// the content; nullopt for other formats.
std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene);

}  // namespace weft::assets
