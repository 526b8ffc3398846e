// A public model as bytes: to hash it for saved states, and to pickle it.
#pragma once

#include <string>
#include <string_view>
#include <weft/model.hpp>

namespace weft::library {

/// All members of a model. Equal models have equal bytes.
std::string bytes_of(Model model);

/// The model of these bytes. Throws std::runtime_error if the bytes are cut short.
Model model_of(std::string_view bytes);

}  // namespace weft::library
