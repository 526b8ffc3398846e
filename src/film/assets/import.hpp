// Calls assimp and works around defects of its version 5.2.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

struct aiAnimMesh;
struct aiScene;
namespace Assimp {
class Importer;
}

namespace weft::assets {

/// End of the message about a part of a file that has such numbers.
inline constexpr const char* kNotFinite = "has infinite or undefined numbers; export the file again";

/// Imports a file with the post-processing flags `steps` of assimp; `importer` owns the result. Throws
/// std::runtime_error with assimp's message. Damaged files can crash assimp or block it for ever: call it through
/// run_isolated.
const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps);

/// The name with %20 as a space and so on (RFC 3986), as glTF and Collada encode the names of files.
std::string percent_decoded(const std::string& name);

/// The unit that an FBX file states [m]. For other formats, assimp itself converts to metres if it knows the unit.
std::optional<double> metres_per_unit(const aiScene& scene);

/// The weight of a morph target without a clip: as the file states it; 0 in FBX, where assimp 5.2 puts all targets
/// to 1.
double rest_weight(const aiScene& scene, const aiAnimMesh& target);

/// The up axis (0 x, 1 y, 2 z): as an FBX file states it; y for glTF and for Collada, which assimp rotates; nullopt for
/// other formats.
std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene);

}  // namespace weft::assets
