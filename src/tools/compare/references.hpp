// Folders of reference pictures. Pictures depend slightly on the version of Mesa and on the vector
// width of the processor. These two define the machine class. A machine class needs references of
// its own if its pictures differ from the default references by more than the limits. For machines
// of the class mesa-22.3-256bit, the first of these files that exists is the reference:
//
//     references/mesa-22.3-256bit/name.png   only for this machine class
//     references/default/name.png
//     references/name.png
//
// Names may contain folders: references/default/front/name.png is the reference of front/name.png.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weft::compare {

/// Machine class, such as "mesa-22.3-256bit", from `gl`, the OpenGL description in the metadata of Weft's pictures:
/// version of Mesa and, if given, vector width of llvmpipe. Empty if `gl` names no version of Mesa.
std::string machine_class(const std::string& gl);

/// Class of the machine that drew a picture or video. Empty if the metadata of the file name no
/// version of Mesa, or if the file cannot be read.
std::string machine_class_of(const std::filesystem::path& file);
/// Class of the machine that drew the files `names` of a folder: that of the first file that has one. Empty if none
/// has.
std::string machine_class_of(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// The reference of this name for the machine class `machine`; none if no file has this name, or only heat maps have it
/// (is_heat_map()).
std::optional<std::filesystem::path> find_reference(const std::filesystem::path& folder, const std::string& name,
                                                    const std::string& machine);

/// Sorted names of all references that are used for the machine class `machine`.
std::vector<std::string> reference_names(const std::filesystem::path& folder, const std::string& machine);

/// Sorted names of all pictures and videos below a folder, such as "front/name.png". Skips hidden
/// files and folders, and heat maps (is_heat_map()). Follows links to folders. Throws Error(asset_unreadable) if a
/// folder cannot be listed or links form a cycle.
std::vector<std::string> comparable_names(const std::filesystem::path& folder);

}  // namespace weft::compare
