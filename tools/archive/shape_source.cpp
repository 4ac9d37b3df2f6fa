#include "tools/archive/shape_source.h"

#include <algorithm>
#include <set>

#include "codec/common/mesh/faces.h"
#include "tools/io/mesh_file.h"
#include "tools/picture/contact_sheet.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

bool is_cache(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".pc2" || extension == ".mdd";
}

bool holds_shape(const fs::path& path) {
  return is_cache(path) || lower_extension(path) == ".reeb" || mesh_format(path).has_value();
}

Status add_folder(const fs::path& folder, std::set<fs::path>& files) {
  std::error_code error;
  fs::recursive_directory_iterator walk(folder, fs::directory_options::skip_permission_denied,
                                        error);
  for (; !error && walk != fs::recursive_directory_iterator(); walk.increment(error)) {
    std::error_code kind;
    if (walk->is_regular_file(kind) && holds_shape(walk->path())) files.insert(walk->path());
  }
  if (error) return Status::io(folder.string() + ": cannot be read: " + error.message());
  return {};
}

// A mesh beside its point cache is the sequence's.
void drop_meshes_of_caches(std::set<fs::path>& files) {
  std::set<fs::path> caches;
  for (const fs::path& file : files) {
    if (is_cache(file)) caches.insert(fs::path(file).replace_extension());
  }
  std::erase_if(files, [&](const fs::path& file) {
    return mesh_format(file).has_value() && caches.contains(fs::path(file).replace_extension());
  });
}

}  // namespace

Status find_shape_files(const std::vector<std::string>& inputs, std::vector<fs::path>& out) {
  std::set<fs::path> files;
  for (const std::string& input : inputs) {
    std::error_code error;
    const fs::path path = fs::absolute(input, error).lexically_normal();
    if (fs::is_directory(path, error)) {
      if (Status status = add_folder(path, files); !status.ok()) return status;
    } else if (!fs::is_regular_file(path, error)) {
      return Status::io(input + ": no such file or folder");
    } else if (!holds_shape(path)) {
      return Status::invalid(input + ": neither a mesh, a point cache nor a .reeb file");
    } else {
      files.insert(path);
    }
  }
  drop_meshes_of_caches(files);
  if (files.empty()) return Status::invalid("no mesh, point cache or .reeb file among the inputs");
  out.assign(files.begin(), files.end());
  return {};
}

ShapeFrame shape_frame(const Sequence& sequence, uint32_t frame) {
  for (const Shot& shot : sequence.shots) {
    if (frame < shot.frame_count) return {shot.frame(frame), fan_triangles(shot.connectivity)};
    frame -= shot.frame_count;
  }
  return {};
}

std::vector<SignedFrame> sign_frames(const Sequence& sequence, uint32_t count,
                                     std::string& complaint) {
  std::vector<SignedFrame> frames;
  for (const uint32_t frame : spread_frames(sequence.frame_count(), count)) {
    const ShapeFrame shape = shape_frame(sequence, frame);
    retrieval::Signed result = retrieval::sign(shape.positions, shape.triangles);
    if (!result.signature.empty())
      frames.push_back({frame + 1, std::move(result.signature)});
    else
      complaint = result.warnings.back();
  }
  return frames;
}

}  // namespace reeb::tools
