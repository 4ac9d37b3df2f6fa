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
#include <span>
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

/// Frames that do not decode are left out; the result is that of the file or of the first of them.
reeb::Status write_frames(reeb::Decoder& decoder, std::ofstream& out) {
  reeb::Status result;
  if (decoder.info().truncated) result = reeb::Status::truncated("the file ends early");
  for (uint32_t t = 0; t < decoder.info().total_frames; ++t) {
    const reeb::Status s = write_frame(decoder, t, out);
    if (s.code() == reeb::StatusCode::kIo) return s;
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
