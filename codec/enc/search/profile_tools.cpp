#include "codec/enc/search/profile_tools.h"

#include <utility>

#include "codec/enc/fields/fast_group_encoder.h"
#include "codec/enc/fields/main_group_encoder.h"
#include "codec/enc/fields/thesis_group_encoder.h"

namespace reeb {

namespace {

template <class Encoder>
std::unique_ptr<GroupEncoder> make(GroupSignal signal, unsigned threads) {
  return std::make_unique<Encoder>(std::move(signal), threads);
}

constexpr ProfileTools kMainTools = {.make_encoder = make<MainGroupEncoder>,
                                     .learns = true,
                                     .open_groups = true,
                                     .goes_lossless = true,
                                     .regions = RegionUse::kThorough};
constexpr ProfileTools kFastTools = {.make_encoder = make<FastGroupEncoder>,
                                     .plain_mesh = true,
                                     .learns = true,
                                     .regions = RegionUse::kPieces};
constexpr ProfileTools kThesisTools = {.make_encoder = make<ThesisGroupEncoder>,
                                       .regions = RegionUse::kReebGraph};

}  // namespace

const ProfileTools& tools_of(Profile profile) {
  switch (profile) {
    case Profile::kFast:
      return kFastTools;
    case Profile::kThesis:
      return kThesisTools;
    case Profile::kMain:
    case Profile::kLossless:  // has no components, so no search: see lossless_sequence.h
      break;
  }
  return kMainTools;
}

}  // namespace reeb
