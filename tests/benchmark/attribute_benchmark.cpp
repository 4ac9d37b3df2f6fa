// What attributes cost in Reeb and in others, in one run, all bytes counted.
//
// attribute_benchmark [MESH.obj...]: CSV on standard output: mesh, attribute, codec, setting,
// bytes. Of each mesh what its texture coordinates (to 12 bits), colours (8 bits; made where it has
// none) and materials (both exact) add to the file: to Reeb's at its defaults and to Draco's at its
// strongest, with positions of 11 bits, as draco_encoder has them. What is decoded is compared; an
// error beyond half a step ends the run. Then animated values: a wave over a sheet, 2,500 vertices
// and 120 frames, to 0.1 % of its range beside zfp in its accuracy mode, and exact beside fpzip, as
// frames and as the grid that they are.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fpzip.h>
#include <zfp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"

namespace reeb {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kTextureBits = 12;
constexpr int kPositionBits = 11;  // of draco_encoder

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "attribute_benchmark: %s\n", what.c_str());
  std::exit(1);
}

void print(const std::string& mesh, const std::string& attribute, const std::string& codec,
           const std::string& setting, double bytes) {
  std::printf("%s,%s,%s,%s,%.0f\n", mesh.c_str(), attribute.c_str(), codec.c_str(), setting.c_str(),
              bytes);
}

/// What this benchmark needs of an OBJ file.
struct Mesh {
  std::string name;
  Shot shot;
  std::vector<float> uv;            ///< of corners
  std::vector<uint8_t> colours;     ///< of vertices, RGB
  std::vector<uint16_t> materials;  ///< of faces
};

void read_vertex(std::istringstream& line, Mesh& out) {
  float x = 0;
  for (int i = 0; i < 3 && line >> x; ++i) out.shot.positions.push_back(x);
  while (line >> x)
    out.colours.push_back(static_cast<uint8_t>(std::lround(std::clamp(x, 0.0f, 1.0f) * 255)));
}

void read_face(std::istringstream& line, const std::vector<float>& vt, Mesh& out) {
  Connectivity& c = out.shot.connectivity;
  uint32_t size = 0;
  for (std::string corner; line >> corner; ++size) {
    int v = 0, t = 0;
    const int fields = std::sscanf(corner.c_str(), "%d/%d", &v, &t);
    c.corners.push_back(static_cast<uint32_t>(v - 1));
    for (size_t k = 0; k < 2 && fields == 2; ++k)
      out.uv.push_back(vt.at(2 * static_cast<size_t>(t - 1) + k));
  }
  c.face_sizes.push_back(size);
}

Mesh read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) fail("cannot read " + path);
  Mesh out;
  out.name = path.substr(path.rfind('/') + 1);
  std::vector<float> vt;
  std::map<std::string, uint16_t> materials;
  uint16_t material = 0;
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    float x = 0;
    if (word == "v") read_vertex(line, out);
    for (int k = 0; word == "vt" && k < 2 && line >> x; ++k) vt.push_back(x);
    if (word == "usemtl" && line >> word) {
      material = materials.emplace(word, static_cast<uint16_t>(materials.size())).first->second;
    } else if (word == "f") {
      read_face(line, vt, out);
      out.materials.push_back(material);
    }
  }
  out.shot.connectivity.vertex_count = static_cast<uint32_t>(out.shot.positions.size() / 3);
  out.shot.frame_count = 1;
  if (out.uv.size() != 2 * out.shot.connectivity.corners.size()) out.uv.clear();
  if (out.colours.size() != out.shot.positions.size()) out.colours.clear();
  if (materials.size() < 2) out.materials.clear();
  return out;
}

/// What Draco's quantization makes of texture coordinates: one step for both.
double texture_step(const std::vector<float>& uv) {
  float low[2] = {uv[0], uv[1]}, high[2] = {uv[0], uv[1]};
  for (size_t i = 0; i < uv.size(); ++i) {
    low[i % 2] = std::min(low[i % 2], uv[i]);
    high[i % 2] = std::max(high[i % 2], uv[i]);
  }
  const double range = double{std::max(high[0] - low[0], high[1] - low[1])};
  return range / ((1 << kTextureBits) - 1);
}

EncodeOptions options_of(Target target) {
  EncodeOptions options;
  options.target = target;
  options.threads = 1;
  return options;
}

