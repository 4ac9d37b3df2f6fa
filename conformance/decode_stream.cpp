// decode_stream STREAM OUT [THREADS [FLOATS]]: decodes every frame, in order, and writes what
// conformance/README.md describes. The smallest program around the decoder library, for conformance
// runs. FLOATS is a state of floating point that a host may have: up, down, zero (rounding) or
// flush (subnormals become 0).
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "bitstream/bytes.h"
#include "codec/dec/decoder.h"
#include "conformance/host_floats.h"

namespace {

int exit_code(reeb::StatusCode code) {
  switch (code) {
    case reeb::StatusCode::kOk:
      return 0;
    case reeb::StatusCode::kCorrupt:
      return 3;
    case reeb::StatusCode::kTruncated:
      return 4;
    case reeb::StatusCode::kUnsupported:
      return 5;
    case reeb::StatusCode::kLimitExceeded:
      return 6;
    default:
      return 1;
  }
}

std::vector<uint8_t> frame_bytes(uint32_t frame, const reeb::Connectivity& mesh,
                                 std::span<const float> xyz) {
  std::vector<uint8_t> out;
  reeb::append_u32(out, frame);
  reeb::append_u32(out, mesh.vertex_count);
  reeb::append_u32(out, static_cast<uint32_t>(mesh.face_sizes.size()));
  reeb::append_u32(out, static_cast<uint32_t>(mesh.corners.size()));
  for (const uint32_t size : mesh.face_sizes) reeb::append_u32(out, size);
  for (const uint32_t corner : mesh.corners) reeb::append_u32(out, corner);
  for (const float x : xyz) reeb::append_f32(out, x);
  return out;
}

reeb::Status write_frame(reeb::Decoder& decoder, uint32_t frame, std::ofstream& out) {
  const reeb::Connectivity* mesh = nullptr;
  if (reeb::Status s = decoder.connectivity(frame, mesh); !s.ok()) return s;
  std::vector<float> xyz(size_t{mesh->vertex_count} * 3);
  if (reeb::Status s = decoder.decode_frame(frame, xyz.data()); !s.ok()) return s;
  const std::vector<uint8_t> bytes = frame_bytes(frame, *mesh, xyz);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  return out ? reeb::Status() : reeb::Status::io("the output cannot be written");
}

/// Attributes of a frame: static ones once a shot. Those that do not decode are left out; the
/// result is that of the first of them.
class AttributeWriter {
 public:
  reeb::Status write(reeb::Decoder& decoder, uint32_t frame, std::ofstream& out) {
    std::vector<reeb::Attribute> attributes;
    std::vector<uint32_t> indices;
    if (reeb::Status s = decoder.attributes(frame, attributes, indices); !s.ok()) return s;
    reeb::Status result;
    for (size_t i = 0; i < attributes.size(); ++i) {
      const std::pair key(shot_of(decoder.info(), frame), indices[i]);
      if (!attributes[i].animated && !written_.insert(key).second) continue;
      reeb::Attribute decoded;
      const reeb::Status s = decoder.decode_attribute(frame, indices[i], decoded);
      if (result.ok()) result = s;
      if (s.ok()) write_record(frame, indices[i], decoded.values, out);
    }
    return result;
  }

 private:
  static uint32_t shot_of(const reeb::StreamInfo& info, uint32_t frame) {
    for (const auto& g : info.groups) {
      if (frame - g.first_frame < g.frame_count) return g.shot;
    }
    return 0;
  }
  static void write_record(uint32_t frame, uint32_t index, const std::vector<uint8_t>& values,
                           std::ofstream& out) {
    std::vector<uint8_t> bytes;
    for (const uint32_t x : {UINT32_MAX, frame, index, static_cast<uint32_t>(values.size())})
      reeb::append_u32(bytes, x);
    bytes.insert(bytes.end(), values.begin(), values.end());
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  }

  std::set<std::pair<uint32_t, uint32_t>> written_;  ///< shot and index
};

/// Frames that do not decode are left out; the result is that of the file or of the first of them.
reeb::Status write_frames(reeb::Decoder& decoder, std::ofstream& out) {
  reeb::Status result;
  if (decoder.info().truncated) result = reeb::Status::truncated("the file ends early");
  AttributeWriter attributes;
  for (uint32_t t = 0; t < decoder.info().total_frames; ++t) {
    reeb::Status s = write_frame(decoder, t, out);
    if (s.code() == reeb::StatusCode::kIo) return s;
    if (s.ok()) s = attributes.write(decoder, t, out);
    if (result.ok()) result = s;
  }
  return result;
}

reeb::Status run(const char* stream, const char* output, unsigned threads) {
  std::ifstream in(stream, std::ios::binary);
  if (!in) return reeb::Status::io("the stream cannot be read");
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  std::ofstream out(output, std::ios::binary);
  std::unique_ptr<reeb::Decoder> decoder;
  const std::span data(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  reeb::DecodeOptions options;
  options.threads = threads;
  if (reeb::Status s = reeb::Decoder::open(data, options, decoder); !s.ok()) return s;
  return write_frames(*decoder, out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5 || (argc == 5 && !reeb::test::set_host_floats(argv[4]))) {
    std::fputs("usage: decode_stream STREAM OUT [THREADS [up|down|zero|flush]]\n", stderr);
    return 2;
  }
  const unsigned threads = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 1;
  const reeb::Status status = run(argv[1], argv[2], threads);
  if (!status.ok())
    std::fprintf(stderr, "decode_stream: %s: %s\n", argv[1], status.message().c_str());
  return exit_code(status.code());
}
