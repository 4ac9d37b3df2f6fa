// The readers of foreign files: the first byte chooses the format, the rest is the file.
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "tools/io/material_files.h"
#include "tools/io/mesh_file.h"
#include "tools/io/point_cache.h"

namespace {

using namespace reeb;
using namespace reeb::tools;

void require(bool good) {
  if (!good) __builtin_trap();
}

void check(const Connectivity& c, const MeshFrame& mesh) {
  require(mesh.positions.size() == size_t{3} * c.vertex_count);
  require(mesh.remainders.empty() || mesh.remainders.size() == mesh.positions.size());
  size_t corners = 0;
  for (const uint32_t size : c.face_sizes) {
    require(size > 0);
    corners += size;
  }
  require(corners == c.corners.size());
  for (const uint32_t v : c.corners) require(v < c.vertex_count);
  for (const float x : mesh.positions) require(std::isfinite(x));
  for (const Attribute& a : mesh.attributes) {
    const size_t elements = Shot{c, 1, {}}.element_count(a.domain);
    require(!a.animated && a.values.size() == elements * a.element_bytes());
    if (a.type != ValueType::kBinary32) continue;
    for (size_t i = 0; i < elements * a.channel_count; ++i) require(std::isfinite(a.get<float>(i)));
  }
}

size_t channels(const std::vector<Attribute>& attributes) {
  size_t out = 0;
  for (const Attribute& a : attributes) out += a.channel_count;
  return out;
}

// Names change where they would break a line; and of PLY, neighbours may become one.
void check_attributes(const MeshFrame& mesh, const MeshFrame& back, MeshFormat format) {
  require(channels(mesh.attributes) == channels(back.attributes));
  if (format == MeshFormat::kPly) return;
  require(mesh.attributes.size() == back.attributes.size());
  for (size_t i = 0; i < mesh.attributes.size(); ++i) {
    require(mesh.attributes[i].name == back.attributes[i].name);
    if (mesh.attributes[i].names.empty()) require(mesh.attributes[i] == back.attributes[i]);
  }
}

// Read again as a further frame it is the same, and so is what is written of it.
void read_as_mesh(std::string_view bytes, MeshFormat format) {
  MeshFrame mesh;
  if (!read_mesh(bytes, format, nullptr, mesh).ok()) return;
  check(mesh.connectivity, mesh);
  const MeshReference reference{mesh.connectivity, std::string(mesh.face_text), mesh.obj_faces};
  MeshFrame again;
  require(read_mesh(bytes, format, &reference, again).ok());
  require(again.same_connectivity && again.positions == mesh.positions);
  require(again.attributes == mesh.attributes);
  if (format == MeshFormat::kStl) return;  // polygons and isolated vertices do not fit into it
  std::vector<std::string> unkept;
  const std::string written =
      write_mesh(mesh.connectivity, mesh.positions, format, mesh.attributes, &unkept);
  MeshFrame back;
  require(read_mesh(written, format, nullptr, back).ok());
  require(back.connectivity == mesh.connectivity && back.positions == mesh.positions);
  require(back.remainders.empty() && back.unkept.empty() && back.notes.empty());
  if (unkept.empty()) check_attributes(mesh, back, format);
}

void read_as_cache(std::string_view bytes, CacheFormat format) {
  if (bytes.empty()) return;  // which fmemopen does not open
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"), std::fclose);
  PointCache cache;
  if (!read_point_cache(file.get(), bytes.size(), "fuzz", format, cache).ok()) return;
  require(cache.positions.size() == uint64_t{3} * cache.point_count * cache.frame_count);
  for (const float x : cache.positions) require(std::isfinite(x));
  require(std::isfinite(cache.start_time) && std::isfinite(cache.frame_rate) &&
          cache.frames_per_sample > 0);
}

// Names are parts of single lines.
void read_as_material(std::string_view bytes) {
  for (const std::string& name : textures_of(bytes))
    require(!name.empty() && bytes.find(name) != bytes.npos &&
            name.find_first_of("\r\n") == name.npos);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 7) {
    case 0:
      read_as_mesh(bytes, MeshFormat::kObj);
      break;
    case 1:
      read_as_mesh(bytes, MeshFormat::kPly);
      break;
    case 2:
      read_as_mesh(bytes, MeshFormat::kOff);
      break;
    case 3:
      read_as_mesh(bytes, MeshFormat::kStl);
      break;
    case 4:
      read_as_cache(bytes, CacheFormat::kPc2);
      break;
    case 5:
      read_as_cache(bytes, CacheFormat::kMdd);
      break;
    default:
      read_as_material(bytes);
  }
  return 0;
}
