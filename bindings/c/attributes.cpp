#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "bindings/c/handle.h"
#include "reeb_attributes.h"

struct reeb_render_mesh {
  std::unique_ptr<const reeb::RenderMesh> mesh;
};

namespace {

using reeb::Semantic;
using reeb::Status;
using reeb::StreamInfo;
using reeb_c::adopt;
using reeb_c::give;
using reeb_c::make_target;
using reeb_c::with_info;

static_assert(static_cast<int>(Semantic::kTextureCoordinate) == REEB_SEMANTIC_TEXTURE_COORDINATE);
static_assert(static_cast<int>(Semantic::kNormal) == REEB_SEMANTIC_NORMAL);
static_assert(static_cast<int>(Semantic::kTangent) == REEB_SEMANTIC_TANGENT);
static_assert(static_cast<int>(Semantic::kColour) == REEB_SEMANTIC_COLOUR);
static_assert(static_cast<int>(Semantic::kVelocity) == REEB_SEMANTIC_VELOCITY);
static_assert(static_cast<int>(Semantic::kMaterial) == REEB_SEMANTIC_MATERIAL);
static_assert(static_cast<int>(Semantic::kGroup) == REEB_SEMANTIC_GROUP);
static_assert(static_cast<int>(Semantic::kIndex) == REEB_SEMANTIC_INDEX);
static_assert(static_cast<int>(reeb::Domain::kCorner) == REEB_DOMAIN_CORNER);
static_assert(static_cast<int>(reeb::Domain::kFace) == REEB_DOMAIN_FACE);
static_assert(static_cast<int>(reeb::Domain::kShot) == REEB_DOMAIN_SHOT);
static_assert(static_cast<int>(reeb::ValueType::kU8) == REEB_TYPE_U8);
static_assert(static_cast<int>(reeb::ValueType::kU16) == REEB_TYPE_U16);
static_assert(static_cast<int>(reeb::ValueType::kI32) == REEB_TYPE_I32);
static_assert(static_cast<int>(reeb::ValueType::kU8Normalised) == REEB_TYPE_U8_NORMALISED);
static_assert(static_cast<int>(reeb::ValueType::kU16Normalised) == REEB_TYPE_U16_NORMALISED);

/// The index of the first attribute of the shot of `frame` that `matches`.
template <class Matches>
reeb_result find_index(reeb_decoder* d, uint32_t frame, uint32_t* index, Matches&& matches) {
  return with_info(d, [&](const StreamInfo& info) {
    if (index == nullptr || frame >= info.total_frames) return REEB_INVALID_ARGUMENT;
    const auto after = std::upper_bound(
        info.shots.begin(), info.shots.end(), frame,
        [](uint32_t f, const StreamInfo::ShotInfo& shot) { return f < shot.first_frame; });
    if (after == info.shots.begin()) return REEB_INVALID_ARGUMENT;
    const auto shot = static_cast<uint32_t>(after - info.shots.begin()) - 1;
    for (const StreamInfo::AttributeInfo& a : info.attributes) {
      if (a.header.shot != shot || !matches(a.header)) continue;
      *index = a.header.index;
      return REEB_OK;
    }
    return REEB_INVALID_ARGUMENT;
  });
}

bool make_target(const reeb_value_target* in, reeb::ValueTarget& out) {
  reeb_value_target own = {};
  if (!adopt(in, own)) return false;
  out = {static_cast<uint8_t*>(own.values), own.stride, own.element_capacity};
  return true;
}

reeb_result get_values(reeb_decoder* d, uint32_t frame, uint32_t index,
                       const reeb::RenderMesh* mesh, const reeb_value_target* target) {
  reeb::ValueTarget own;
  if (!make_target(target, own)) return d->invalid("no target, or one without its struct_size");
  return d->done(d->decoder->decode_values(frame, index, mesh, own));
}

template <class Decode>
reeb_result with_target(reeb_decoder* d, const reeb_render_mesh* mesh, const reeb_target* target,
                        Decode&& decode) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  reeb::FrameTarget own;
  if (mesh == nullptr || !make_target(target, own))
    return d->invalid("no mesh, no target, or one without its struct_size");
  return d->done(decode(own));
}

}  // namespace

reeb_result reeb_get_attribute_count(reeb_decoder* d, uint32_t* count) {
  return with_info(d, [&](const StreamInfo& info) {
    if (count == nullptr) return REEB_INVALID_ARGUMENT;
    *count = static_cast<uint32_t>(info.attributes.size());
    return REEB_OK;
  });
}

reeb_result reeb_get_attribute(reeb_decoder* d, uint32_t number, reeb_attribute* out) {
  return with_info(d, [&](const StreamInfo& info) {
    if (number >= info.attributes.size()) return REEB_INVALID_ARGUMENT;
    const auto& [h, bytes] = info.attributes[number];
    return give({0, h.shot, h.index, h.name.c_str(), static_cast<uint32_t>(h.semantic),
                 static_cast<uint32_t>(h.domain), static_cast<uint32_t>(h.type), h.channel_count,
                 h.animated() ? 1 : 0, h.computed() ? 1 : 0, bytes},
                out);
  });
}

reeb_result reeb_find_attribute(reeb_decoder* d, uint32_t frame, const char* name,
                                uint32_t* index) {
  if (name == nullptr) return REEB_INVALID_ARGUMENT;
  return find_index(d, frame, index,
                    [&](const reeb::AttributeHeader& h) { return h.name == name; });
}

