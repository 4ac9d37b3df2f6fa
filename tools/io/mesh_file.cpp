#include "tools/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "tools/text.h"

namespace reeb::tools {
namespace {

Status read_format(std::string_view bytes, MeshFormat format, const MeshReference* reference,
                   MeshFrame& out) {
  switch (format) {
    case MeshFormat::kObj:
      return read_obj(bytes, reference, out);
    case MeshFormat::kPly:
      return read_ply(bytes, out);
    case MeshFormat::kOff:
      return read_off(bytes, out);
    case MeshFormat::kStl:
      return read_stl(bytes, reference, out);
  }
  return Status::invalid("unknown format");
}

Status check_finite(const std::vector<float>& positions) {
  const auto bad = std::find_if_not(positions.begin(), positions.end(),
                                    [](float x) { return std::isfinite(x); });
  if (bad == positions.end()) return {};
  const auto index = static_cast<uint64_t>(bad - positions.begin());
  return Status::corrupt("coordinate " + std::string(1, "xyz"[index % 3]) + " of vertex " +
                         grouped(index / 3 + 1) +
                         " is not a finite float32 number; repair the frame or leave it out");
}

Status check_corners(const Connectivity& connectivity) {
  size_t corner = 0;
  for (size_t face = 0; face < connectivity.face_sizes.size(); ++face) {
    for (uint32_t i = 0; i < connectivity.face_sizes[face]; ++i, ++corner) {
      const uint32_t v = connectivity.corners[corner];
      if (v < connectivity.vertex_count) continue;
      return Status::corrupt("face " + grouped(face + 1) + " uses vertex " +
                             grouped(uint64_t{v} + 1) + " of " +
                             grouped(connectivity.vertex_count) +
                             "; the file is truncated or damaged, export it again");
    }
  }
  return {};
}

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::optional<MeshFormat> mesh_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".off") return MeshFormat::kOff;
  if (extension == ".stl") return MeshFormat::kStl;
  return std::nullopt;
}

void MeshFrame::zero_not_finite(const std::string& name, std::vector<float>& values) {
  const auto bad = static_cast<uint64_t>(
      std::count_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x); }));
  if (bad == 0) return;
  for (float& x : values) x = std::isfinite(x) ? x : 0;
  notes.push_back(counted(bad, "number") + " of \"" + name + "\" not finite, taken as 0");
}

Status read_mesh(std::string_view bytes, MeshFormat format, const MeshReference* reference,
                 MeshFrame& out) {
  out = MeshFrame();
  Status status = read_format(bytes, format, reference, out);
  if (!status.ok()) return status;
  if (out.positions.empty()) {
    return Status::corrupt(
        "the mesh has no vertices, and a sequence has no empty frames; leave it out");
  }
  if (!out.remainders.empty()) out.remainders.resize(out.positions.size());
  if (out.positions.size() / 3 > UINT32_MAX) {
    return Status::corrupt("more than 4,294,967,295 vertices; split the mesh");
  }
  status = check_finite(out.positions);
  if (status.ok() && !out.same_connectivity) status = check_corners(out.connectivity);
  if (!status.ok()) return status;
  if (reference != nullptr && !out.same_connectivity) {
    out.same_connectivity = out.connectivity == reference->connectivity;
  }
  if (out.same_connectivity) out.connectivity = Connectivity();
  return {};
}

}  // namespace reeb::tools
