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

/// End of a message about a part of a file that has non-finite numbers.
inline constexpr const char* kNotFinite = "has infinite or undefined numbers; export the file again";

/// Imports a file; `importer` owns the result. `steps`: flags of assimp for post-processing. Throws std::runtime_error
/// with the message of assimp. Damaged files can crash assimp or block it for ever: call this only through
/// run_isolated().
const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps);

/// The name with decoded escapes such as %20 (RFC 3986), which glTF and Collada use in names of files.
std::string percent_decoded(const std::string& name);

/// The unit that an FBX file states [m]; nullopt if the number is not finite or not positive. Also
/// nullopt for other formats, which assimp converts to metres if it finds the unit.
std::optional<double> metres_per_unit(const aiScene& scene);

/// The weight of a morph target without a clip: that of the file. A weight of 1 in FBX counts as 0,
/// since assimp 5.2 sets all weights of FBX files to 1.
double rest_weight(const aiScene& scene, const aiAnimMesh& target);

/// The up axis (0 x, 1 y, 2 z): as stated in FBX; y for glTF and Collada, which assimp rotates; nullopt for other
/// formats.
std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene);

}  // namespace weft::assets
