// A minimal character file.
#pragma once

#include <string>

namespace weft::support {

/// A rod along y with a joint at its middle, as ASCII X, the shortest text format with skinning. (Numbers have decimals
/// because assimp reads "1,0" as 1.0.)
inline std::string rod_file() {
  return R"(xof 0303txt 0032
Frame Root { FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; }
 Frame Hips { FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; }
  Frame Spine { FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,1.0,0.0,1.0;; } } }
 Mesh Rod { 5; -0.1;0.0;0.0;, 0.1;0.0;0.0;, 0.0;1.0;0.0;, -0.1;2.0;0.0;, 0.1;2.0;0.0;;
  3; 3;0,1,2;, 3;2,4,3;, 3;0,2,3;;
  XSkinMeshHeader { 1; 1; 2; }
  SkinWeights { "Hips"; 2; 0,1; 1.0,1.0; 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; }
  SkinWeights { "Spine"; 3; 2,3,4; 1.0,1.0,1.0; 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,-1.0,0.0,1.0;; } } }
AnimTicksPerSecond { 10; }
AnimationSet Walk { Animation { { Hips } AnimationKey { 2; 3; 0;3;0.0,0.0,0.0;;, 10;3;0.0,0.0,2.0;;, 20;3;0.0,0.0,4.0;;; } } }
AnimationSet Wave { Animation { { Spine } AnimationKey { 2; 2; 0;3;0.0,1.0,0.0;;, 10;3;1.0,1.0,0.0;;; } } }
)";
}

}  // namespace weft::support
