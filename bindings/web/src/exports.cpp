// What JavaScript calls: one decoder an instance, numbers and texts left where it finds them.
//
// Calls give a reeb_result. Whatever they tell is in `numbers` then; pointers are numbers, too.
#include <cstdint>
#include <cstring>

#include "reeb.h"
#include "reeb_attributes.h"

#define EXPORT(name) __attribute__((export_name(#name))) web_##name  // libc has a close, too

namespace {

reeb_decoder* decoder = nullptr;
double numbers[24];
char message[512];

template <class... Values>
void tell(Values... values) {
  double* out = numbers;
  ((*out++ = static_cast<double>(values)), ...);
}

double address(const void* pointer) {
  return static_cast<double>(reinterpret_cast<uintptr_t>(pointer));
}

reeb_options options(double max_memory) {
  reeb_options o = {};
  o.struct_size = sizeof o;
  o.limits.max_memory = static_cast<uint64_t>(max_memory);
  o.message = message;
  o.message_size = sizeof message;
  return o;
}

/// A struct of the interface, ready to be filled.
template <class Struct>
Struct sized() {
  Struct s = {};
  s.struct_size = sizeof s;
  return s;
}

reeb_target target(float* positions, float* normals, uint32_t capacity) {
  auto t = sized<reeb_target>();
  t.positions = positions;
  t.normals = normals;
  t.vertex_capacity = capacity;
  return t;
}

}  // namespace

