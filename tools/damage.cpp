#include "tools/damage.h"

#include <algorithm>
#include <iterator>

#include "bitstream/chunk.h"
#include "tools/command.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

void add_gap(uint32_t first, uint32_t end, std::vector<StreamInfo::Gap>& gaps) {
  if (first < end) gaps.push_back({first, end - first});
}

Status decode_one_frame(Decoder& decoder, uint32_t frame, std::vector<float>& positions) {
  const Connectivity* connectivity = nullptr;
  Status status = decoder.connectivity(frame, connectivity);
  if (!status.ok()) return status;
  positions.resize(size_t{3} * connectivity->vertex_count);
  return decoder.decode_frame(frame, positions.data());
}

}  // namespace

void add_keep_going_option(CLI::App& command, bool& keep_going) {
  command.add_flag("--keep-going", keep_going,
                   "A damaged or truncated .reeb file is no failure: take what is there, exit "
                   "code 0");
}

std::string describe_missing(const std::string& name, const std::vector<StreamInfo::Gap>& missing,
                             uint32_t total_frames) {
  std::string list;
  uint64_t count = 0;
  for (size_t i = 0; i < missing.size(); ++i) {
    const uint64_t first = uint64_t{missing[i].first_frame} + 1;
    const uint64_t last = uint64_t{missing[i].first_frame} + missing[i].frame_count;
    if (i > 0) list += i + 1 == missing.size() ? " and " : ", ";
    list += grouped(first) + (first == last ? "" : " to " + grouped(last));
    count += missing[i].frame_count;
  }
  if (missing.empty()) return {};
  if (count == total_frames) return name + ": no frame can be decoded, all are damaged or cut off";
  return name + ": " + (count == 1 ? "frame " : "frames ") + list + " of " + grouped(total_frames) +
         (count == 1 ? " is" : " are") + " damaged or cut off";
}

std::string describe(const DamagedRange& range) {
  return "bytes " + grouped(range.offset + 1) + " to " + grouped(range.offset + range.size) +
         (range.type.empty() ? "" : " (" + range.type + ")") + " are damaged";
}

std::string describe_damage(const std::string& name, const StreamInfo& info,
                            const std::vector<StreamInfo::Gap>& missing) {
  std::string out = describe_missing(name, missing, info.total_frames);
  const auto add = [&](const std::string& what) {
    out += (out.empty() ? name + ": " : ", ") + what;
  };
  for (const DamagedRange& range : info.damaged) {
    const bool told = range.type.empty() ? !info.missing.empty()
                                         : range.type == to_string(kGroupChunk) ||
                                               range.type == to_string(kReferenceChunk);
    if (!told) add(describe(range));
  }
  if (info.truncated && info.missing.empty()) add("truncated, the end of the file is missing");
  return out;
}

std::string describe_damage(const std::string& name, const ReadReport& report) {
  return report.stream ? describe_damage(name, *report.stream, report.missing) : std::string();
}

int finish_damaged(Console& console, const std::string& what, bool keep_going) {
  if (what.empty()) return kExitDone;
  console.error(what + "; the rest is good" +
                (keep_going ? "" : " (--keep-going if that is enough)"));
  return keep_going ? kExitDone : kExitFailed;
}

Status find_missing(Decoder& decoder, const std::function<void(double)>& progress,
                    std::vector<StreamInfo::Gap>& missing) {
  const StreamInfo& info = decoder.info();
  missing.clear();
  std::vector<float> positions;
  uint32_t next = 0;
  for (const StreamInfo::Group& group : info.groups) {
    Status status = decode_one_frame(decoder, group.first_frame, positions);
    if (!status.ok() && status.code() != StatusCode::kCorrupt) return status;
    if (!status.ok()) continue;
    add_gap(next, group.first_frame, missing);
    next = group.first_frame + group.frame_count;
    if (progress) progress(static_cast<double>(next) / info.total_frames);
  }
  add_gap(next, info.total_frames, missing);
  return {};
}

std::vector<uint32_t> present_frames(const std::vector<StreamInfo::Gap>& missing,
                                     uint32_t total_frames) {
  std::vector<uint32_t> out;
  uint32_t next = 0;
  for (const StreamInfo::Gap& gap : missing) {
    for (; next < gap.first_frame; ++next) out.push_back(next + 1);
    next = gap.first_frame + gap.frame_count;
  }
  for (; next < total_frames; ++next) out.push_back(next + 1);
  return out;
}

}  // namespace reeb::tools
