// How fast sequences are decoded on one core: Reeb's profiles beside Draco (one file a frame, the
// settings of draco_encoder) and meshoptimizer (vertex codec on the differences of 16-bit positions
// from frame to frame, 11 bits used; connectivity left out).
//
// decode_benchmark KG ROUNDS INPUT...: INPUT is one sequence as `reeb encode` takes it, or a
// `.reeb` stream, whose frames are decoded and coded anew. Frames are decoded in their order
// and dropped, Reeb's kFramesAtOnce at a time; those of an open group one by one, as a player does.
// One line of CSV per codec, medians of the CPU time of ROUNDS rounds in which the codecs take
// turns.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"
#include "tools/io/read_sequence.h"

namespace reeb {
namespace {

constexpr int kBits = 11;
constexpr uint32_t kFramesAtOnce = 16;
constexpr int kDracoSpeed = 3;  // draco_encoder's default, compression level 7

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "decode_benchmark: %s\n", what.c_str());
  std::exit(1);
}

void check(const Status& status) {
  if (!status.ok()) fail(status.message());
}

/// One competitor: its size, and what to time.
struct Codec {
  std::string name;
  size_t bytes = 0;
  double kg = 0;
  std::function<void()> decode_all;
  std::function<void()> open;    ///< to the first frame; empty where every frame stands alone
  std::function<void()> frames;  ///< all frames of what `open` opened
  std::vector<double> all_seconds, open_seconds, frame_seconds;
};

class Original {
 public:
  explicit Original(const Shot& shot) : shot_(shot) {
    const size_t n = shot.frame(0).size() / 3;
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      double mean[3] = {};
      for (size_t i = 0; i < 3 * n; ++i) mean[i % 3] += static_cast<double>(shot.frame(t)[i]);
      for (size_t i = 0; i < 3 * n; ++i) {
        const double d =
            static_cast<double>(shot.frame(t)[i]) - mean[i % 3] / static_cast<double>(n);
        energy_ += d * d;
      }
    }
    const auto [low, high] = std::minmax_element(shot.positions.begin(), shot.positions.end());
    low_ = *low;
    step_ = (*high - *low) / static_cast<float>((1 << kBits) - 1);
  }

  /// KG error of what `frame(t)` gives, in percent.
  double kg(const std::function<const float*(uint32_t)>& frame) const {
    double sum = 0;
    for (uint32_t t = 0; t < shot_.frame_count; ++t) {
      const float* decoded = frame(t);
      for (size_t i = 0; i < shot_.frame(t).size(); ++i) {
        const double d = static_cast<double>(shot_.frame(t)[i]) - static_cast<double>(decoded[i]);
        sum += d * d;
      }
    }
    return 100 * std::sqrt(sum / energy_);
  }

  const Shot& shot() const { return shot_; }
  size_t vertices() const { return shot_.frame(0).size() / 3; }
  float low() const { return low_; }
  float step() const { return step_; }

 private:
  const Shot& shot_;
  double energy_ = 0;
  float low_ = 0, step_ = 0;
};

Codec make_reeb(const Sequence& sequence, const Original& original, Profile profile, double kg) {
  struct State {
    std::vector<uint8_t> bytes;
    std::unique_ptr<Decoder> decoder;
    std::vector<float> xyz;
  };
  const auto state = std::make_shared<State>();
  EncodeOptions options;
  options.target_value = kg;
  options.profile = profile;
  EncodeStats stats;
  check(encode(sequence, options, state->bytes, stats));
  state->xyz.resize(original.vertices() * 3 * kFramesAtOnce);
  Codec out;
  out.name = profile == Profile::kMain ? "reeb main" : "reeb fast";
  out.bytes = state->bytes.size();
  out.kg = stats.kg;
  out.open = [state] {
    check(Decoder::open(state->bytes, {}, state->decoder));
    check(state->decoder->decode_frame(0, state->xyz.data()));
  };
  out.frames = [state] {
    for (uint32_t t = 0; t < state->decoder->info().frame_count; ++t)
      check(state->decoder->decode_frame(t, state->xyz.data()));
  };
  out.decode_all = [state] {
    check(Decoder::open(state->bytes, {}, state->decoder));
    const uint32_t count = state->decoder->info().frame_count;
    const size_t stride = state->xyz.size() / kFramesAtOnce;
    for (uint32_t t = 0; t < count; t += kFramesAtOnce)
      check(state->decoder->decode_frames(t, std::min(kFramesAtOnce, count - t), state->xyz.data(),
                                          stride));
  };
  return out;
}

std::vector<char> encode_draco_frame(const Connectivity& c, const float* xyz) {
  draco::TriangleSoupMeshBuilder builder;
  std::vector<uint32_t> corners;
  for (size_t f = 0, at = 0; f < c.face_sizes.size(); at += c.face_sizes[f++]) {
    for (uint32_t i = 1; i + 1 < c.face_sizes[f]; ++i)
      corners.insert(corners.end(), {c.corners[at], c.corners[at + i], c.corners[at + i + 1]});
  }
  builder.Start(static_cast<int>(corners.size() / 3));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (uint32_t t = 0; t < corners.size() / 3; ++t) {
    const uint32_t* v = &corners[size_t{t} * 3];
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(t), xyz + size_t{v[0]} * 3,
                                      xyz + size_t{v[1]} * 3, xyz + size_t{v[2]} * 3);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetSpeedOptions(kDracoSpeed, kDracoSpeed);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kBits);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  draco::EncoderBuffer buffer;
  if (mesh == nullptr || !encoder.EncodeMeshToBuffer(*mesh, &buffer).ok())
    fail("Draco does not encode this");
  return {buffer.data(), buffer.data() + buffer.size()};
}