extern "C" {

/// Copies bytes of the file; not 0 where they are not there (yet).
__attribute__((import_module("reeb"), import_name("read"))) int reeb_read(double offset,
                                                                          void* buffer,
                                                                          size_t count);

double* EXPORT(numbers_at)() { return numbers; }

/// The sentence about the last failure.
const char* EXPORT(message_at)() {
  if (decoder != nullptr) reeb_get_message(decoder, message, sizeof message);
  return message;
}

int EXPORT(open_memory)(const uint8_t* bytes, uint32_t size, double max_memory) {
  const reeb_options o = options(max_memory);
  return reeb_open_memory(bytes, size, &o, &decoder);
}

int EXPORT(open_push)(double max_memory) {
  const reeb_options o = options(max_memory);
  return reeb_open_push(&o, &decoder);
}

/// Bytes come by `reeb_read`, or a call that needs them ends with REEB_IO.
int EXPORT(open_reader)(double size, double max_memory) {
  const reeb_options o = options(max_memory);
  reeb_reader reader = {};
  reader.size = static_cast<uint64_t>(size);
  reader.read_at = [](void*, uint64_t offset, void* buffer, size_t count) {
    return reeb_read(static_cast<double>(offset), buffer, count);
  };
  return reeb_open_reader(&reader, &o, &decoder);
}

int EXPORT(push)(const uint8_t* bytes, uint32_t size) { return reeb_push(decoder, bytes, size); }
int EXPORT(push_end)() { return reeb_push_end(decoder); }

void EXPORT(close)() {
  reeb_close(decoder);
  decoder = nullptr;
  message[0] = '\0';
}

int EXPORT(info)() {
  auto i = sized<reeb_info>();
  const reeb_result result = reeb_get_info(decoder, &i);
  tell(i.format_version, i.frame_count, i.total_frames, i.shot_count, i.group_count,
       i.metadata_count, i.gap_count, i.max_vertices, i.truncated, i.frame_rate, i.start_time,
       i.file_bytes);
  return result;
}

int EXPORT(shot)(uint32_t index) {
  auto s = sized<reeb_shot>();
  const reeb_result result = reeb_get_shot(decoder, index, &s);
  tell(s.first_frame, s.end_frame, s.frame_count, s.vertex_count, s.face_count, s.order_kept);
  return result;
}

int EXPORT(group)(uint32_t index) {
  auto g = sized<reeb_group>();
  const reeb_result result = reeb_get_group(decoder, index, &g);
  tell(g.first_frame, g.frame_count, g.shot, g.component_count, g.region_count, g.bytes);
  return result;
}

int EXPORT(gap)(uint32_t index) {
  uint32_t first = 0, count = 0;
  const reeb_result result = reeb_get_gap(decoder, index, &first, &count);
  tell(first, count);
  return result;
}

int EXPORT(metadata)(uint32_t index) {
  const char *key = nullptr, *value = nullptr;
  const reeb_result result = reeb_get_metadata(decoder, index, &key, &value);
  tell(address(key), address(value));
  return result;
}

int EXPORT(bounds)(uint32_t group) {
  float low[3] = {}, high[3] = {};
  const reeb_result result = reeb_get_bounds(decoder, group, low, high);
  tell(low[0], low[1], low[2], high[0], high[1], high[2]);
  return result;
}

int EXPORT(triangles)(uint32_t frame) {
  const uint32_t* indices = nullptr;
  size_t count = 0;
  const reeb_result result = reeb_get_triangles(decoder, frame, &indices, &count);
  tell(address(indices), count);
  return result;
}

int EXPORT(polygons)(uint32_t frame) {
  const uint32_t *sizes = nullptr, *corners = nullptr;
  size_t faces = 0, count = 0;
  const reeb_result result = reeb_get_polygons(decoder, frame, &sizes, &faces, &corners, &count);
  tell(address(sizes), faces, address(corners), count);
  return result;
}

/// `normals` 0: not wanted.
int EXPORT(frame)(uint32_t index, float* positions, float* normals, uint32_t capacity) {
  const reeb_target t = target(positions, normals, capacity);
  return reeb_get_frame(decoder, index, &t);
}

int EXPORT(between)(double position, float* positions, float* normals, uint32_t capacity) {
  const reeb_target t = target(positions, normals, capacity);
  return reeb_get_between(decoder, position, &t);
}

int EXPORT(position_of_time)(double seconds, int loop) {
  double position = 0;
  const reeb_result result = reeb_position_of_time(decoder, seconds, loop, &position);
  tell(position);
  return result;
}

int EXPORT(attribute_count)() {
  uint32_t count = 0;
  const reeb_result result = reeb_get_attribute_count(decoder, &count);
  tell(count);
  return result;
}

int EXPORT(attribute)(uint32_t number) {
  auto a = sized<reeb_attribute>();
  const reeb_result result = reeb_get_attribute(decoder, number, &a);
  tell(a.shot, a.index, address(a.name), a.semantic, a.domain, a.type, a.channels, a.animated,
       a.computed, a.bytes);
  return result;
}

int EXPORT(values)(uint32_t frame, uint32_t index, uint8_t* out, uint32_t elements) {
  auto t = sized<reeb_value_target>();
  t.values = out;
  t.element_capacity = elements;
  return reeb_get_values(decoder, frame, index, &t);
}

/// The name of entry `entry`, cut to `size` bytes, is at `out`.
int EXPORT(name)(uint32_t frame, uint32_t index, uint32_t entry, char* out, uint32_t size) {
  size_t length = 0;
  const reeb_result result = reeb_get_name(decoder, frame, index, entry, out, size, &length);
  tell(length);
  return result;
}

int EXPORT(resource_count)() {
  uint32_t count = 0;
  const reeb_result result = reeb_get_resource_count(decoder, &count);
  tell(count);
  return result;
}

int EXPORT(resource)(uint32_t index) {
  const char *name = nullptr, *media_type = nullptr;
  const reeb_result result = reeb_get_resource(decoder, index, &name, &media_type);
  tell(address(name), address(media_type));
  return result;
}

int EXPORT(resource_bytes)(uint32_t index, uint8_t* out, uint32_t size) {
  size_t length = 0;
  const reeb_result result = reeb_get_resource_bytes(decoder, index, out, size, &length);
  tell(length);
  return result;
}

int EXPORT(make_render_mesh)(uint32_t frame, const uint32_t* split_by, uint32_t split_count) {
  reeb_render_mesh* mesh = nullptr;
  const reeb_result result = reeb_make_render_mesh(decoder, frame, split_by, split_count, &mesh);
  tell(address(mesh));
  return result;
}

void EXPORT(free_render_mesh)(reeb_render_mesh* mesh) { reeb_free_render_mesh(mesh); }

int EXPORT(render_info)(const reeb_render_mesh* mesh) {
  auto i = sized<reeb_render_info>();
  const reeb_result result = reeb_get_render_info(mesh, &i);
  tell(i.shot, i.vertex_count, address(i.source_vertices), address(i.source_corners),
       i.triangle_count, address(i.indices), address(i.source_faces), i.range_count,
       i.material_attribute);
  return result;
}

int EXPORT(render_range)(const reeb_render_mesh* mesh, uint32_t range) {
  int64_t material = 0;
  size_t first = 0, count = 0;
  const reeb_result result = reeb_get_render_range(mesh, range, &material, &first, &count);
  tell(material, first, count);
  return result;
}

int EXPORT(render_frame)(uint32_t index, float* positions, float* normals, uint32_t capacity,
                         const reeb_render_mesh* mesh) {
  const reeb_target t = target(positions, normals, capacity);
  return reeb_get_render_frame(decoder, index, mesh, &t);
}

int EXPORT(render_between)(double position, float* positions, float* normals, uint32_t capacity,
                           const reeb_render_mesh* mesh) {
  const reeb_target t = target(positions, normals, capacity);
  return reeb_get_render_between(decoder, position, mesh, &t);
}

int EXPORT(render_values)(uint32_t frame, uint32_t index, uint8_t* out, uint32_t elements,
                          const reeb_render_mesh* mesh) {
  auto t = sized<reeb_value_target>();
  t.values = out;
  t.element_capacity = elements;
  return reeb_get_render_values(decoder, frame, index, mesh, &t);
}

}  // extern "C"
