// zfp in fixed-accuracy mode. SETTING: largest error per coordinate, as a part of the longest side
// of the box around the sequence; 0 = reversible. Keeps the smaller of two layouts.
#include <zfp.h>

#include <memory>

#include "conformance/rd/peers/connectivity_zstd.h"
#include "conformance/rd/peers/float_array.h"

namespace reeb::conformance {
namespace {

struct FieldCloser {
  void operator()(zfp_field* field) const { zfp_field_free(field); }
};
struct StreamCloser {
  void operator()(zfp_stream* stream) const { zfp_stream_close(stream); }
};

/// The arrays of a layout, one after another, each coded by itself.
class Arrays {
 public:
  Arrays(std::vector<float>& values, const ArrayHeader& header, double accuracy)
      : values_(values), header_(header), accuracy_(accuracy) {}

  std::vector<uint8_t> compress() {
    std::vector<uint8_t> out;
    for (size_t i = 0; i < count(); ++i) {
      const auto field = field_of(i);
      const auto zfp = stream();
      std::vector<uint8_t> buffer(zfp_stream_maximum_size(zfp.get(), field.get()));
      bitstream* bits = stream_open(buffer.data(), buffer.size());
      zfp_stream_set_bit_stream(zfp.get(), bits);
      zfp_stream_rewind(zfp.get());
      put_block(out, {buffer.data(), zfp_compress(zfp.get(), field.get())});
      stream_close(bits);
    }
    return out;
  }

  bool decompress(std::span<const uint8_t> bytes) {
    for (size_t i = 0; i < count(); ++i) {
      const auto field = field_of(i);
      const auto zfp = stream();
      const std::span<const uint8_t> block = take_block(bytes);
      std::vector<uint8_t> buffer(block.begin(), block.end());
      bitstream* bits = stream_open(buffer.data(), buffer.size());
      zfp_stream_set_bit_stream(zfp.get(), bits);
      zfp_stream_rewind(zfp.get());
      const size_t size = zfp_decompress(zfp.get(), field.get());
      stream_close(bits);
      if (size == 0) return false;
    }
    return true;
  }

 private:
  size_t count() const { return header_.layout == Layout::kPlanes ? 3 : 1; }

  std::unique_ptr<zfp_field, FieldCloser> field_of(size_t i) {
    float* data = values_.data() + values_.size() / count() * i;
    return std::unique_ptr<zfp_field, FieldCloser>(
        header_.layout == Layout::kPlanes
            ? zfp_field_2d(data, zfp_type_float, header_.vertices, header_.frames)
            : zfp_field_3d(data, zfp_type_float, 3, header_.vertices, header_.frames));
  }

  std::unique_ptr<zfp_stream, StreamCloser> stream() const {
    std::unique_ptr<zfp_stream, StreamCloser> zfp(zfp_stream_open(nullptr));
    if (accuracy_ > 0) {
      zfp_stream_set_accuracy(zfp.get(), accuracy_);
    } else {
      zfp_stream_set_reversible(zfp.get());
    }
    return zfp;
  }

  std::vector<float>& values_;
  ArrayHeader header_;
  double accuracy_;
};

class ZfpPeer : public Peer {
 public:
  Status encode(const Shot& shot, double setting, PeerStream& out) override {
    const double accuracy = setting * static_cast<double>(box_of(shot.positions).side);
    ArrayHeader header{shot.connectivity.vertex_count, shot.frame_count, Layout::kPlanes};
    std::vector<uint8_t> best;
    for (const Layout layout : {Layout::kPlanes, Layout::kAsItLies}) {
      std::vector<float> values = laid_out(shot, layout);
      const ArrayHeader trial{header.vertices, header.frames, layout};
      std::vector<uint8_t> coded = Arrays(values, trial, accuracy).compress();
      if (!best.empty() && coded.size() >= best.size()) continue;
      best = std::move(coded);
      header = trial;
    }
    put(out.bytes, header);
    put(out.bytes, accuracy);
    put_block(out.bytes, encode_triangles(shot.connectivity));
    out.bytes.insert(out.bytes.end(), best.begin(), best.end());
    return {};
  }

  Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) override {
    const auto header = take<ArrayHeader>(bytes);
    const auto accuracy = take<double>(bytes);
    take_block(bytes);
    std::vector<float> values(size_t{header.vertices} * header.frames * 3);
    if (!Arrays(values, header, accuracy).decompress(bytes))
      return Status::corrupt("zfp refuses an array");
    positions = interleaved(std::move(values), header.layout);
    return {};
  }
};

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  reeb::conformance::ZfpPeer peer;
  return run_peer(argc, argv, peer);
}
