// measure_error DECODED INPUT...: how far raw decoded positions are from a sequence, as JSON.
//
// DECODED holds float32 xyz, little endian, frame after frame, as decode_positions and the peers
// write it. Where DECODED.order exists (uint32, little endian), it tells for every decoded vertex
// which one of the input it is; more than one may be the same.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "conformance/rd/sted.h"
#include "tools/io/read_sequence.h"
#include "tools/metrics.h"

namespace reeb::conformance {
namespace {

template <class T>
bool read_all(const std::string& name, std::vector<T>& out) {
  std::ifstream in(name, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  if (bytes.size() % sizeof(T) != 0) return false;
  out.resize(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return in.good() || in.eof();
}

/// Puts decoded vertices where the input has them; those that `order` does not name stay at 0.
Status restore_order(const std::vector<uint32_t>& order, const Shot& original,
                     std::vector<float>& decoded) {
  const uint32_t vertices = original.connectivity.vertex_count;
  if (order.empty() || decoded.size() != order.size() * original.frame_count * 3)
    return Status::invalid("the order does not fit the decoded positions");
  std::vector<float> restored(original.positions.size(), 0.0f);
  for (size_t i = 0; i < decoded.size(); ++i) {
    const size_t frame = i / (order.size() * 3);
    const uint32_t v = order[i / 3 % order.size()];
    if (v >= vertices) return Status::invalid("the order names a vertex that is not there");
    restored[(frame * vertices + v) * 3 + i % 3] = decoded[i];
  }
  decoded = std::move(restored);
  return {};
}

Status run(const std::string& name, const std::vector<std::string>& inputs) {
  Sequence original;
  tools::ReadReport report;
  if (Status s = tools::read_sequence(inputs, {.threads = 1}, original, report); !s.ok()) return s;
  if (original.shots.size() != 1)
    return Status::invalid("the connectivity changes; only sequences of one are measured");
  Sequence other = original;
  std::vector<float>& decoded = other.shots[0].positions;
  if (!read_all(name, decoded)) return Status::io(name + ": cannot be read");
  if (std::vector<uint32_t> order; std::filesystem::exists(name + ".order")) {
    if (!read_all(name + ".order", order)) return Status::io(name + ".order: cannot be read");
    if (Status s = restore_order(order, original.shots[0], decoded); !s.ok()) return s;
  }
  if (decoded.size() != original.shots[0].positions.size())
    return Status::invalid(name + ": does not have the vertices and frames of the input");
  tools::Comparison figures;
  if (Status s = tools::compare_sequences(original, other, figures); !s.ok()) return s;
  const Sted sted = spatio_temporal_edge_difference(original.shots[0], decoded, figures.diagonal);
  std::printf(
      "{\"vertices\": %u, \"faces\": %zu, \"frames\": %u, \"kg\": %.9g, \"rmse\": %.9g, "
      "\"max_error\": %.9g, \"diagonal\": %.9g, \"sted\": %.9g, \"identical\": %s}\n",
      original.shots[0].connectivity.vertex_count, original.shots[0].connectivity.face_sizes.size(),
      original.frame_count(), figures.overall.kg, figures.overall.rmse, figures.overall.max_error,
      figures.diagonal, sted.combined, figures.identical ? "true" : "false");
  return {};
}

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: measure_error DECODED INPUT...\n", stderr);
    return 2;
  }
  const reeb::Status status = reeb::conformance::run(argv[1], {argv + 2, argv + argc});
  if (!status.ok()) std::fprintf(stderr, "measure_error: %s\n", status.message().c_str());
  return status.ok() ? 0 : 1;
}
