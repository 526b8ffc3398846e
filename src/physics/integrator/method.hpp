// The integration methods.
#pragma once

#include <string>
#include <vector>

namespace weft::integrator {

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

/// Names in scenes and reports, in the order of the enumeration.
inline const std::vector<std::string> kMethodNames = {"implicit_euler", "implicit_midpoint", "bdf2"};
inline const std::string& name_of(Method method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}

}  // namespace weft::integrator
