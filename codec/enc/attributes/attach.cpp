#include "codec/enc/attributes/attach.h"

#include <cmath>
#include <cstring>
#include <deque>
#include <numeric>
#include <string>
#include <utility>

#include "bitstream/container.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/dec/decoder.h"
#include "codec/dec/reference_mesh_decoder.h"
#include "codec/enc/attributes/attribute_encoder.h"
#include "codec/enc/attributes/bounds.h"
#include "codec/enc/attributes/normal_choice.h"
#include "codec/enc/reference/face_matching.h"
#include "codec/enc/reference/reference_mesh_encoder.h"

namespace reeb {

namespace {

constexpr Limits kNoLimits{.max_vertices = kMaxVertices,
                           .max_faces = UINT32_MAX,
                           .max_frames = UINT32_MAX,
                           .max_memory = UINT64_MAX};

std::string name_of(const Attribute& a) { return "attribute \"" + a.name + "\""; }

Status check_attribute(const Shot& shot, const Attribute& a) {
  const auto wrong = [&](const std::string& what) { return Status::invalid(name_of(a) + what); };
  if (a.name.size() > kMaxAttributeName) return wrong(" has a name longer than 256 bytes");
  if (a.channel_count < 1 || a.channel_count > kMaxChannels)
    return wrong(" has not 1 to 16 channels");
  const size_t frames = a.animated ? shot.frame_count : 1;
  if (a.values.size() != frames * shot.element_count(a.domain) * a.element_bytes())
    return wrong(": the number of values does not match the mesh");
  if (!a.max_error.empty() && a.max_error.size() != a.channel_count)
    return wrong(" has not an error for every channel");
  for (const double error : a.max_error) {
    if (!(error > 0) || !std::isfinite(error)) return wrong(" has an error that is not above 0");
  }
  if (!(a.max_angle >= 0) || !(a.corrected_angle >= 0)) return wrong(" has an angle below 0");
  return {};
}

/// Where the elements of the input are in the output: input element of each output element.
class ElementOrder {
 public:
  /// `vertices`: input vertex of each output vertex; empty where they are the same.
  ElementOrder(const Connectivity& output, Connectivity input, std::vector<uint32_t> vertices)
      : vertices_(std::move(vertices)) {
    std::vector<uint32_t> renamed(vertices_.size());
    for (uint32_t v = 0; v < vertices_.size(); ++v) renamed[vertices_[v]] = v;
    for (uint32_t& v : input.corners) v = renamed.empty() ? v : renamed[v];
    faces_ = match_faces(output, input);
    std::vector<size_t> first{0};
    for (const uint32_t size : input.face_sizes) first.push_back(first.back() + size);
    for (size_t f = 0; f < faces_.index.size(); ++f) {
      const uint32_t size = output.face_sizes[f];
      for (uint32_t i = 0; i < size; ++i)
        corners_.push_back(
            static_cast<uint32_t>(first[faces_.index[f]] + (i + size - faces_.first[f]) % size));
    }
  }

  Attribute arrange(const Attribute& a) const {
    const bool same = a.domain == Domain::kVertex && vertices_.empty();
    if (same || a.domain == Domain::kShot) return a;
    const std::vector<uint32_t>& order = a.domain == Domain::kVertex ? vertices_
                                         : a.domain == Domain::kFace ? faces_.index
                                                                     : corners_;
    Attribute out = a;
    const size_t bytes = a.element_bytes(), frame = order.size() * bytes;
    for (size_t start = 0; start + frame <= a.values.size() && frame > 0; start += frame) {
      for (size_t e = 0; e < order.size(); ++e)
        std::memcpy(&out.values[start + e * bytes], &a.values[start + order[e] * bytes], bytes);
    }
    return out;
  }

  size_t faces() const { return faces_.index.size(); }

 private:
  std::vector<uint32_t> vertices_;
  FaceOrder faces_;
  std::vector<uint32_t> corners_;
};

/// A shot on its way into the file: its attributes, those that move with their encoders.
class ShotAttributes {
 public:
  /// `positions`: of the shot.
  ShotAttributes(const Shot& shot, const AnimatedOptions& options, FramePositions positions)
      : shot_(shot), options_(options), positions_(std::move(positions)) {}

  /// Behind the reference mesh.
  Status write(const ReferenceChunk& reference, ContainerWriter& writer);
  /// Behind a group.
  Status write_group(const GroupHeader& header, ContainerWriter& writer);

 private:
  Status encode(const ElementOrder& order, const ShotSurface& surface, uint32_t index,
                CodedAttribute& out);

