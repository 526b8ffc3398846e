// A minimal character file, and a motion for it.
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

/// A motion that moves a skeleton like that of the rod, five times as large, by 3 m along z in one second, and bends it
/// at its joint "Back" by 90 degrees, as BVH.
inline std::string walk_file() {
  return "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
         "Xrotation\nJOINT Back\n{\nOFFSET 0 5 0\nCHANNELS 3 Zrotation Yrotation Xrotation\nEnd Site\n{\nOFFSET 0 5 "
         "0\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 1\n0 0 0 0 0 0 0 0 0\n0 0 3 0 0 0 90 0 0\n";
}

}  // namespace weft::support
