// Lossless size and speed of Reeb and of general compressors on the same positions, in one run.
//
// lossless_benchmark SEQUENCE...: each as `reeb encode` takes one input (a mesh of which NAME.pc2
// stands beside it, a folder, a .reeb file). CSV on standard output: sequence, codec, bits per
// vertex and frame, million vertices per CPU second encoding and decoding. One core; every codec's
// output is decoded and compared to the bit. Reeb's bytes are those of the whole file, its
// connectivity included; the others get the positions alone, in the layout that suits them best.
#include <fpzip.h>
#include <lzma.h>
#include <zfp.h>
#include <zstd.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"
#include "tools/io/read_sequence.h"

namespace reeb {
namespace {

using Bytes = std::vector<uint8_t>;

/// Positions [frame][axis][vertex]: planes that change little from frame to frame.
struct Planes {
  std::vector<float> values;
  size_t vertices = 0;
  size_t frames = 0;
  size_t bytes() const { return values.size() * sizeof(float); }
};

Planes make_planes(const Shot& shot) {
  Planes out{{}, shot.connectivity.vertex_count, shot.frame_count};
  out.values.reserve(shot.positions.size());
  for (uint32_t t = 0; t < shot.frame_count; ++t) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t i = axis; i < shot.frame(t).size(); i += 3)
        out.values.push_back(shot.frame(t)[i]);
    }
  }
  return out;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A codec of planes; `decode` gives floats in the order of `values`.
struct Codec {
  std::string name;
  std::function<Bytes(const Planes&)> encode;
  std::function<std::vector<float>(const Bytes&, const Planes& shape)> decode;
};

Bytes encode_zstd(const Planes& in) {
  Bytes out(ZSTD_compressBound(in.bytes()));
  out.resize(ZSTD_compress(out.data(), out.size(), in.values.data(), in.bytes(), 19));
  return out;
}

std::vector<float> decode_zstd(const Bytes& in, const Planes& shape) {
  std::vector<float> out(shape.values.size());
  if (ZSTD_isError(ZSTD_decompress(out.data(), shape.bytes(), in.data(), in.size()))) return {};
  return out;
}

Bytes encode_xz(const Planes& in) {
  Bytes out(lzma_stream_buffer_bound(in.bytes()));
  size_t size = 0;
  if (lzma_easy_buffer_encode(9 | LZMA_PRESET_EXTREME, LZMA_CHECK_NONE, nullptr,
                              reinterpret_cast<const uint8_t*>(in.values.data()), in.bytes(),
                              out.data(), &size, out.size()) != LZMA_OK) {
    return {};
  }
  out.resize(size);
  return out;
}

std::vector<float> decode_xz(const Bytes& in, const Planes& shape) {
  std::vector<float> out(shape.values.size());
  uint64_t memory = UINT64_MAX;
  size_t read = 0, written = 0;
  const lzma_ret result =
      lzma_stream_buffer_decode(&memory, 0, nullptr, in.data(), &read, in.size(),
                                reinterpret_cast<uint8_t*>(out.data()), &written, shape.bytes());
  return result == LZMA_OK ? out : std::vector<float>();
}

/// Vertices along x, frames along y, axes along z.
std::vector<float> by_axis(const std::vector<float>& values, const Planes& shape, bool forth) {
  std::vector<float> out(values.size());
  for (size_t t = 0; t < shape.frames; ++t) {
    for (size_t a = 0; a < 3; ++a) {
      const size_t frame = (t * 3 + a) * shape.vertices;
      const size_t axis = (a * shape.frames + t) * shape.vertices;
      std::copy_n(&values[forth ? frame : axis], shape.vertices, &out[forth ? axis : frame]);
    }
  }
  return out;
}

void set_shape(FPZ& f, const Planes& shape) {
  f.type = FPZIP_TYPE_FLOAT;
  f.prec = 0;  // all of it
  f.nx = static_cast<int>(shape.vertices);
  f.ny = static_cast<int>(shape.frames);
  f.nz = 1;
  f.nf = 3;
}

Bytes encode_fpzip(const Planes& in) {
  const std::vector<float> values = by_axis(in.values, in, true);
  Bytes out(in.bytes() + in.bytes() / 4 + 1024);
  FPZ* f = fpzip_write_to_buffer(out.data(), out.size());
  set_shape(*f, in);
  out.resize(fpzip_write(f, values.data()));
  fpzip_write_close(f);
  return out;
}

std::vector<float> decode_fpzip(const Bytes& in, const Planes& shape) {
  std::vector<float> out(shape.values.size());
  FPZ* f = fpzip_read_from_buffer(in.data());
  set_shape(*f, shape);
  fpzip_read(f, out.data());
  fpzip_read_close(f);
  return by_axis(out, shape, false);
}