  struct Animated {
    uint32_t index;
    Attribute attribute;  ///< in output order
    AnimatedEncoder encoder;
  };
  const Shot& shot_;
  const AnimatedOptions options_;
  const FramePositions positions_;
  uint32_t first_frame_ = 0;
  std::deque<Animated> animated_;
};

Status ShotAttributes::encode(const ElementOrder& order, const ShotSurface& surface, uint32_t index,
                              CodedAttribute& out) {
  Attribute arranged = order.arrange(shot_.attributes[index]);
  ComputedNormals normals;
  if (compute_normals(arranged, surface, shot_.frame_count, positions_, normals)) {
    out = std::move(normals.coded);
    if (!out.header.in_groups()) return {};
    Animated& a = animated_.emplace_back(Animated{index, std::move(normals.corrections), {}});
    a.encoder.begin(a.attribute, element_count(a.attribute.domain, surface.connectivity),
                    std::move(normals.sites));
    return {};
  }
  if (!arranged.animated) return encode_static_attribute(arranged, surface, out);
  Animated& a = animated_.emplace_back(Animated{index, std::move(arranged), {}});
  return a.encoder.begin(a.attribute, surface, out);
}

Status ShotAttributes::write(const ReferenceChunk& reference, ContainerWriter& writer) {
  first_frame_ = reference.header.first_frame;
  if (shot_.attributes.empty()) return {};
  ReferenceMesh mesh;
  if (Status s = decode_reference(reference.mesh, kNoLimits, mesh); !s.ok()) return s;
  std::vector<uint32_t> coding(mesh.vertex_count);
  std::iota(coding.begin(), coding.end(), 0u);
  const ShotSurface surface{mesh.connectivity, output_grid(mesh.grid, coding, mesh.output_index)};
  std::vector<uint32_t> vertices;
  if (options_.reorder) vertices = ReferencePlan(shot_.connectivity).input_vertices();
  const ElementOrder order(mesh.connectivity, shot_.connectivity, std::move(vertices));
  if (order.faces() != shot_.connectivity.face_sizes.size())
    return Status::invalid("attributes: the file has other faces than the sequence");
  for (uint32_t i = 0; i < shot_.attributes.size(); ++i) {
    CodedAttribute coded;
    if (Status s = encode(order, surface, i, coded); !s.ok()) return s;
    coded.header.shot = reference.header.shot;
    coded.header.index = i;
    if (Status s = writer.attribute(coded.header, coded.body, coded.section); !s.ok()) return s;
  }
  return {};
}

Status ShotAttributes::write_group(const GroupHeader& group, ContainerWriter& writer) {
  for (const Animated& a : animated_) {
    const AttributeGroupHeader header{group.shot, a.index, group.first_frame, group.frame_count};
    std::vector<uint8_t> sections;
    if (Status s =
            a.encoder.encode_group(header, group.first_frame - first_frame_, options_, sections);
        !s.ok())
      return s;
    if (Status s = writer.attribute_group(header, sections); !s.ok()) return s;
  }
  return {};
}

/// Frames of a finished file, decoded when first asked for.
class DecodedFrames {
 public:
  explicit DecodedFrames(std::span<const uint8_t> file) : file_(file) {}

  /// Empty where it does not decode, which a finished file does.
  std::span<const float> frame(uint32_t t) {
    DecodeOptions options;
    options.limits = kNoLimits;
    if (decoder_ == nullptr && !Decoder::open(file_, options, decoder_).ok()) return {};
    const Connectivity* faces = nullptr;
    if (!decoder_->connectivity(t, faces).ok()) return {};
    xyz_.resize(size_t{faces->vertex_count} * 3);
    return decoder_->decode_frame(t, xyz_.data()).ok() ? std::span<const float>(xyz_)
                                                       : std::span<const float>();
  }

 private:
  std::span<const uint8_t> file_;
  std::unique_ptr<Decoder> decoder_;
  std::vector<float> xyz_;
};

Status write_shot(const Shot& shot, const ContainerReader& container, size_t index,
                  const AnimatedOptions& options, DecodedFrames& frames, ContainerWriter& writer) {
  const ReferenceChunk& reference = container.references[index];
  ShotAttributes attributes(
      shot, options, [&](uint32_t t) { return frames.frame(reference.header.first_frame + t); });
  if (Status s = writer.reference(reference.header, reference.mesh); !s.ok()) return s;
  if (Status s = attributes.write(reference, writer); !s.ok()) return s;
  for (const GroupChunk& group : container.groups) {
    if (group.header.shot != reference.header.shot) continue;
    if (Status s = writer.group(group.header, group); !s.ok()) return s;
    if (Status s = attributes.write_group(group.header, writer); !s.ok()) return s;
  }
  return {};
}

}  // namespace

bool has_attributes(const Sequence& sequence) {
  for (const Shot& shot : sequence.shots) {
    if (!shot.attributes.empty()) return true;
  }
  return !sequence.resources.empty();
}

Status check_attributes(const Sequence& sequence) {
  for (const Shot& shot : sequence.shots) {
    if (shot.attributes.size() > kMaxAttributes)
      return Status::invalid("a shot has more than 256 attributes");
    for (const Attribute& a : shot.attributes) {
      if (Status s = check_attribute(shot, a); !s.ok()) return s;
    }
  }
  return {};
}

Status attach_attributes(const Sequence& sequence, const AnimatedOptions& options,
                         std::vector<uint8_t>& file) {
  ContainerReader container;
  if (Status s = container.parse(file, kNoLimits); !s.ok()) return s;
  std::vector<uint8_t> out;
  DecodedFrames frames(file);
  ContainerWriter writer(out);
  if (Status s = writer.begin(container.header); !s.ok()) return s;
  if (Status s = writer.metadata(container.metadata); !s.ok()) return s;
  if (options.bounds) {
    GroupBoxes boxes;
    if (Status s = find_bounds(file, options.threads, boxes); !s.ok()) return s;
    if (Status s = writer.bounds(boxes); !s.ok()) return s;
  }
  for (const Resource& r : sequence.resources) {
    if (Status s = writer.resource({r.name, r.media_type}, r.bytes); !s.ok()) return s;
  }
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    if (Status s = write_shot(sequence.shots[i], container, i, options, frames, writer); !s.ok())
      return s;
  }
  if (Status s = writer.finish(); !s.ok()) return s;
  file = std::move(out);
  return {};
}

}  // namespace reeb
