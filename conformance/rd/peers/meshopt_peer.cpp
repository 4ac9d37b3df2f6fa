// meshoptimizer's vertex codec on quantized positions, differences to the frame before, then zstd.
// SETTING: bits per coordinate, 4 .. 16, over the cube around the whole sequence.
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "conformance/rd/peers/connectivity_zstd.h"

namespace reeb::conformance {
namespace {

using Lattice = std::array<uint16_t, 4>;  ///< the codec wants strides of four bytes

struct Header {
  uint32_t vertices, frames;
  float low[3];
  float step;
};

class MeshoptPeer : public Peer {
 public:
  Status encode(const Shot& shot, double setting, PeerStream& out) override {
    const Box box = box_of(shot.positions);
    const double top = std::exp2(std::clamp(setting, 4.0, 16.0)) - 1;
    Header header{shot.connectivity.vertex_count, shot.frame_count, {}, 0};
    std::copy(box.low, box.low + 3, header.low);
    header.step = box.side > 0 ? static_cast<float>(box.side / top) : 1;
    std::vector<uint8_t> frames;
    std::vector<Lattice> before(header.vertices, Lattice{});
    std::vector<Lattice> change(header.vertices);
    std::vector<uint8_t> coded(meshopt_encodeVertexBufferBound(header.vertices, sizeof(Lattice)));
    for (uint32_t t = 0; t < header.frames; ++t) {
      const std::span<const float> xyz = shot.frame(t);
      for (uint32_t v = 0; v < header.vertices; ++v) {
        for (size_t axis = 0; axis < 3; ++axis) {
          const double steps = (double{xyz[v * 3 + axis]} - header.low[axis]) / header.step;
          const auto now = static_cast<uint16_t>(std::clamp(std::round(steps), 0.0, top));
          change[v][axis] = static_cast<uint16_t>(now - before[v][axis]);
          before[v][axis] = now;
        }
      }
      const size_t size = meshopt_encodeVertexBuffer(coded.data(), coded.size(), change.data(),
                                                     header.vertices, sizeof(Lattice));
      put_block(frames, {coded.data(), size});
    }
    put(out.bytes, header);
    put_block(out.bytes, encode_triangles(shot.connectivity));
    put_block(out.bytes, compress_zstd(frames));
    return {};
  }

  Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) override {
    const auto header = take<Header>(bytes);
    take_block(bytes);
    const std::vector<uint8_t> frames = decompress_zstd(take_block(bytes));
    std::span<const uint8_t> rest = frames;
    std::vector<Lattice> now(header.vertices, Lattice{});
    std::vector<Lattice> change(header.vertices);
    positions.reserve(size_t{header.frames} * header.vertices * 3);
    for (uint32_t t = 0; t < header.frames; ++t) {
      const std::span<const uint8_t> block = take_block(rest);
      if (meshopt_decodeVertexBuffer(change.data(), header.vertices, sizeof(Lattice), block.data(),
                                     block.size()) != 0)
        return Status::corrupt("meshoptimizer refuses a frame");
      for (uint32_t v = 0; v < header.vertices; ++v) {
        for (size_t axis = 0; axis < 3; ++axis) {
          now[v][axis] = static_cast<uint16_t>(now[v][axis] + change[v][axis]);
          positions.push_back(static_cast<float>(header.low[axis] + header.step * now[v][axis]));
        }
      }
    }
    return {};
  }
};

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  reeb::conformance::MeshoptPeer peer;
  return run_peer(argc, argv, peer);
}
