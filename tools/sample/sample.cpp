#include "tools/sample/sample.h"

#include <algorithm>
#include <charconv>

#include "tools/sample/figures.h"

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

// "human-3" as kind and individual; false for any other name.
bool parse_figure(const std::string& name, std::string& kind, uint32_t& individual) {
  const size_t dash = name.find('-');
  if (dash == std::string::npos) return false;
  kind = name.substr(0, dash);
  const auto& kinds = figure_kinds();
  const char* end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + dash + 1, end, individual);
  return error == std::errc() && rest == end && individual >= 1 &&
         std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

Status unknown_sample(const std::string& name) {
  std::string known;
  for (const SampleInfo& info : samples())
    known += (known.empty() ? "" : ", ") + std::string(info.name);
  return Status::invalid("no sample '" + name + "'; there are " + known + ", and " +
                         figure_description());
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

std::string figure_description() {
  std::string kinds;
  for (const std::string& kind : figure_kinds()) kinds += (kinds.empty() ? "" : ", ") + kind;
  return "KIND-N: individual N (from 1) of a kind, each frame a mesh of its own in another pose; "
         "kinds: " +
         kinds;
}

Status make_sample(const std::string& name, uint32_t frame_count, Sequence& out, bool attributes) {
  std::string kind;
  uint32_t individual = 0;
  if (const Maker make = maker(name)) {
    out = make(frame_count);
  } else if (parse_figure(name, kind, individual)) {
    out = make_figure(kind, individual, frame_count);
  } else {
    return unknown_sample(name);
  }
  for (Shot& shot : out.shots) {
    if (!attributes) shot.attributes.clear();
  }
  out.frame_rate = kFrameRate;
  out.metadata["title"] = "reeb sample " + name;
  return {};
}

}  // namespace reeb::tools
