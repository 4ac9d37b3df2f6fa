// fpzip. SETTING: bits of precision kept, 2 .. 32; 0 = all of them. Keeps the smaller of two
// layouts.
#include <fpzip.h>

#include "conformance/rd/peers/connectivity_zstd.h"
#include "conformance/rd/peers/float_array.h"

namespace reeb::conformance {
namespace {

void set_shape(FPZ& fpz, const ArrayHeader& header, int precision) {
  const bool planes = header.layout == Layout::kPlanes;
  const int vertices = static_cast<int>(header.vertices);
  const int frames = static_cast<int>(header.frames);
  fpz.type = FPZIP_TYPE_FLOAT;
  fpz.prec = precision;
  fpz.nx = planes ? vertices : 3;
  fpz.ny = planes ? frames : vertices;
  fpz.nz = planes ? 1 : frames;
  fpz.nf = planes ? 3 : 1;
}

std::vector<uint8_t> compress(const std::vector<float>& values, const ArrayHeader& header,
                              int precision) {
  std::vector<uint8_t> out(values.size() * sizeof(float) * 2 + 1024);
  FPZ* fpz = fpzip_write_to_buffer(out.data(), out.size());
  set_shape(*fpz, header, precision);
  out.resize(fpzip_write(fpz, values.data()));
  fpzip_write_close(fpz);
  return out;
}

class FpzipPeer : public Peer {
 public:
  Status encode(const Shot& shot, double setting, PeerStream& out) override {
    ArrayHeader header{shot.connectivity.vertex_count, shot.frame_count, Layout::kPlanes};
    std::vector<uint8_t> best;
    for (const Layout layout : {Layout::kPlanes, Layout::kAsItLies}) {
      const ArrayHeader trial{header.vertices, header.frames, layout};
      std::vector<uint8_t> coded =
          compress(laid_out(shot, layout), trial, static_cast<int>(setting));
      if (coded.empty()) return Status::io("fpzip fails");
      if (!best.empty() && coded.size() >= best.size()) continue;
      best = std::move(coded);
      header = trial;
    }
    put(out.bytes, header);
    put(out.bytes, static_cast<int>(setting));
    put_block(out.bytes, encode_triangles(shot.connectivity));
    out.bytes.insert(out.bytes.end(), best.begin(), best.end());
    return {};
  }

  Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) override {
    const auto header = take<ArrayHeader>(bytes);
    const int precision = take<int>(bytes);
    take_block(bytes);
    std::vector<float> values(size_t{header.vertices} * header.frames * 3);
    FPZ* fpz = fpzip_read_from_buffer(bytes.data());
    set_shape(*fpz, header, precision);
    const size_t size = fpzip_read(fpz, values.data());
    fpzip_read_close(fpz);
    if (size == 0) return Status::corrupt("fpzip refuses the array");
    positions = interleaved(std::move(values), header.layout);
    return {};
  }
};

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  reeb::conformance::FpzipPeer peer;
  return run_peer(argc, argv, peer);
}
