// Bits per vertex and frame with a bounded error of every coordinate, beside zfp's accuracy mode at
// an equal or larger measured error.
//
// bounded_benchmark [--reorder] INPUT...: mesh and point cache, or what else `reeb encode` reads.
// CSV on standard output, a line for each bound: 1e-3, 1e-4 and 1e-5 of the bounding-box diagonal.
#include <zfp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "codec/enc/encoder.h"
#include "tools/io/read_sequence.h"
#include "tools/metrics.h"

namespace reeb::tools {
namespace {

struct Outcome {
  double bytes = 0;
  double max_error = 0;
};

/// The shot as one array of frames x vertices x 3, or a plane of frames x vertices for each axis.
Outcome run_zfp(const Shot& shot, bool planes, double tolerance) {
  const size_t rows = shot.connectivity.vertex_count;
  const size_t frames = shot.frame_count;
  Outcome out;
  for (size_t axis = 0; axis < (planes ? 3 : 1); ++axis) {
    std::vector<float> values;
    for (size_t i = axis; i < shot.positions.size(); i += planes ? 3 : 1)
      values.push_back(shot.positions[i]);
    std::vector<float> decoded(values.size());
    const std::unique_ptr<zfp_field, decltype(&zfp_field_free)> field(
        planes ? zfp_field_2d(values.data(), zfp_type_float, rows, frames)
               : zfp_field_3d(values.data(), zfp_type_float, 3, rows, frames),
        zfp_field_free);
    const std::unique_ptr<zfp_stream, decltype(&zfp_stream_close)> zfp(zfp_stream_open(nullptr),
                                                                       zfp_stream_close);
    zfp_stream_set_accuracy(zfp.get(), tolerance);
    std::vector<uint8_t> buffer(zfp_stream_maximum_size(zfp.get(), field.get()));
    bitstream* bits = stream_open(buffer.data(), buffer.size());
    zfp_stream_set_bit_stream(zfp.get(), bits);
    zfp_stream_rewind(zfp.get());
    out.bytes += static_cast<double>(zfp_compress(zfp.get(), field.get()));
    zfp_stream_rewind(zfp.get());
    zfp_field_set_pointer(field.get(), decoded.data());
    zfp_decompress(zfp.get(), field.get());
    stream_close(bits);
    for (size_t i = 0; i < values.size(); ++i) {
      const double error = static_cast<double>(values[i]) - static_cast<double>(decoded[i]);
      out.max_error = std::max(out.max_error, std::abs(error));
    }
  }
  return out;
}

/// The smallest of zfp's encodings whose measured error is within the bound. Its tolerance is
/// cautious and acts in octaves, so larger ones are tried too.
double zfp_bpvf(const Shot& shot, bool planes, double bound) {
  for (double tolerance = 16 * bound; tolerance > bound / 4; tolerance /= 2) {
    const Outcome out = run_zfp(shot, planes, tolerance);
    if (out.max_error <= bound) {
      return 8 * out.bytes / static_cast<double>(shot.positions.size() / 3);
    }
  }
  return 0;
}

int run(const std::vector<std::string>& inputs, bool reorder) {
  Sequence sequence;
  ReadReport report;
  Status status = read_sequence(inputs, {}, sequence, report);
  if (!status.ok() || sequence.shots.size() != 1) {
    std::fprintf(stderr, "bounded_benchmark: %s\n",
                 status.ok() ? "more than one shot" : status.message().c_str());
    return 1;
  }
  std::printf("bound,reeb_bpvf,reeb_max_error,zfp_3d_bpvf,zfp_planes_bpvf\n");
  for (const double part : {1e-3, 1e-4, 1e-5}) {
    EncodeOptions options;
    options.target = Target::kMaxError;
    options.target_value = part * bounding_diagonal(sequence);
    options.reorder = reorder;
    options.threads = 1;
    std::vector<uint8_t> bytes;
    EncodeStats stats;
    status = encode(sequence, options, bytes, stats);
    if (!status.ok()) {
      std::fprintf(stderr, "bounded_benchmark: %s\n", status.message().c_str());
      return 1;
    }
    std::printf("%g,%.4f,%.3g,%.3f,%.3f\n", part, stats.bpvf, stats.max_error,
                zfp_bpvf(sequence.shots[0], false, options.target_value),
                zfp_bpvf(sequence.shots[0], true, options.target_value));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace reeb::tools

int main(int argc, char** argv) {
  std::vector<std::string> inputs(argv + 1, argv + argc);
  const bool reorder = std::erase(inputs, "--reorder") > 0;
  return reeb::tools::run(inputs, reorder);
}
