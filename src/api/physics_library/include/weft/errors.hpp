// Exceptions of the library. Each what() says where, what was expected with its unit, what was found, and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>
#include <weft/api.hpp>

namespace weft {

struct Mistake {
  std::string file;          ///< path of the scene, as the caller gave it; absolute in exceptions of
                             ///< Simulation; may be empty
  int line = 0, column = 0;  ///< counted from 1; 0: the mistake is not in the text of the file. For
                             ///< a missing key: those of the table around it, or 1 and 1.
  std::string change;        ///< the change "key=value" that caused the mistake, as it was given; empty
                             ///< if the file did. what() shows only the beginning of a long one.
  std::string key;           ///< such as "cloth.band.material.thickness"; empty for the file as a whole
  std::string text;          ///< such as "expected > 0 m, got -0.001"
};

/// A scene has mistakes, or surfaces of a scene or model touch at the start. what() lists the
/// mistakes, one per line: "file:line:column: key: text" or, for a mistake in a change, "--set
/// change: key: text". Of more than 200 mistakes, only the first 200 are listed.
class WEFT_API SceneError : public std::runtime_error {
 public:
  SceneError(const std::string& text, std::vector<Mistake> mistakes)
      : std::runtime_error(text), mistakes_(std::move(mistakes)) {}
  /// The mistakes that what() lists: first those in the file, in its order, then those in the
  /// changes.
  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

/// A mesh, motion or picture file that the scene names cannot be used. what() names the file.
class WEFT_API FileError : public SceneError {
 public:
  using SceneError::SceneError;
};

/// The simulation cannot continue. what() names the frame and the reason.
class WEFT_API SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace weft