reeb_result reeb_find_semantic(reeb_decoder* d, uint32_t frame, reeb_semantic semantic,
                               uint32_t* index) {
  return find_index(d, frame, index, [&](const reeb::AttributeHeader& h) {
    return static_cast<int>(h.semantic) == static_cast<int>(semantic);
  });
}

reeb_result reeb_get_name(reeb_decoder* d, uint32_t frame, uint32_t index, uint32_t entry,
                          char* buffer, size_t size, size_t* length) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  std::string name;
  const reeb_result result = d->done(d->decoder->attribute_name(frame, index, entry, name));
  if (result != REEB_OK) return result;
  if (length != nullptr) *length = name.size();
  reeb_c::copy_text(name, buffer, size);
  return REEB_OK;
}

reeb_result reeb_get_values(reeb_decoder* d, uint32_t frame, uint32_t index,
                            const reeb_value_target* target) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  return get_values(d, frame, index, nullptr, target);
}

reeb_result reeb_get_resource_count(reeb_decoder* d, uint32_t* count) {
  return with_info(d, [&](const StreamInfo& info) {
    if (count == nullptr) return REEB_INVALID_ARGUMENT;
    *count = static_cast<uint32_t>(info.resources.size());
    return REEB_OK;
  });
}

reeb_result reeb_get_resource(reeb_decoder* d, uint32_t resource, const char** name,
                              const char** media_type) {
  return with_info(d, [&](const StreamInfo& info) {
    if (resource >= info.resources.size() || name == nullptr || media_type == nullptr)
      return REEB_INVALID_ARGUMENT;
    *name = info.resources[resource].header.name.c_str();
    *media_type = info.resources[resource].header.media_type.c_str();
    return REEB_OK;
  });
}

reeb_result reeb_get_resource_bytes(reeb_decoder* d, uint32_t resource, void* buffer, size_t size,
                                    size_t* length) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  const std::span room(static_cast<uint8_t*>(buffer), buffer != nullptr ? size : 0);
  size_t all = 0;
  const reeb_result result = d->done(d->decoder->copy_resource(resource, room, all));
  if (result == REEB_OK && length != nullptr) *length = all;
  return result;
}

reeb_result reeb_get_bounds(reeb_decoder* d, uint32_t group, float low[3], float high[3]) {
  return with_info(d, [&](const StreamInfo& info) {
    if (group >= info.bounds.size() || low == nullptr || high == nullptr)
      return REEB_INVALID_ARGUMENT;
    std::copy_n(info.bounds[group].low, 3, low);
    std::copy_n(info.bounds[group].high, 3, high);
    return REEB_OK;
  });
}

reeb_result reeb_get_frames(reeb_decoder* d, uint32_t first, uint32_t count, float* positions,
                            size_t frame_stride) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  return d->done(d->decoder->decode_frames(first, count, positions, frame_stride));
}

reeb_result reeb_make_render_mesh(reeb_decoder* d, uint32_t frame, const uint32_t* split_by,
                                  size_t split_count, reeb_render_mesh** mesh) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  if (mesh == nullptr || (split_by == nullptr && split_count > 0))
    return d->invalid("no place for the mesh, or no attributes to split by");
  *mesh = nullptr;
  std::unique_ptr<const reeb::RenderMesh> made;
  const Status status = d->decoder->make_render_mesh(frame, {split_by, split_count}, made);
  if (!status.ok()) return d->done(status);
  *mesh = new (std::nothrow) reeb_render_mesh{std::move(made)};
  return *mesh != nullptr ? REEB_OK : d->done(Status::out_of_memory());
}

void reeb_free_render_mesh(reeb_render_mesh* mesh) { delete mesh; }

reeb_result reeb_get_render_info(const reeb_render_mesh* mesh, reeb_render_info* info) {
  if (mesh == nullptr) return REEB_INVALID_ARGUMENT;
  const reeb::RenderMesh& m = *mesh->mesh;
  return give({0, m.shot, m.vertex_count(), m.source_vertex.data(), m.source_corner.data(),
               m.triangles.size() / 3, m.triangles.data(), m.source_face.data(), m.ranges.size(),
               m.material_attribute},
              info);
}

reeb_result reeb_get_render_range(const reeb_render_mesh* mesh, size_t range, int64_t* material,
                                  size_t* first, size_t* count) {
  if (mesh == nullptr || range >= mesh->mesh->ranges.size() || material == nullptr ||
      first == nullptr || count == nullptr)
    return REEB_INVALID_ARGUMENT;
  const reeb::RenderMesh::Range& r = mesh->mesh->ranges[range];
  *material = r.material;
  *first = r.first;
  *count = r.count;
  return REEB_OK;
}

reeb_result reeb_get_render_frame(reeb_decoder* d, uint32_t frame, const reeb_render_mesh* mesh,
                                  const reeb_target* target) {
  return with_target(d, mesh, target, [&](const reeb::FrameTarget& own) {
    return d->decoder->decode_frame(frame, *mesh->mesh, own);
  });
}

reeb_result reeb_get_render_between(reeb_decoder* d, double position, const reeb_render_mesh* mesh,
                                    const reeb_target* target) {
  return with_target(d, mesh, target, [&](const reeb::FrameTarget& own) {
    return d->decoder->decode_at(position, *mesh->mesh, own);
  });
}

reeb_result reeb_get_render_values(reeb_decoder* d, uint32_t frame, uint32_t index,
                                   const reeb_render_mesh* mesh, const reeb_value_target* target) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  if (mesh == nullptr) return d->invalid("no mesh");
  return get_values(d, frame, index, mesh->mesh.get(), target);
}
