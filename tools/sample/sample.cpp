#include "tools/sample/sample.h"

namespace reeb::tools {
namespace {

constexpr double kFrameRate = 25;

using Maker = Sequence (*)(uint32_t);

Maker maker(const std::string& name) {
  if (name == "creature") return make_creature;
  if (name == "sheet") return make_sheet;
  if (name == "mechanism") return make_mechanism;
  return nullptr;
}

}  // namespace

const std::vector<SampleInfo>& samples() {
  static const std::vector<SampleInfo> list{
      {"creature", "a walking animal, one closed surface with limbs"},
      {"sheet", "a cloth in the wind, with boundary, of quadrilaterals"},
      {"mechanism", "gears, rod and piston, rigid components"},
  };
  return list;
}

Status make_sample(const std::string& name, uint32_t frame_count, Sequence& out) {
  for (const SampleInfo& info : samples()) {
    if (name != info.name) continue;
    out = maker(name)(frame_count);
    out.frame_rate = kFrameRate;
    out.metadata["title"] = "reeb sample " + name;
    return {};
  }
  std::string known;
  for (const SampleInfo& info : samples())
    known += (known.empty() ? "" : ", ") + std::string(info.name);
  return Status::invalid("no sample '" + name + "'; there are " + known);
}

}  // namespace reeb::tools
