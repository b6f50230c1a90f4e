#pragma once
/// Shared by the files of face_geometry. Internal to eval.

#include "pos/eval/face_geometry.hpp"

namespace pos::eval {

/// Profile and bend of one cut of `face`, which has its first and past set.
void addProfile(const FaceGeometry& face, Cut& cut);

}  // namespace pos::eval
