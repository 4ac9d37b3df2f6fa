// What a decoder gives beside frames: attributes, resources, the mesh as graphics interfaces take
// it.
#include <algorithm>
#include <cmath>

#include "codec/common/base/parallel.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/dec/decoder_impl.h"

namespace reeb {

namespace {

bool sorts_triangles(const AttributeHeader& h) {
  return h.semantic == Semantic::kMaterial && h.domain == Domain::kFace && !h.animated() &&
         h.channel_count == 1 && h.type != ValueType::kBinary32;
}

/// Corners of a vertex differ where a static attribute's values do; where an animated one's wedges
/// do.
CornerKeys corner_keys(const KeptAttribute& a) {
  if (!a.attribute.animated) return {a.attribute.values.data(), a.attribute.element_bytes()};
  return {reinterpret_cast<const uint8_t*>(a.surface.of_element.data()), sizeof(uint32_t)};
}

/// The elements that render vertices, or triangles, have their values from; nullptr: all.
const std::vector<uint32_t>* render_order(Domain domain, const RenderMesh& mesh) {
  return domain == Domain::kVertex   ? &mesh.source_vertex
         : domain == Domain::kCorner ? &mesh.source_corner
         : domain == Domain::kFace   ? &mesh.source_face
                                     : nullptr;
}

void gather(std::span<const float> from, const std::vector<uint32_t>& order, float* to,
            size_t stride) {
  for (size_t i = 0; i < order.size(); ++i)
    std::copy_n(&from[size_t{order[i]} * 3], 3, to + i * stride);
}

}  // namespace

Status Decoder::Impl::find_attribute(uint32_t frame, uint32_t index,
                                     std::shared_ptr<const KeptAttribute>& kept) {
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  const AttributeChunk* chunk = container.attribute(reference->header.shot, index);
  if (chunk == nullptr)
    return Status::invalid("attribute " + std::to_string(index) + " is not there, or is damaged");
  return attribute_store.get(*chunk, *reference, kept);
}

Status Decoder::Impl::decode_normals(uint32_t frame,
                                     const std::shared_ptr<const KeptAttribute>& kept,
                                     const StopToken& stop, SiteNumbers& out) {
  std::shared_ptr<ShotFaces> faces;
  if (Status s = faces_of(frame, faces); !s.ok()) return s;
  const size_t values = size_t{faces->connectivity.vertex_count} * 3;
  Lease lease;
  if (!lease.grow(account, values * sizeof(float)))
    return Status::limit("the normals need more memory than the limit allows");
  std::pmr::vector<float> xyz(values, memory);
  if (Status s = positions(frame, stop, {.positions = xyz.data()}, faces); !s.ok()) return s;
  SiteNumbers corrections;
  if (kept->header.in_groups()) {
    if (Status s = coded_numbers(frame, kept, stop, corrections); !s.ok()) return s;
  }
  return attribute_store.get_normals(kept, xyz, corrections, out);
}

Status Decoder::Impl::attribute_numbers(uint32_t frame,
                                        const std::shared_ptr<const KeptAttribute>& kept,
                                        const StopToken& stop, SiteNumbers& out) {
  if (!kept->attribute.animated) {
    AttributeStore::get_static(kept, out);
    return {};
  }
  return kept->header.computed() ? decode_normals(frame, kept, stop, out)
                                 : coded_numbers(frame, kept, stop, out);
}

Status Decoder::Impl::coded_numbers(uint32_t frame,
                                    const std::shared_ptr<const KeptAttribute>& kept,
                                    const StopToken& stop, SiteNumbers& out) {
  size_t group = 0;
  if (Status s = find_group(frame, group); !s.ok()) return s;
  const uint32_t first = container.groups[group].header.first_frame;
  const AttributeGroupChunk* part = container.attribute_group(first, kept->header.index);
  if (part == nullptr) {
    const std::string what = "attribute \"" + kept->attribute.name + "\" of " + frame_name(frame);
    if (!complete && group + 1 == container.groups.size())
      return {StatusCode::kNeedMoreData, what + " is still to come"};
    return Status::corrupt(what + " is damaged or cut off");
  }
  return attribute_store.get_frame(kept, *part, frame - first, resolve_threads(options.threads),
                                   stop, out);
}

Status Decoder::Impl::describe_attributes(uint32_t frame, std::vector<Attribute>& out,
                                          std::vector<uint32_t>& indices) {
  out.clear();
  indices.clear();
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  for (const AttributeChunk& a : container.attributes) {
    if (a.header.shot != reference->header.shot) continue;
    Attribute description;
    Status status = attribute_store.describe(a, description);
    if (status.code() == StatusCode::kCorrupt) continue;
    if (!status.ok()) return status;
    out.push_back(std::move(description));
    indices.push_back(a.header.index);
  }
  return {};
}

// The first attribute of the shot that sorts triangles, none where it is damaged.
Status Decoder::Impl::find_material(uint32_t frame, std::shared_ptr<const KeptAttribute>& kept) {
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  for (const AttributeChunk& a : container.attributes) {
    if (a.header.shot != reference->header.shot || !sorts_triangles(a.header)) continue;
    Status status = attribute_store.get(a, *reference, kept);
    if (status.code() != StatusCode::kCorrupt) return status;
  }
  return {};
}

Status Decoder::Impl::make_render_mesh(uint32_t frame, std::span<const uint32_t> split_by,
                                       std::unique_ptr<const RenderMesh>& out) {
  std::vector<std::shared_ptr<const KeptAttribute>> splitting(split_by.size());
  std::vector<CornerKeys> keys;
  for (size_t i = 0; i < split_by.size(); ++i) {
    if (Status s = find_attribute(frame, split_by[i], splitting[i]); !s.ok()) return s;
    if (splitting[i]->header.domain == Domain::kCorner) keys.push_back(corner_keys(*splitting[i]));
  }
  std::shared_ptr<const KeptAttribute> material;
  if (Status s = find_material(frame, material); !s.ok()) return s;
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  std::shared_ptr<ShotFaces> faces;
  if (Status s = store.get_faces(*reference, stop_now, faces); !s.ok()) return s;
  Lease lease;
  if (!lease.grow(account, render_mesh_memory(faces->connectivity)))
    return Status::limit("the render mesh needs more memory than the limit allows");
  auto made = std::make_unique<RenderMesh>(reeb::make_render_mesh(
      faces->connectivity, keys, material != nullptr ? &material->attribute : nullptr));
  if (material != nullptr) made->material_attribute = material->header.index;
  made->shot = reference->header.shot;
  lease.shrink(kept_memory(*made));
  made->lease = std::move(lease);
  out = std::move(made);
  return {};
}

Status Decoder::Impl::check_shot(uint32_t frame, const RenderMesh& mesh) const {
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  if (reference->header.shot == mesh.shot) return {};
  return Status::invalid("the render mesh is of another shot than " + frame_name(frame));
}

Status Decoder::Impl::render_frame(uint32_t frame, double share, const RenderMesh& mesh,
                                   const StopToken& stop, const FrameTarget& target) {
  if (Status s = check_target(target, mesh.vertex_count()); !s.ok()) return s;
  if (Status s = check_shot(frame, mesh); !s.ok()) return s;
  const size_t floats = size_t{mesh.shot_vertices} * 3;
  const size_t normal_floats = target.normals != nullptr ? floats : 0;
  Lease lease;
  if (!lease.grow(account, (floats + normal_floats) * sizeof(float)))
    return Status::limit("the frame needs more memory than the limit allows");
  std::pmr::vector<float> xyz(floats, memory), normals(normal_floats, memory);
  const FrameTarget own = {.positions = xyz.data(),
                           .normals = normal_floats > 0 ? normals.data() : nullptr};
  if (Status s = between(frame, share, stop, own); !s.ok()) return s;
  gather(xyz, mesh.source_vertex, target.positions, target.stride);
  if (normal_floats > 0) gather(normals, mesh.source_vertex, target.normals, target.normal_stride);
  return {};
}

Status Decoder::attributes(uint32_t frame, std::vector<Attribute>& out,
                           std::vector<uint32_t>& indices) {
  return impl_->run(
      [&](const StopToken&) { return impl_->describe_attributes(frame, out, indices); });
}

Status Decoder::decode_attribute(uint32_t frame, uint32_t index, Attribute& out) {
  return impl_->run([&](const StopToken& stop) -> Status {
    std::shared_ptr<const KeptAttribute> kept;
    if (Status s = impl_->find_attribute(frame, index, kept); !s.ok()) return s;
    SiteNumbers numbers;
    if (Status s = impl_->attribute_numbers(frame, kept, stop, numbers); !s.ok()) return s;
    out = kept->attribute;
    if (out.animated) append_numbers(numbers, out.values);
    return {};
  });
}

Status Decoder::decode_values(uint32_t frame, uint32_t index, const RenderMesh* mesh,
                              const ValueTarget& target) {
  return impl_->run([&](const StopToken& stop) -> Status {
    if (mesh != nullptr) {
      if (Status s = impl_->check_shot(frame, *mesh); !s.ok()) return s;
    }
    std::shared_ptr<const KeptAttribute> kept;
    if (Status s = impl_->find_attribute(frame, index, kept); !s.ok()) return s;
    SiteNumbers numbers;
    if (Status s = impl_->attribute_numbers(frame, kept, stop, numbers); !s.ok()) return s;
    return copy_numbers(
        numbers, mesh != nullptr ? render_order(kept->header.domain, *mesh) : nullptr, target);
  });
}

Status Decoder::attribute_name(uint32_t frame, uint32_t index, uint32_t entry, std::string& out) {
  return impl_->run([&](const StopToken&) -> Status {
    std::shared_ptr<const KeptAttribute> kept;
    if (Status s = impl_->find_attribute(frame, index, kept); !s.ok()) return s;
    const std::vector<std::string>& names = kept->attribute.names;
    if (entry >= names.size())
      return Status::invalid("attribute \"" + kept->attribute.name + "\" names " +
                             std::to_string(names.size()) + " values, not " +
                             std::to_string(uint64_t{entry} + 1));
    out = names[entry];
    return {};
  });
}

Status Decoder::make_render_mesh(uint32_t frame, std::span<const uint32_t> split_by,
                                 std::unique_ptr<const RenderMesh>& out) {
  return impl_->run(
      [&](const StopToken&) { return impl_->make_render_mesh(frame, split_by, out); });
}

Status Decoder::decode_frame(uint32_t frame, const RenderMesh& mesh, const FrameTarget& target) {
  return impl_->run(
      [&](const StopToken& stop) { return impl_->render_frame(frame, 0, mesh, stop, target); });
}

Status Decoder::decode_at(double time, const RenderMesh& mesh, const FrameTarget& target) {
  return impl_->run([&](const StopToken& stop) -> Status {
    if (Status s = impl_->check_time(time); !s.ok()) return s;
    const double whole = std::floor(time);
    return impl_->render_frame(static_cast<uint32_t>(whole), time - whole, mesh, stop, target);
  });
}

Status Decoder::resource(uint32_t index, Resource& out) {
  return impl_->run([&](const StopToken&) -> Status {
    const ResourceChunk* chunk = nullptr;
    if (Status s = impl_->find_resource(index, chunk); !s.ok()) return s;
    return impl_->attribute_store.get_resource(*chunk, out);
  });
}

Status Decoder::copy_resource(uint32_t index, std::span<uint8_t> buffer, size_t& length) {
  return impl_->run([&](const StopToken&) -> Status {
    const ResourceChunk* chunk = nullptr;
    if (Status s = impl_->find_resource(index, chunk); !s.ok()) return s;
    return impl_->attribute_store.copy_resource(*chunk, buffer, length);
  });
}

Status Decoder::Impl::find_resource(uint32_t index, const ResourceChunk*& chunk) const {
  if (index >= container.resources.size())
    return Status::invalid("there is no resource " + std::to_string(index));
  chunk = &container.resources[index];
  return {};
}

}  // namespace reeb
