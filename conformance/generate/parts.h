// Values, meshes and groups that many of the built streams are made of.
#pragma once

#include <cstdint>

#include "conformance/generate/shot_builder.h"
#include "tests/codec/shapes.h"

namespace reeb::conformance {

/// Small residuals that differ from row to row.
int64_t ripple(uint32_t k, uint32_t row);
int64_t none(uint32_t k, uint32_t row);
/// All lengths of an escape, either sign, now and then.
int64_t leap(uint32_t k, uint32_t row);
/// Single steps here and there, long runs, large numbers, and values in their place.
Correction scattered(uint32_t row, uint32_t t, uint32_t axis);

BuiltMesh mesh_of(const test::Shape& shape, uint32_t bits = 10);
BuiltMesh plain_mesh_of(const test::Shape& shape, uint32_t bits = 10);
/// Faces of 1, 2 and 300 corners, repeated ones, and over and over the same vertex.
Connectivity odd_faces();

BuiltGroup plain_group(uint32_t frames, uint32_t components);
BuiltGroup thesis_group(uint32_t frames);
Bytes build_fast(BuiltGroup g, const BuiltMesh& mesh);

}  // namespace reeb::conformance