/// Encodes, and gives back the shot as it is decoded.
size_t encode_reeb(const Shot& shot, const EncodeOptions& options, Shot* decoded = nullptr) {
  Sequence sequence, out;
  sequence.shots = {shot};
  Bytes bytes;
  EncodeStats stats;
  if (const Status s = encode(sequence, options, bytes, stats); !s.ok()) fail(s.message());
  if (decoded == nullptr) return bytes.size();
  if (const Status s = decode_sequence(bytes, {}, out); !s.ok()) fail(s.message());
  *decoded = std::move(out.shots[0]);
  return bytes.size();
}

double number(const Attribute& a, size_t i) {
  return a.type == ValueType::kBinary32       ? double{a.get<float>(i)}
         : size_of(a.type) == sizeof(uint8_t) ? a.get<uint8_t>(i)
                                              : a.get<uint16_t>(i);
}

/// Calls visit(vertex, numbers) for every corner, in every frame.
template <class Visit>
void for_each_corner(const Shot& shot, const Attribute& a, Visit visit) {
  const Connectivity& c = shot.connectivity;
  const size_t elements = shot.element_count(a.domain) * a.channel_count;
  for (size_t frame = 0; frame < a.values.size() / size_of(a.type); frame += elements) {
    for (size_t f = 0, corner = 0; f < c.face_sizes.size(); ++f) {
      for (uint32_t i = 0; i < c.face_sizes[f]; ++i, ++corner) {
        const uint32_t v = c.corners[corner];
        const size_t e = a.domain == Domain::kVertex ? v : a.domain == Domain::kFace ? f : corner;
        std::vector<double> numbers;
        for (size_t k = 0; k < a.channel_count; ++k)
          numbers.push_back(number(a, frame + e * a.channel_count + k));
        visit(size_t{v} + frame / elements * c.vertex_count, numbers);
      }
    }
  }
}

/// How far decoded corners are from the nearest that the vertex had, as faces may come in another
/// order.
double worst_error(const Shot& input, const Attribute& a, const Shot& decoded) {
  std::map<size_t, std::vector<std::vector<double>>> known;
  for_each_corner(input, a, [&](size_t v, const auto& x) { known[v].push_back(x); });
  double worst = 0;
  for_each_corner(decoded, decoded.attributes[0], [&](size_t v, const auto& x) {
    double least = INFINITY;
    for (const std::vector<double>& y : known[v]) {
      double off = 0;
      for (size_t k = 0; k < x.size(); ++k) off = std::max(off, std::abs(x[k] - y[k]));
      least = std::min(least, off);
    }
    worst = std::max(worst, least);
  });
  return worst;
}

/// Bytes that the attribute adds.
double added_by_reeb(const Shot& bare, const Attribute& attribute, const EncodeOptions& options) {
  Shot shot = bare;
  shot.attributes = {attribute};
  Shot decoded;
  const size_t with = encode_reeb(shot, options, &decoded);
  const double allowed = attribute.max_error.empty() ? 0 : attribute.max_error[0] * (1 + 1e-6);
  if (worst_error(bare, attribute, decoded) > allowed)
    fail("an attribute is further off than it may be");
  return static_cast<double>(with) - static_cast<double>(encode_reeb(bare, options));
}

/// One attribute beside positions, as Draco's own tool builds a mesh.
class DracoMesh {
 public:
  DracoMesh(const Mesh& mesh, const std::string& attribute) : mesh_(mesh) {
    const Connectivity& c = mesh.shot.connectivity;
    int triangles = 0;
    for (const uint32_t size : c.face_sizes) triangles += std::max(0, static_cast<int>(size) - 2);
    builder_.Start(triangles);
    position_ = builder_.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    if (attribute == "uv")
      uv_ = builder_.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    if (attribute == "colour")
      colour_ = builder_.AddAttribute(draco::GeometryAttribute::COLOR, 3, draco::DT_UINT8);
    if (attribute == "material")
      material_ = builder_.AddAttribute(draco::GeometryAttribute::GENERIC, 1, draco::DT_UINT16);
    uint32_t first = 0;
    for (size_t f = 0; f < c.face_sizes.size(); first += c.face_sizes[f++]) {
      for (uint32_t i = 1; i + 1 < c.face_sizes[f]; ++i)
        add_triangle(f, {first, first + i, first + i + 1});
    }
  }

