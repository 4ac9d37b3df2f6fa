#include "conformance/rd/peers/peer.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "codec/common/mesh/faces.h"
#include "tools/io/read_sequence.h"

namespace reeb::conformance {
namespace {

template <class T>
Status write_all(const std::string& name, const std::vector<T>& values) {
  std::ofstream out(name, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  return out ? Status() : Status::io(name + ": cannot be written");
}

Status encode(Peer& peer, double setting, const std::string& stream,
              const std::vector<std::string>& inputs) {
  Sequence sequence;
  tools::ReadReport report;
  if (Status s = tools::read_sequence(inputs, {.threads = 1}, sequence, report); !s.ok()) return s;
  if (sequence.shots.size() != 1) return Status::invalid("the connectivity changes");
  PeerStream out;
  if (Status s = peer.encode(sequence.shots[0], setting, out); !s.ok()) return s;
  Status status = write_all(stream, out.bytes);
  if (status.ok() && !out.order.empty()) status = write_all(stream + ".order", out.order);
  return status;
}

Status decode(Peer& peer, const std::string& stream, const std::string& decoded) {
  std::ifstream in(stream, std::ios::binary);
  if (!in) return Status::io(stream + ": cannot be read");
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  std::vector<float> positions;
  Status status =
      peer.decode({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, positions);
  return status.ok() ? write_all(decoded, positions) : status;
}

}  // namespace

int run_peer(int argc, char** argv, Peer& peer) {
  const std::string verb = argc > 1 ? argv[1] : "";
  Status status;
  if (verb == "encode" && argc >= 5) {
    status = encode(peer, std::atof(argv[2]), argv[3], {argv + 4, argv + argc});
  } else if (verb == "decode" && argc == 4) {
    status = decode(peer, argv[2], argv[3]);
  } else {
    std::fprintf(stderr, "usage: %s encode SETTING STREAM INPUT...\n       %s decode STREAM OUT\n",
                 argv[0], argv[0]);
    return 2;
  }
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", argv[0], status.message().c_str());
  return status.ok() ? 0 : 1;
}

void put_block(std::vector<uint8_t>& bytes, std::span<const uint8_t> block) {
  put(bytes, static_cast<uint32_t>(block.size()));
  bytes.insert(bytes.end(), block.begin(), block.end());
}

std::span<const uint8_t> take_block(std::span<const uint8_t>& bytes) {
  const size_t size = std::min<size_t>(take<uint32_t>(bytes), bytes.size());
  const std::span<const uint8_t> block = bytes.first(size);
  bytes = bytes.subspan(size);
  return block;
}

std::vector<uint32_t> triangles_of(const Connectivity& mesh) {
  std::vector<uint32_t> out;
  const std::vector<uint32_t> fans = fan_triangles(mesh);
  for (size_t t = 0; t < fans.size(); t += 3) {
    const uint32_t a = fans[t], b = fans[t + 1], c = fans[t + 2];
    if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
  }
  return out;
}

CompactMesh::CompactMesh(const Connectivity& mesh) : triangles(triangles_of(mesh)) {
  std::vector<uint32_t> number(mesh.vertex_count, 0);
  for (const uint32_t v : triangles) number[v] = 1;
  for (uint32_t v = 0; v < number.size(); ++v) {
    std::vector<uint32_t>& kind = number[v] != 0 ? used : isolated;
    number[v] = static_cast<uint32_t>(kind.size());
    kind.push_back(v);
  }
  for (uint32_t& v : triangles) v = number[v];
}

Box box_of(std::span<const float> positions) {
  Box box;
  for (size_t axis = 0; axis < 3; ++axis) {
    float low = positions[axis], high = low;
    for (size_t i = axis; i < positions.size(); i += 3) {
      low = std::min(low, positions[i]);
      high = std::max(high, positions[i]);
    }
    box.low[axis] = low;
    box.side = std::max(box.side, high - low);
  }
  return box;
}

}  // namespace reeb::conformance
