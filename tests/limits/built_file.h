// Streams put together from meshes and sections, at sizes that the encoder would take long for.
#pragma once

#include "bitstream/container.h"
#include "codec/common/fast/surface.h"
#include "codec/common/fields/field.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

namespace reeb::test {

/// How many times longer than in a release build everything may take.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double kSlowness = 15;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr double kSlowness = 15;
#else
inline constexpr double kSlowness = 1;
#endif
#else
inline constexpr double kSlowness = 1;
#endif

struct CodedMesh {
  Bytes bytes;
  Surface surface;
};

CodedMesh code_mesh(const Shape& shape, bool plain, uint32_t bits);

/// One shot of one group, within the bound on its elements.
Bytes file_of(const CodedMesh& mesh, const GroupHeader& header, const GroupSections& sections);

/// The section of so many planes of zeros.
Bytes code_zeros(Field& field, uint32_t components);
/// The basis of a group of so many planes, all zero.
Bytes zero_basis(uint32_t frames, uint32_t components);
/// A group of zeros: planes that cost no bits.
Bytes zero_file(const CodedMesh& mesh, Profile profile, uint32_t frames, uint32_t components);
/// A group of the main profile whose every coordinate of every frame is corrected.
Bytes corrected_file(const CodedMesh& mesh, uint32_t frames);

/// A lossless group on that mesh; `frames`: [row][xyz].
Bytes lossless_file(const Shape& shape, const std::vector<std::vector<float>>& frames, bool quick);

}  // namespace reeb::test