  size_t encode() {
    const std::unique_ptr<draco::Mesh> built = builder_.Finalize();
    if (built == nullptr) fail("Draco does not build " + mesh_.name);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kPositionBits);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, kTextureBits);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*built, &buffer).ok()) fail("Draco fails on " + mesh_.name);
    return buffer.size();
  }

 private:
  struct Corners {
    uint32_t c[3];
  };
  void add_triangle(size_t face, const Corners& corners) {
    const draco::FaceIndex at(next_++);
    const float *xyz[3], *uv[3];
    const uint8_t* rgb[3];
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t v = mesh_.shot.connectivity.corners[corners.c[i]];
      xyz[i] = &mesh_.shot.positions[size_t{v} * 3];
      uv[i] = uv_ >= 0 ? &mesh_.uv[size_t{corners.c[i]} * 2] : nullptr;
      rgb[i] = colour_ >= 0 ? &mesh_.colours[size_t{v} * 3] : nullptr;
    }
    builder_.SetAttributeValuesForFace(position_, at, xyz[0], xyz[1], xyz[2]);
    if (uv_ >= 0) builder_.SetAttributeValuesForFace(uv_, at, uv[0], uv[1], uv[2]);
    if (colour_ >= 0) builder_.SetAttributeValuesForFace(colour_, at, rgb[0], rgb[1], rgb[2]);
    if (material_ >= 0)
      builder_.SetPerFaceAttributeValueForFace(material_, at, &mesh_.materials[face]);
  }

  const Mesh& mesh_;
  draco::TriangleSoupMeshBuilder builder_;
  int position_ = -1, uv_ = -1, colour_ = -1, material_ = -1;
  uint32_t next_ = 0;
};

void compare(const Mesh& mesh, const std::string& name, const std::string& setting,
             const Attribute& attribute) {
  print(mesh.name, name, "reeb", setting,
        added_by_reeb(mesh.shot, attribute, options_of(Target::kKg)));
  const auto with = static_cast<double>(DracoMesh(mesh, name).encode());
  print(mesh.name, name, "draco", setting,
        with - static_cast<double>(DracoMesh(mesh, "").encode()));
}

Attribute make(Semantic semantic, Domain domain, ValueType type, uint32_t channels) {
  Attribute a;
  a.name = std::string(1, 'a');
  a.semantic = semantic;
  a.domain = domain;
  a.type = type;
  a.channel_count = channels;
  return a;
}

/// RGB that changes smoothly over the box of a mesh, for meshes without colours.
std::vector<uint8_t> made_colours(const Shot& shot) {
  std::vector<uint8_t> out;
  const auto [low, high] = std::minmax_element(shot.positions.begin(), shot.positions.end());
  const double scale = 1 / std::max(double{*high} - double{*low}, 1e-30);
  for (size_t i = 0; i < shot.positions.size(); ++i) {
    const double x = (double{shot.positions[i]} - double{*low}) * scale;
    const double y = (double{shot.positions[i - i % 3]} - double{*low}) * scale;
    out.push_back(static_cast<uint8_t>(127.5 + 127 * std::sin(6 * x + 4 * y)));
  }
  return out;
}

void measure(Mesh mesh) {
  if (!mesh.uv.empty()) {
    Attribute uv = make(Semantic::kTextureCoordinate, Domain::kCorner, ValueType::kBinary32, 2);
    uv.assign(std::span<const float>(mesh.uv));
    uv.max_error.assign(2, texture_step(mesh.uv) / 2);
    compare(mesh, "uv", "12 bits", uv);
  }
  const bool made = mesh.colours.empty();
  if (made) mesh.colours = made_colours(mesh.shot);
  {
    Attribute colour = make(Semantic::kColour, Domain::kVertex, ValueType::kU8Normalised, 3);
    colour.assign(std::span<const uint8_t>(mesh.colours));
    compare(mesh, "colour", made ? "exact (made)" : "exact", colour);
  }
  if (!mesh.materials.empty()) {
    Attribute material = make(Semantic::kMaterial, Domain::kFace, ValueType::kU16, 1);
    material.assign(std::span<const uint16_t>(mesh.materials));
    compare(mesh, "material", "exact", material);
  }
}

constexpr uint32_t kSide = 50, kFrames = 120;

