// decode_positions STREAM OUT: writes the positions of all frames as raw float32 xyz, little
// endian, frame after frame, and nothing else: what the drivers of other codecs do, so that times
// compare.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "codec/dec/decoder.h"

namespace {

reeb::Status write_frames(reeb::Decoder& decoder, std::ofstream& out) {
  std::vector<float> xyz;  // of one frame
  for (uint32_t t = 0; t < decoder.info().frame_count; ++t) {
    const reeb::Connectivity* mesh = nullptr;
    if (reeb::Status s = decoder.connectivity(t, mesh); !s.ok()) return s;
    xyz.resize(size_t{mesh->vertex_count} * 3);
    if (reeb::Status s = decoder.decode_frame(t, xyz.data()); !s.ok()) return s;
    out.write(reinterpret_cast<const char*>(xyz.data()),
              static_cast<std::streamsize>(xyz.size() * sizeof(float)));
  }
  return out ? reeb::Status() : reeb::Status::io("the output cannot be written");
}

reeb::Status run(const char* stream, const char* output) {
  std::ifstream in(stream, std::ios::binary);
  if (!in) return reeb::Status::io("the stream cannot be read");
  const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
  std::unique_ptr<reeb::Decoder> decoder;
  const std::span data(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  if (reeb::Status s = reeb::Decoder::open(data, {}, decoder); !s.ok()) return s;
  std::ofstream out(output, std::ios::binary);
  return write_frames(*decoder, out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: decode_positions STREAM OUT\n", stderr);
    return 2;
  }
  const reeb::Status status = run(argv[1], argv[2]);
  if (!status.ok())
    std::fprintf(stderr, "decode_positions: %s: %s\n", argv[1], status.message().c_str());
  return status.ok() ? 0 : 1;
}
