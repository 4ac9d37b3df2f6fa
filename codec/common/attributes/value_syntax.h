// Syntax of the integers of a static attribute: site after site along the walk of its mesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/attributes/difference_model.h"
#include "codec/common/attributes/value_predictor.h"
#include "codec/common/reference/mesh_state.h"

namespace reeb {

/// Channels with a larger top are coded as differences.
inline constexpr uint32_t kMaxMixed = (1u << 20) - 1;

/// Codes `values`, [site][channel], each 0 .. top of its channel: complete with encoders, filled in
/// with decoders. `plane`: what an encoder wants.
template <class Coder>
Status code_values(Coder& coder, const SiteMesh& sites, const std::vector<uint32_t>& tops,
                   bool texture, std::optional<MirrorPlane> plane, std::vector<uint32_t>& values) {
  code_plane(coder, plane);
  const MeshWalk walk = walk_mesh(sites.count, sites.triangles);
  ValuePredictor predictor(sites, walk, tops, texture, plane);
  GuessMixture guesses(ValuePredictor::kKindCount, ValuePredictor::kMemory);
  std::vector<DifferenceModel> differences(tops.size());
  values.resize(sites.count * tops.size());
  for (uint32_t turn = 0; turn < sites.count; ++turn) {
    predictor.start(turn, values);
    for (size_t k = 0; k < tops.size(); ++k) {
      uint32_t& value = values[walk.order[turn] * tops.size() + k];
      const uint32_t likely = predictor.likely(k);
      if (tops[k] <= kMaxMixed) {
        predictor.guess(k, guesses);
        value = guesses.code(coder, value, tops[k] + 1, likely, predictor.reach(k));
      } else {
        const auto expected = static_cast<uint64_t>(predictor.scale(k));
        const int64_t coded =
            likely + differences[k].code(coder, expected, int64_t{value} - likely);
        if (coded < 0 || coded > tops[k])
          return Status::corrupt("an attribute's value is out of range");
        value = static_cast<uint32_t>(coded);
      }
      predictor.learn(k, value);
    }
    if (ran_dry(coder)) return Status::corrupt("the values of an attribute are cut off");
  }
  return {};
}

}  // namespace reeb
