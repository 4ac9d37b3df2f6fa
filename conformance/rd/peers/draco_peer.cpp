// Draco, one mesh a frame at its strongest settings; vertices that no triangle has, which its mesh
// coder drops, as a point cloud beside it. SETTING: bits per coordinate over the box of the frame.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <memory>

#include "codec/enc/reference/draco_connectivity_encoder.h"
#include "conformance/rd/peers/peer.h"

namespace reeb::conformance {
namespace {

using draco::GeometryAttribute;

draco::Encoder encoder_of(int bits) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(0, 0);
  encoder.SetAttributeQuantization(GeometryAttribute::POSITION, bits);
  return encoder;
}

std::span<const uint8_t> bytes_of(const draco::EncoderBuffer& buffer) {
  return {reinterpret_cast<const uint8_t*>(buffer.data()), buffer.size()};
}

int add_positions(draco::PointCloud& points, size_t count) {
  points.set_num_points(static_cast<uint32_t>(count));
  GeometryAttribute position;
  position.Init(GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  return points.AddAttribute(position, true, static_cast<uint32_t>(count));
}

/// Sets point i to vertex `vertex[i]` of a frame.
void set_positions(draco::PointCloud& points, std::span<const float> xyz,
                   const std::vector<uint32_t>& vertex) {
  for (uint32_t i = 0; i < vertex.size(); ++i) {
    points.attribute(0)->SetAttributeValue(draco::AttributeValueIndex(i), &xyz[3 * vertex[i]]);
  }
}

/// The mesh over the vertices that triangles use, and the vertices that none uses.
class Frames {
 public:
  explicit Frames(const Connectivity& connectivity) : compact_(connectivity) {
    add_positions(mesh_, compact_.used.size());
    add_positions(cloud_, compact_.isolated.size());
    mesh_.SetNumFaces(compact_.triangles.size() / 3);
    for (uint32_t t = 0; t < mesh_.num_faces(); ++t) {
      draco::Mesh::Face face;
      for (uint32_t i = 0; i < 3; ++i) face[i] = compact_.triangles[size_t{t} * 3 + i];
      mesh_.SetFace(draco::FaceIndex(t), face);
    }
  }

  bool encode(std::span<const float> xyz, int bits, std::vector<uint8_t>& out) {
    draco::EncoderBuffer buffer;
    set_positions(mesh_, xyz, compact_.used);
    if (!encoder_of(bits).EncodeMeshToBuffer(mesh_, &buffer).ok()) return false;
    put_block(out, bytes_of(buffer));
    if (compact_.isolated.empty()) return true;
    draco::Encoder encoder = encoder_of(bits);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);  // keeps the order
    buffer.Clear();
    set_positions(cloud_, xyz, compact_.isolated);
    if (!encoder.EncodePointCloudToBuffer(cloud_, &buffer).ok()) return false;
    put_block(out, bytes_of(buffer));
    return true;
  }

  /// Input vertex of every decoded point.
  bool find_order(std::vector<uint32_t>& order) const {
    DracoEncoding connectivity;
    if (!encode_draco_connectivity(compact_.triangles, mesh_.num_points(), connectivity))
      return false;
    for (const uint32_t v : connectivity.vertex_of) order.push_back(compact_.used[v]);
    order.insert(order.end(), compact_.isolated.begin(), compact_.isolated.end());
    return true;
  }

  bool has_isolated() const { return !compact_.isolated.empty(); }

 private:
  CompactMesh compact_;
  draco::Mesh mesh_;
  draco::PointCloud cloud_;
};

bool append_positions(const draco::PointCloud& points, std::vector<float>& out) {
  const auto* position = points.GetNamedAttribute(GeometryAttribute::POSITION);
  if (position == nullptr) return false;
  for (uint32_t p = 0; p < points.num_points(); ++p) {
    float xyz[3];
    position->GetMappedValue(draco::PointIndex(p), xyz);
    out.insert(out.end(), xyz, xyz + 3);
  }
  return true;
}

class DracoPeer : public Peer {
 public:
  Status encode(const Shot& shot, double setting, PeerStream& out) override {
    Frames frames(shot.connectivity);
    put(out.bytes, shot.frame_count);
    put(out.bytes, uint32_t{frames.has_isolated()});
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      if (!frames.encode(shot.frame(t), static_cast<int>(setting), out.bytes))
        return Status::io("Draco does not take a frame");
    }
    return frames.find_order(out.order) ? Status() : Status::io("Draco does not tell its order");
  }

  Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) override {
    const auto frame_count = take<uint32_t>(bytes);
    const bool has_isolated = take<uint32_t>(bytes) != 0;
    for (uint32_t t = 0; t < frame_count; ++t) {
      for (int part = 0; part < (has_isolated ? 2 : 1); ++part) {
        const std::span<const uint8_t> block = take_block(bytes);
        draco::DecoderBuffer in;
        in.Init(reinterpret_cast<const char*>(block.data()), block.size());
        auto points = part == 0 ? draco::Decoder().DecodeMeshFromBuffer(&in).value() : nullptr;
        auto cloud = part == 1 ? draco::Decoder().DecodePointCloudFromBuffer(&in).value() : nullptr;
        const draco::PointCloud* decoded = part == 0 ? points.get() : cloud.get();
        if (decoded == nullptr || !append_positions(*decoded, positions))
          return Status::corrupt("Draco refuses a frame");
      }
    }
    return {};
  }
};

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  reeb::conformance::DracoPeer peer;
  return run_peer(argc, argv, peer);
}