/// A sheet at rest and the height of two waves that run over it and fade.
Shot wave(std::vector<float>& values) {
  Shot shot;
  shot.connectivity.vertex_count = kSide * kSide;
  shot.frame_count = kFrames;
  for (uint32_t y = 0; y + 1 < kSide; ++y) {
    for (uint32_t x = 0; x + 1 < kSide; ++x) {
      const uint32_t v = y * kSide + x;
      shot.connectivity.face_sizes.push_back(4);
      for (const uint32_t corner : {v, v + 1, v + kSide + 1, v + kSide})
        shot.connectivity.corners.push_back(corner);
    }
  }
  for (uint32_t t = 0; t < kFrames; ++t) {
    for (uint32_t v = 0; v < kSide * kSide; ++v) {
      const double x = (v % kSide) / (kSide - 1.0), y = (v / kSide) / (kSide - 1.0);
      const double time = t / 25.0, near = std::hypot(x - 0.3, y - 0.4),
                   far = std::hypot(x - 0.9, y - 0.1);
      values.push_back(
          static_cast<float>(std::sin(25 * near - 6 * time) * std::exp(-2 * near - 0.2 * time) +
                             0.4 * std::sin(18 * far - 4 * time) * std::exp(-3 * far)));
      for (const double p : {x, y, 0.0}) shot.positions.push_back(static_cast<float>(p));
    }
  }
  return shot;
}

/// Bytes of a field of this shape in zfp's accuracy mode.
size_t encode_zfp(zfp_field* field, double tolerance) {
  zfp_stream* const stream = zfp_stream_open(nullptr);
  zfp_stream_set_accuracy(stream, tolerance);
  Bytes out(zfp_stream_maximum_size(stream, field));
  bitstream* const bits = stream_open(out.data(), out.size());
  zfp_stream_set_bit_stream(stream, bits);
  const size_t size = zfp_compress(stream, field);
  zfp_field_free(field);
  zfp_stream_close(stream);
  stream_close(bits);
  return size;
}

size_t encode_fpzip(const std::vector<float>& values, int nx, int ny, int nz) {
  Bytes out(values.size() * sizeof(float) * 2 + 1024);
  FPZ* const fpz = fpzip_write_to_buffer(out.data(), out.size());
  fpz->type = FPZIP_TYPE_FLOAT;
  fpz->prec = 0;
  fpz->nx = nx;
  fpz->ny = ny;
  fpz->nz = nz;
  fpz->nf = 1;
  const size_t size = fpzip_write(fpz, values.data());
  fpzip_write_close(fpz);
  return size;
}

void measure_wave() {
  std::vector<float> values;
  const Shot shot = wave(values);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double error = 1e-3 * (double{*high} - double{*low});
  Attribute a = make(Semantic::kGeneric, Domain::kVertex, ValueType::kBinary32, 1);
  a.animated = true;
  a.assign(std::span<const float>(values));
  print("wave", "height", "reeb", "exact", added_by_reeb(shot, a, options_of(Target::kLossless)));
  a.max_error = {error};
  print("wave", "height", "reeb", "0.1 %", added_by_reeb(shot, a, options_of(Target::kLossless)));
  constexpr size_t kPlane = size_t{kSide} * kSide;
  float* const data = values.data();
  const size_t flat = encode_zfp(zfp_field_2d(data, zfp_type_float, kPlane, kFrames), error);
  const size_t deep = encode_zfp(zfp_field_3d(data, zfp_type_float, kSide, kSide, kFrames), error);
  print("wave", "height", "zfp frames", "0.1 %", static_cast<double>(flat));
  print("wave", "height", "zfp grid", "0.1 %", static_cast<double>(deep));
  print("wave", "height", "fpzip frames", "exact",
        static_cast<double>(encode_fpzip(values, static_cast<int>(kPlane), kFrames, 1)));
  print("wave", "height", "fpzip grid", "exact",
        static_cast<double>(encode_fpzip(values, kSide, kSide, kFrames)));
}

}  // namespace
}  // namespace reeb

int main(int argc, char** argv) {
  std::puts("mesh,attribute,codec,setting,bytes");
  for (int i = 1; i < argc; ++i) reeb::measure(reeb::read_obj(argv[i]));
  reeb::measure_wave();
  return 0;
}