Codec make_draco(const Original& original) {
  const auto files = std::make_shared<std::vector<std::vector<char>>>();
  Codec out;
  out.name = "draco";
  for (uint32_t t = 0; t < original.shot().frame_count; ++t) {
    files->push_back(
        encode_draco_frame(original.shot().connectivity, original.shot().frame(t).data()));
    out.bytes += files->back().size();
  }
  out.decode_all = [files] {
    for (const std::vector<char>& file : *files) {
      draco::DecoderBuffer buffer;
      buffer.Init(file.data(), file.size());
      if (!draco::Decoder().DecodeMeshFromBuffer(&buffer).ok())
        fail("Draco does not decode its file");
    }
  };
  return out;
}

struct MeshoptFrames {
  std::vector<std::vector<unsigned char>> files;
  std::vector<int16_t> delta, sum;  // four a vertex; the fourth is 0
  std::vector<float> xyz;
  float low, step;

  void begin() { std::fill(sum.begin(), sum.end(), int16_t{0}); }
  void next(uint32_t t) {
    const size_t n = sum.size() / 4;
    if (meshopt_decodeVertexBuffer(delta.data(), n, 8, files[t].data(), files[t].size()) != 0)
      fail("meshoptimizer does not decode its data");
    for (size_t i = 0; i < sum.size(); ++i) sum[i] = static_cast<int16_t>(sum[i] + delta[i]);
    for (size_t v = 0; v < n; ++v) {
      for (size_t a = 0; a < 3; ++a)
        xyz[v * 3 + a] = low + step * static_cast<float>(sum[v * 4 + a]);
    }
  }
};

Codec make_meshopt(const Original& original) {
  const auto state = std::make_shared<MeshoptFrames>();
  const size_t n = original.vertices();
  state->sum.resize(n * 4);
  state->delta.resize(n * 4);
  state->xyz.resize(n * 3);
  state->low = original.low();
  state->step = original.step();
  Codec out;
  out.name = "meshoptimizer";
  for (uint32_t t = 0; t < original.shot().frame_count; ++t) {
    for (size_t i = 0; i < n * 3; ++i) {
      const float cell = (original.shot().frame(t)[i] - state->low) / state->step;
      const auto now = static_cast<int16_t>(std::lround(cell));
      int16_t& before = state->sum[i / 3 * 4 + i % 3];
      state->delta[i / 3 * 4 + i % 3] = static_cast<int16_t>(now - before);
      before = now;
    }
    std::vector<unsigned char> file(meshopt_encodeVertexBufferBound(n, 8));
    file.resize(meshopt_encodeVertexBuffer(file.data(), file.size(), state->delta.data(), n, 8));
    out.bytes += file.size();
    state->files.push_back(std::move(file));
  }
  out.decode_all = [state] {
    state->begin();
    for (uint32_t t = 0; t < state->files.size(); ++t) state->next(t);
  };
  state->begin();
  out.kg = original.kg([state](uint32_t t) {
    state->next(t);
    return state->xyz.data();
  });
  return out;
}

double time_of(const std::function<void()>& work) {
  if (!work) return 0;
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void run(double kg, int rounds, const std::vector<std::string>& inputs) {
  Sequence sequence;
  tools::ReadReport report;
  check(tools::read_sequence(inputs, {}, sequence, report));
  if (sequence.shots.size() != 1) fail("the connectivity changes");
  const Original original(sequence.shots[0]);
  std::vector<Codec> codecs;
  codecs.push_back(make_draco(original));
  codecs.push_back(make_meshopt(original));
  codecs.push_back(make_reeb(sequence, original, Profile::kMain, kg));
  codecs.push_back(make_reeb(sequence, original, Profile::kFast, kg));
  for (int i = 0; i < rounds; ++i) {
    for (Codec& c : codecs) {
      c.all_seconds.push_back(time_of(c.decode_all));
      c.open_seconds.push_back(time_of(c.open));
      c.frame_seconds.push_back(time_of(c.frames));
    }
  }
  const double samples = static_cast<double>(original.vertices()) * original.shot().frame_count;
  const double draco = median(codecs[0].all_seconds);
  std::puts("sequence,codec,bpvf,kg,Mvertices_per_s,times_draco,open_ms,Mvertices_per_s_open");
  for (const Codec& c : codecs) {
    const double all = median(c.all_seconds);
    const double open = median(c.frame_seconds);
    std::printf("%s,%s,%.4f,%.4f,%.2f,%.2f,%.2f,%.1f\n", inputs[0].c_str(), c.name.c_str(),
                8 * static_cast<double>(c.bytes) / samples, c.kg, 1e-6 * samples / all, draco / all,
                1e3 * median(c.open_seconds), open > 0 ? 1e-6 * samples / open : 0);
  }
}

}  // namespace
}  // namespace reeb

int main(int argc, char** argv) {
  if (argc < 4 || std::atof(argv[1]) <= 0 || std::atoi(argv[2]) <= 0) {
    std::fputs("usage: decode_benchmark KG ROUNDS INPUT...\n", stderr);
    return 2;
  }
  reeb::run(std::atof(argv[1]), std::atoi(argv[2]), {argv + 3, argv + argc});
  return 0;
}
