#include "codec/enc/search/sequence_summary.h"

#include <array>
#include <cmath>
#include <span>

#include "bitstream/container.h"

namespace reeb {

namespace {

double energy_of(std::span<const float> frame) {
  const size_t vertices = frame.size() / 3;
  std::array<double, 3> mean{};
  for (size_t i = 0; i < frame.size(); ++i) mean[i % 3] += static_cast<double>(frame[i]);
  for (double& m : mean) m /= static_cast<double>(vertices);
  double energy = 0;
  for (size_t i = 0; i < frame.size(); ++i) {
    const double d = static_cast<double>(frame[i]) - mean[i % 3];
    energy += d * d;
  }
  return energy;
}

}  // namespace

SequenceHeader header_of(const Sequence& sequence) {
  SequenceHeader header;
  header.total_frames = sequence.frame_count();
  header.shot_count = static_cast<uint32_t>(sequence.shots.size());
  header.frame_rate = sequence.frame_rate;
  header.start_time = sequence.start_time;
  return header;
}

std::vector<MetadataEntry> metadata_of(const Sequence& sequence) {
  std::vector<MetadataEntry> out;
  for (const auto& [key, value] : sequence.metadata) out.push_back({key, value});
  return out;
}

double vertex_frames_of(const Sequence& sequence) {
  double sum = 0;
  for (const Shot& shot : sequence.shots)
    sum += static_cast<double>(shot.connectivity.vertex_count) * shot.frame_count;
  return sum;
}

double energy_of(const Sequence& sequence) {
  double sum = 0;
  for (const Shot& shot : sequence.shots) {
    for (uint32_t t = 0; t < shot.frame_count; ++t) sum += energy_of(shot.frame(t));
  }
  return sum;
}

double kg_error(double squared_error, double energy) {
  return energy > 0 ? 100 * std::sqrt(squared_error / energy) : 0;
}

EncodeStats size_stats(const std::vector<uint8_t>& bytes, double vertex_frames) {
  EncodeStats out;
  out.bytes = bytes.size();
  out.bpvf = 8 * static_cast<double>(out.bytes) / vertex_frames;
  ContainerReader container;
  if (container.parse(bytes, Limits{}).ok()) {
    for (const auto& [name, size] : container.sections)
      out.sections.push_back({name, 8.0 * static_cast<double>(size)});
  }
  return out;
}

}  // namespace reeb
