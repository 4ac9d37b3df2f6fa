// What the drivers of other codecs have in common: a program around one codec.
//
//   NAME encode SETTING STREAM INPUT...   a sequence of one connectivity to one file
//   NAME decode STREAM DECODED            raw float32 xyz, frame after frame
//
// Where a codec changes the vertex order, encoding also writes STREAM.order (uint32 per decoded
// vertex: which one of the input it is), for measuring alone; it counts as no part of the stream.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"

namespace reeb::conformance {

struct PeerStream {
  std::vector<uint8_t> bytes;
  std::vector<uint32_t> order;  ///< empty where the order is kept
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual Status encode(const Shot& shot, double setting, PeerStream& out) = 0;
  virtual Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) = 0;
};

/// The `main` of a driver.
int run_peer(int argc, char** argv, Peer& peer);

/// Appends a value as it lies in memory; the drivers read their own streams only.
template <class T>
void put(std::vector<uint8_t>& bytes, const T& value) {
  const auto* raw = reinterpret_cast<const uint8_t*>(&value);
  bytes.insert(bytes.end(), raw, raw + sizeof(T));
}

/// Takes a value off the front; zero past the end.
template <class T>
T take(std::span<const uint8_t>& bytes) {
  T value{};
  if (bytes.size() < sizeof(T)) return value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return value;
}

/// A block of bytes with its length before it.
void put_block(std::vector<uint8_t>& bytes, std::span<const uint8_t> block);
std::span<const uint8_t> take_block(std::span<const uint8_t>& bytes);

/// Faces as fans of triangles; degenerate ones are left out.
std::vector<uint32_t> triangles_of(const Connectivity& mesh);

/// A mesh as coders of connectivity take it: the vertices of triangles numbered anew without gaps,
/// and those that no triangle has.
struct CompactMesh {
  std::vector<uint32_t> triangles;  ///< places in `used`
  std::vector<uint32_t> used;       ///< ascending vertices of the input
  std::vector<uint32_t> isolated;
  explicit CompactMesh(const Connectivity& mesh);
};

/// Low corner and longest side of the box around all positions.
struct Box {
  float low[3];
  float side = 0;
};
Box box_of(std::span<const float> positions);

}  // namespace reeb::conformance
