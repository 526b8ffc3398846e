// Text for HTML, XML and SVG.
#pragma once

#include <string>

namespace weft {

/// `text` as the content of an element, or of an attribute in double quotes. Control characters below U+0020 become
/// spaces; bytes that are not UTF-8, as in names of files, become U+FFFD.
std::string markup_text(const std::string& text);

}  // namespace weft
