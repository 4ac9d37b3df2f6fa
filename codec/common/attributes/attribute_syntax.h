// Syntax of the section of chunk `attr`: seams, integers, and binary32 values that no integer
// stands for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "bitstream/attribute_headers.h"
#include "codec/common/attributes/category_syntax.h"
#include "codec/common/attributes/numbers.h"
#include "codec/common/attributes/site_mesh.h"
#include "codec/common/attributes/value_syntax.h"

namespace reeb {

/// Where the values of an attribute are.
struct Sites {
  SiteMesh mesh;
  std::vector<uint32_t> of_element;  ///< site of each corner; empty where elements are sites

  uint32_t site(size_t element) const {
    return of_element.empty() ? static_cast<uint32_t>(element) : of_element[element];
  }
};

/// True where values are names, not numbers to predict: then elements are sites, without a mesh.
inline bool is_category(const AttributeHeader& h, const AttributeBody& body) {
  constexpr uint64_t kMaxTop = uint64_t{1} << 30;
  const bool of_faces = h.domain == Domain::kFace &&
                        (h.semantic == Semantic::kMaterial || h.semantic == Semantic::kGroup);
  const bool of_corners = h.domain == Domain::kCorner && h.semantic == Semantic::kIndex;
  return (of_faces || of_corners) && !h.animated() && h.channel_count == 1 &&
         h.type != ValueType::kBinary32 && body.channels[0].top <= kMaxTop;
}

/// `seam(a, b)` tells an encoder whether the values of two corners differ.
template <class Coder, class Seam>
Sites code_sites(Coder& coder, Domain domain, const ShotSurface& surface, Seam seam) {
  if (domain == Domain::kVertex) return {vertex_sites(surface), {}};
  if (domain == Domain::kFace) return {face_sites(surface), {}};
  if (domain == Domain::kShot) return {shot_site(), {}};
  const FaceCorners corners(surface.connectivity);
  Wedges wedges = SeamSyntax(corners).code(coder, seam);
  SiteMesh mesh = wedge_sites(surface, wedges);
  return {std::move(mesh), std::move(wedges.of_corner)};
}

/// Codes the integers, [site][channel]: complete with encoders, filled in with decoders. `plane`:
/// what an encoder wants where they are predicted.
template <class Coder>
Status code_integers(Coder& coder, const AttributeHeader& h, const AttributeBody& body,
                     const ShotSurface& surface, const SiteMesh& sites,
                     std::vector<uint32_t>& integers,
                     const std::optional<MirrorPlane>& plane = std::nullopt) {
  std::vector<uint32_t> tops;
  for (const ChannelHeader& c : body.channels) tops.push_back(static_cast<uint32_t>(c.top));
  if (!is_category(h, body))
    return code_values(coder, sites, tops, h.semantic == Semantic::kTextureCoordinate, plane,
                       integers);
  const FaceCorners corners(surface.connectivity);
  return CategorySyntax(corners, h.domain == Domain::kCorner, tops[0]).code(coder, integers);
}

/// A binary32 in place of what the integer stands for.
struct NumberException {
  uint64_t index;  ///< of the integer
  uint32_t bits;
};

/// Codes exceptions among `count` integers: complete with encoders, filled in with decoders.
template <class Coder>
Status code_exceptions(Coder& coder, uint64_t count, std::vector<NumberException>& exceptions) {
  const auto damaged = [] { return Status::corrupt("the exceptions of an attribute are damaged"); };
  ExpGolombModel number_model, gap_model;
  const uint32_t number = number_model.code(coder, static_cast<uint32_t>(exceptions.size()));
  if (number > count) return damaged();
  uint64_t next = 0;
  for (uint32_t i = 0; i < number; ++i) {
    NumberException& e = slot(exceptions, i);
    e.index = next + gap_model.code(coder, static_cast<uint32_t>(e.index - next));
    uint32_t bits = 0;
    for (uint32_t b = 32; b-- > 0;)
      bits = bits << 1 | (coder.code((e.bits >> b & 1) != 0, kEvenOdds) ? 1u : 0u);
    e.bits = bits;
    if (e.index >= count || ran_dry(coder)) return damaged();
    next = e.index + 1;
  }
  return {};
}

}  // namespace reeb
