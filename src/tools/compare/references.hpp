// Folders of reference pictures. Pictures depend slightly on Mesa and on the vector width of the processor. If such
// differences exceed the limits of the comparison, a class of machines has its own references (builds for different
// processors simulate slightly different motion too, but share a class):
//
//     references/mesa-22.3-256bit/name.png   used for this class of machines
//     references/default/name.png            used for names that the folder of the class does not have
//     references/name.png                    used for names that neither of these folders has
//
// Names may contain folders: references/default/front/name.png is the reference of front/name.png.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weft::compare {

/// The class of machines, such as "mesa-22.3-256bit", from an OpenGL description as in the metadata of Weft's pictures:
/// version of Mesa and, if given, vector width of llvmpipe. Empty without a version of Mesa.
std::string machine_class(const std::string& gl);

/// The class of the machine that drew a picture or video; empty for files of other programs and unreadable ones.
std::string machine_class_of(const std::filesystem::path& file);

/// The reference of this name: in the folder of the class, else in `default`, else in `folder` itself.
std::optional<std::filesystem::path> find_reference(const std::filesystem::path& folder, const std::string& name,
                                                    const std::string& machine);

/// Sorted names of all references that apply to this class.
std::vector<std::string> reference_names(const std::filesystem::path& folder, const std::string& machine);

/// Sorted names of all pictures and videos below a folder, such as "front/name.png", without hidden ones. Throws
/// Error(asset_unreadable).
std::vector<std::string> comparable_names(const std::filesystem::path& folder);

}  // namespace weft::compare
