/**
 * @file reeb_attributes.hpp
 * What streams of reeb.hpp carry beside positions, and meshes for rendering: owners around the
 * functions of reeb_attributes.h, which says what everything does.
 */
#ifndef REEB_ATTRIBUTES_HPP
#define REEB_ATTRIBUTES_HPP

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reeb.hpp"
#include "reeb_attributes.h"

namespace reeb {

/** All attributes of a stream, shot after shot. */
inline std::vector<reeb_attribute> attributes(const Stream& stream) {
  uint32_t count = 0;
  (void)reeb_get_attribute_count(stream.get(), &count);
  std::vector<reeb_attribute> out(count);
  for (uint32_t i = 0; i < count; ++i) {
    out[i].struct_size = sizeof out[i];
    (void)reeb_get_attribute(stream.get(), i, &out[i]);
  }
  return out;
}

/** Bytes of a number; 0 of an unknown type. */
inline size_t size_of_type(uint32_t type) {
  switch (type) {
    case REEB_TYPE_BINARY32:
    case REEB_TYPE_I32:
      return 4;
    case REEB_TYPE_U16:
    case REEB_TYPE_U16_NORMALISED:
      return 2;
    case REEB_TYPE_U8:
    case REEB_TYPE_U8_NORMALISED:
      return 1;
    default:
      return 0;
  }
}

/** The values of an attribute in a frame, numbers of type `T`, which must have the size of the
 * attribute's own; `elements`: of its domain in the shot. */
template <class T>
[[nodiscard]] reeb_result values(Stream& stream, uint32_t frame, const reeb_attribute& attribute,
                                 size_t elements, std::vector<T>& out) {
  if (sizeof(T) != size_of_type(attribute.type)) return REEB_INVALID_ARGUMENT;
  out.resize(elements * attribute.channels);
  const reeb_value_target target = {sizeof target, out.data(), 0, elements};
  return reeb_get_values(stream.get(), frame, attribute.index, &target);
}

/** What a value of an attribute is called; empty where it has no name. */
inline std::string name_of_value(Stream& stream, uint32_t frame, uint32_t index, uint32_t entry) {
  size_t length = 0;
  if (reeb_get_name(stream.get(), frame, index, entry, nullptr, 0, &length) != REEB_OK) return {};
  std::string out(length, '\0');
  (void)reeb_get_name(stream.get(), frame, index, entry, out.data(), length + 1, nullptr);
  return out;
}

/** A file that travels along. */
struct StreamResource {
  std::string name, media_type;
  std::vector<uint8_t> bytes;
};

[[nodiscard]] inline reeb_result resource(Stream& stream, uint32_t index, StreamResource& out) {
  const char *name = nullptr, *media_type = nullptr;
  reeb_result result = reeb_get_resource(stream.get(), index, &name, &media_type);
  if (result != REEB_OK) return result;
  out.name = name;
  out.media_type = media_type;
  size_t length = 0;
  result = reeb_get_resource_bytes(stream.get(), index, nullptr, 0, &length);
  if (result != REEB_OK) return result;
  out.bytes.resize(length);
  return reeb_get_resource_bytes(stream.get(), index, out.bytes.data(), length, nullptr);
}

/** Frames `first` .. `first + count - 1` of one shot, one after another, xyz after xyz. */
[[nodiscard]] inline reeb_result frames(Stream& stream, uint32_t first, uint32_t count,
                                        uint32_t vertices, std::vector<float>& out) {
  const size_t frame_stride = size_t{3} * vertices;
  out.resize(frame_stride * count);
  return reeb_get_frames(stream.get(), first, count, out.data(), frame_stride);
}

/** A mesh for rendering; it must end before the stream closes. */
class StreamRenderMesh {
 public:
  struct Range {
    int64_t material;
    size_t first, count; /**< triangles */
  };

  /** In place of the mesh before. */
  [[nodiscard]] reeb_result make(Stream& stream, uint32_t frame,
                                 const std::vector<uint32_t>& split_by) {
    reeb_render_mesh* made = nullptr;
    const reeb_result result =
        reeb_make_render_mesh(stream.get(), frame, split_by.data(), split_by.size(), &made);
    mesh_.reset(made);
    return result;
  }
  explicit operator bool() const { return mesh_ != nullptr; }
  /** For the functions of reeb_attributes.h. */
  const reeb_render_mesh* get() const { return mesh_.get(); }

  /** All 0 where there is no mesh. */
  reeb_render_info info() const {
    reeb_render_info out = {};
    out.struct_size = sizeof out;
    (void)reeb_get_render_info(get(), &out);
    return out;
  }
  std::vector<Range> ranges() const {
    std::vector<Range> out(info().range_count);
    for (size_t i = 0; i < out.size(); ++i)
      (void)reeb_get_render_range(get(), i, &out[i].material, &out[i].first, &out[i].count);
    return out;
  }
  /** The pose at a position in frames: three floats for each render vertex. */
  [[nodiscard]] reeb_result between(Stream& stream, double position, std::vector<float>& positions,
                                    std::vector<float>* normals = nullptr) const {
    const reeb_target target = target_in(positions, normals, info().vertex_count);
    return reeb_get_render_between(stream.get(), position, get(), &target);
  }
  /** Values of an attribute, of each render vertex or, where it is one of faces, triangle. */
  template <class T>
  [[nodiscard]] reeb_result values(Stream& stream, uint32_t frame, const reeb_attribute& attribute,
                                   std::vector<T>& out) const {
    if (sizeof(T) != size_of_type(attribute.type)) return REEB_INVALID_ARGUMENT;
    const reeb_render_info mesh = info();
    const size_t elements = attribute.domain == REEB_DOMAIN_SHOT   ? 1
                            : attribute.domain == REEB_DOMAIN_FACE ? mesh.triangle_count
                                                                   : mesh.vertex_count;
    out.resize(elements * attribute.channels);
    const reeb_value_target target = {sizeof target, out.data(), 0, elements};
    return reeb_get_render_values(stream.get(), frame, attribute.index, get(), &target);
  }

 private:
  struct Free {
    void operator()(reeb_render_mesh* mesh) const { reeb_free_render_mesh(mesh); }
  };
  std::unique_ptr<reeb_render_mesh, Free> mesh_;
};

}  // namespace reeb

#endif