/// One stream an axis, vertices along x, frames along y.
struct ZfpAxis {
  zfp_field* field;
  zfp_stream* stream = zfp_stream_open(nullptr);
  ZfpAxis(const float* values, const Planes& shape)
      : field(zfp_field_2d(const_cast<float*>(values), zfp_type_float, shape.vertices,
                           shape.frames)) {
    zfp_stream_set_reversible(stream);
  }
  ~ZfpAxis() {
    zfp_field_free(field);
    zfp_stream_close(stream);
  }
  size_t run(void* bytes, size_t size, bool compress) {
    bitstream* bits = stream_open(bytes, size);
    zfp_stream_set_bit_stream(stream, bits);
    zfp_stream_rewind(stream);
    const size_t used = compress ? zfp_compress(stream, field) : zfp_decompress(stream, field);
    stream_close(bits);
    return used;
  }
};

Bytes encode_zfp(const Planes& in) {
  const std::vector<float> values = by_axis(in.values, in, true);
  Bytes out;
  for (size_t a = 0; a < 3; ++a) {
    ZfpAxis axis(&values[a * in.vertices * in.frames], in);
    Bytes part(zfp_stream_maximum_size(axis.stream, axis.field));
    part.resize(axis.run(part.data(), part.size(), true));
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

std::vector<float> decode_zfp(const Bytes& in, const Planes& shape) {
  std::vector<float> out(shape.values.size());
  Bytes bytes = in;
  size_t at = 0;
  for (size_t a = 0; a < 3; ++a) {
    ZfpAxis axis(&out[a * shape.vertices * shape.frames], shape);
    at += axis.run(bytes.data() + at, bytes.size() - at, false);
  }
  return by_axis(out, shape, false);
}

Codec reeb_codec(const std::string& name, const Sequence& sequence, int effort) {
  const auto encode_it = [&sequence, effort](const Planes&) {
    EncodeOptions options;
    options.target = Target::kLossless;
    options.effort = effort;
    options.threads = 1;
    Bytes bytes;
    EncodeStats stats;
    if (!encode(sequence, options, bytes, stats).ok()) bytes.clear();
    return bytes;
  };
  const auto decode_it = [](const Bytes& bytes, const Planes&) {
    Sequence decoded;
    if (!decode_sequence(bytes, {}, decoded).ok()) return std::vector<float>();
    return make_planes(decoded.shots[0]).values;
  };
  return {name, encode_it, decode_it};
}

void measure(const std::string& sequence, const Codec& codec, const Planes& planes) {
  const double begin = cpu_seconds();
  const Bytes bytes = codec.encode(planes);
  const double encoded = cpu_seconds();
  const std::vector<float> decoded = codec.decode(bytes, planes);
  const double end = cpu_seconds();
  const bool same = decoded.size() == planes.values.size() &&
                    std::memcmp(decoded.data(), planes.values.data(), planes.bytes()) == 0;
  const auto samples = static_cast<double>(planes.vertices * planes.frames);
  std::printf("%s,%s,%.3f,%.2f,%.2f%s\n", sequence.c_str(), codec.name.c_str(),
              8 * static_cast<double>(bytes.size()) / samples, samples / (encoded - begin) / 1e6,
              samples / (end - encoded) / 1e6, same ? "" : ",DIFFERENT");
  std::fflush(stdout);
}

bool run(const std::string& input) {
  std::vector<std::string> inputs = {input};
  const std::filesystem::path cache = std::filesystem::path(input).replace_extension(".pc2");
  if (cache != input && std::filesystem::exists(cache)) inputs.push_back(cache);
  Sequence sequence;
  tools::ReadReport report;
  if (Status s = tools::read_sequence(inputs, {.threads = 1}, sequence, report); !s.ok()) {
    std::fprintf(stderr, "%s\n", s.message().c_str());
    return false;
  }
  const std::string name = std::filesystem::path(input).stem();
  sequence.shots.resize(1);
  const Planes planes = make_planes(sequence.shots[0]);
  constexpr int kQuickEffort = 1;
  const Codec codecs[] = {reeb_codec("reeb", sequence, kDefaultEffort),
                          reeb_codec("reeb-quick", sequence, kQuickEffort),
                          {"fpzip", encode_fpzip, decode_fpzip},
                          {"zfp", encode_zfp, decode_zfp},
                          {"zstd-19", encode_zstd, decode_zstd},
                          {"xz-9e", encode_xz, decode_xz}};
  for (const Codec& codec : codecs) measure(name, codec, planes);
  return true;
}

}  // namespace
}  // namespace reeb

int main(int count, char** arguments) {
  std::printf("sequence,codec,bpvf,encode_mvps,decode_mvps\n");
  for (int i = 1; i < count; ++i) {
    if (!reeb::run(arguments[i])) return 1;
  }
}
