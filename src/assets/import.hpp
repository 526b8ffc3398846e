// Assimp's way into a file, and around what goes wrong there in version 5.2.
#pragma once

#include <filesystem>
#include <optional>

struct aiScene;
namespace Assimp {
class Importer;
}

namespace weft::assets {

/// What the importer finds in a file, and holds. Throws std::runtime_error with assimp's words. Damaged files can crash
/// it or keep it busy for ever: to be called through run_isolated.
const aiScene& import(Assimp::Importer& importer, const std::filesystem::path& file, unsigned steps);

/// What FBX says that it measures in [m]; the readers of other formats turn them to metres where they know.
std::optional<double> metres_per_unit(const aiScene& scene);

/// Which axis points up (0 x, 1 y, 2 z) as the file says (FBX) or its format has it: glTF, and Collada after its reader
/// has turned it. None of formats that do not say.
std::optional<int> up_axis(const Assimp::Importer& importer, const aiScene& scene);

}  // namespace weft::assets
