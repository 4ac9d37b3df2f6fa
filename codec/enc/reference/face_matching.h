// Which face is which, of two meshes with the same faces.
#pragma once

#include "codec/common/base/sequence.h"
#include "codec/common/reference/face_order.h"

namespace reeb {

/// Where every face of `faces` stands in `input`, and which of its corners is the first there. Both
/// have the same faces up to their order and first corners; equal ones are matched in order.
FaceOrder match_faces(const Connectivity& faces, const Connectivity& input);

}  // namespace reeb
