#include "conformance/rd/peers/connectivity_zstd.h"

#include <meshoptimizer.h>
#include <zstd.h>

namespace reeb::conformance {

std::vector<uint8_t> compress_zstd(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> out(ZSTD_compressBound(bytes.size()));
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 19);
  out.resize(ZSTD_isError(size) != 0 ? 0 : size);
  return out;
}

std::vector<uint8_t> decompress_zstd(std::span<const uint8_t> bytes) {
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) return {};
  std::vector<uint8_t> out(size);
  if (ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size()) != size) out.clear();
  return out;
}

std::vector<uint8_t> encode_triangles(const Connectivity& mesh) {
  const std::vector<uint32_t> triangles = triangles_of(mesh);
  std::vector<uint8_t> coded(meshopt_encodeIndexBufferBound(triangles.size(), mesh.vertex_count));
  coded.resize(
      meshopt_encodeIndexBuffer(coded.data(), coded.size(), triangles.data(), triangles.size()));
  return compress_zstd(coded);
}

}  // namespace reeb::conformance
