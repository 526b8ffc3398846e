// Folders of reference pictures. Pictures depend a little on Mesa and on the vectors of the processor, and motion on
// the processor for which the program is built; where that is more than the limits let through, a class of machines has
// references of its own:
//
//     references/mesa-22.3-256bit/name.png   the references of this class of machines
//     references/default/name.png            those of all others
//     references/name.png                    or, without any classes, simply this
//
// Below these a name may have folders of its own: references/default/front/name.png is that of front/name.png.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weft::compare {

/// The class of machines that an OpenGL description names, as in the metadata of our pictures: version of Mesa, and
/// bits of the vectors that llvmpipe uses. Empty if it names none.
std::string machine_class(const std::string& gl);

/// The class of the machine that drew a picture or video; empty for those of other programs and for unreadable ones.
std::string machine_class_of(const std::filesystem::path& file);

/// The reference for a file of this name in `folder`: that of the class, else of `default`, else in the folder itself.
std::optional<std::filesystem::path> find_reference(const std::filesystem::path& folder, const std::string& name,
                                                    const std::string& machine);

/// Names of all references that this class has, sorted.
std::vector<std::string> reference_names(const std::filesystem::path& folder, const std::string& machine);

/// Names of all pictures and videos below a folder, such as "front/name.png", sorted; not of hidden ones. Throws
/// Error(asset_unreadable).
std::vector<std::string> comparable_names(const std::filesystem::path& folder);

}  // namespace weft::compare
