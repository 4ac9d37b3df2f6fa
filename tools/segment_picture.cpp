#include "tools/segment_picture.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tools/io/file_bytes.h"
#include "tools/vec3.h"

extern char** environ;

namespace reeb::tools {
namespace {

constexpr double kGraphRadius = 0.008;  // of the mean of height and width of a mesh
constexpr double kMargin = 1.06;
constexpr uint32_t kMaxAspect = 4;  // of a tile, either way

Vec3 at(std::span<const float> positions, uint32_t v) {
  const float* p = &positions[3 * size_t{v}];
  return {p[0], p[1], p[2]};
}

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
  return out << '<' << v.x << ',' << v.y << ',' << v.z << '>';
}

std::vector<Vec3> normals_of(const std::vector<Vec3>& points, std::span<const uint32_t> triangles) {
  std::vector<Vec3> normals(points.size());
  for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Vec3& p = points[triangles[t]];
    const Vec3 normal = cross(points[triangles[t + 1]] - p, points[triangles[t + 2]] - p);
    for (size_t k = t; k < t + 3; ++k) normals[triangles[k]] += normal;
  }
  for (Vec3& n : normals) n = length(n) > 0 ? normalized(n) : Vec3{0, 0, 1};
  return normals;
}

// Writes the scene with the picture's axes as those of POV-Ray: x right, y up, z towards the eye.
class SceneWriter {
 public:
  SceneWriter(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
              const Camera& camera)
      : subject_(subject), frames_(frames), camera_(camera) {
    std::array<double, 2> half = {0, 0};
    for (const PictureFrame& frame : frames_) {
      const auto [right, up] = half_extent(frame.positions, camera_, box_centre(frame.positions));
      half = {std::max(half[0], right), std::max(half[1], up)};
    }
    const double least = 1e-3 * std::max({half[0], half[1], 1e-30});
    cell_width_ = 2 * kMargin * std::max(half[0], least);
    cell_height_ = 2 * kMargin * std::max(half[1], least);
  }

  PovrayScene run(uint32_t tile) {
    PovrayScene scene;
    scene.width = tile * static_cast<uint32_t>(frames_.size());
    const double height = std::min(tile * cell_height_ / cell_width_, 1e6);
    scene.height = std::clamp(static_cast<uint32_t>(height), tile / kMaxAspect, tile * kMaxAspect);
    add_camera(static_cast<double>(scene.width) / scene.height);
    declare_textures();
    for (size_t i = 0; i < frames_.size(); ++i) add_frame(i);
    scene.text = out_.str();
    return scene;
  }

 private:
  double row_width() const { return cell_width_ * static_cast<double>(frames_.size()); }

  Vec3 place(const Vec3& p, size_t frame, const Vec3& centre) const {
    const Vec3 d = p - centre;
    const double column = cell_width_ * (static_cast<double>(frame) + 0.5) - row_width() / 2;
    return {dot(d, camera_.right) + column, dot(d, camera_.up), dot(d, camera_.back)};
  }

  void add_camera(double aspect) {
    const double seen = std::max(row_width(), cell_height_ * aspect);
    const double far = 10 * (row_width() + cell_height_);
    out_ << "#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 40 }\n"
         << "background { rgb 1 }\n"
         << "camera { orthographic location <0,0," << far << "> direction <0,0,-1> up <0,"
         << seen / aspect << ",0> right <" << seen << ",0,0> }\n"
         << "light_source { <" << -far << ',' << 2 * far << ',' << 2 * far
         << "> rgb 0.9 parallel point_at 0 shadowless }\n"
         << "light_source { <" << far << ",0," << far
         << "> rgb 0.35 parallel point_at 0 shadowless }\n";
  }

  uint32_t region_count() const {
    const auto& labels = subject_.labels;
    return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  }

  void declare_textures() {
    for (uint32_t r = 0; r < region_count(); ++r) {
      const auto [red, green, blue] = region_colour(r);
      out_ << "#declare R" << r << " = texture { pigment { rgb " << Vec3{red, green, blue}
           << " transmit 0.35 } finish { ambient 0.25 diffuse 0.6 specular 0.15 } }\n";
    }
    out_ << "#declare Graph = texture { pigment { rgb 0.08 } finish { ambient 0.3 } }\n";
  }

  void list(const char* name, const std::vector<Vec3>& items) {
    out_ << name << " { " << items.size();
    for (const Vec3& item : items) out_ << ",\n" << item;
    out_ << " }\n";
  }

  void add_frame(size_t index) {
    const PictureFrame& frame = frames_[index];
    const Vec3 centre = box_centre(frame.positions);
    if (!subject_.triangles.empty()) add_mesh(index, centre);
    add_graph(index, centre);
  }

  void add_mesh(size_t index, const Vec3& centre) {
    const auto& positions = frames_[index].positions;
    std::vector<Vec3> points;
    for (uint32_t v = 0; v < positions.size() / 3; ++v) {
      points.push_back(place(at(positions, v), index, centre));
    }
    out_ << "mesh2 {\n";
    list("vertex_vectors", points);
    list("normal_vectors", normals_of(points, subject_.triangles));
    out_ << "texture_list { " << region_count();
    for (uint32_t r = 0; r < region_count(); ++r) out_ << ", texture { R" << r << " }";
    out_ << " }\nface_indices { " << subject_.triangles.size() / 3;
    const auto& labels = subject_.labels;
    for (size_t t = 0; t + 2 < subject_.triangles.size(); t += 3) {
      const uint32_t* v = &subject_.triangles[t];
      out_ << ",\n<" << v[0] << ',' << v[1] << ',' << v[2] << ">, " << labels[v[0]] << ','
           << labels[v[1]] << ',' << labels[v[2]];
    }
    out_ << " }\n}\n";
  }

  void add_graph(size_t index, const Vec3& centre) {
    const auto& skeleton = frames_[index].skeleton;
    const double radius = kGraphRadius * (cell_width_ + cell_height_) / 2;
    const auto placed = [&](const segmentation::Position& p) {
      return place({p[0], p[1], p[2]}, index, centre);
    };
    for (const auto& node : skeleton.nodes) sphere(placed(node), 2 * radius);
    for (size_t a = 0; a < skeleton.arcs.size(); ++a) {
      const auto& arc = subject_.graph->arcs[a];
      Vec3 last = placed(skeleton.nodes[arc.from]);
      for (const auto& point : skeleton.arcs[a]) {
        const Vec3 next = placed(point);
        cylinder(last, next, radius);
        sphere(next, radius);
        last = next;
      }
      cylinder(last, placed(skeleton.nodes[arc.to]), radius);
    }
  }

  void sphere(const Vec3& p, double radius) {
    out_ << "sphere { " << p << ", " << radius << " texture { Graph } }\n";
  }

  void cylinder(const Vec3& p, const Vec3& q, double radius) {
    if (length(p - q) < 1e-3 * radius) return;  // POV-Ray refuses it
    out_ << "cylinder { " << p << ", " << q << ", " << radius << " texture { Graph } }\n";
  }

  const PictureSubject& subject_;
  const std::vector<PictureFrame>& frames_;
  const Camera& camera_;
  double cell_width_ = 0, cell_height_ = 0;
  std::ostringstream out_;
};

// A folder of its own for the scene and the picture, removed with everything in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "reeb-XXXXXX").string();
    if (!error && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Runs a command without its output; its exit code, or -1 where it cannot be started.
int run_silently(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  }
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int state = 0;
  if (error != 0 || waitpid(child, &state, 0) != child || !WIFEXITED(state)) return -1;
  return WEXITSTATUS(state);
}

}  // namespace

std::array<double, 3> region_colour(uint32_t region) {
  // Hues by the golden section never come close again soon; lightness varies on top.
  const double hue = std::fmod(0.58 + 0.618033988749895 * region, 1.0) * 6;
  const double value = region % 3 == 2 ? 0.72 : 0.95, saturation = region % 2 == 1 ? 0.55 : 0.8;
  std::array<double, 3> colour;
  for (size_t i = 0; i < 3; ++i) {
    const double k = std::fmod(5 - 2 * static_cast<double>(i) + hue, 6);
    colour[i] = value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  }
  return colour;
}

PovrayScene povray_scene(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                         const Camera& camera, uint32_t tile) {
  return SceneWriter(subject, frames, camera).run(tile);
}

Status render_povray(const PovrayScene& scene, unsigned threads, std::string& png) {
  const ScratchFolder folder;
  const std::string in = folder.path() / "scene.pov", out = folder.path() / "picture.png";
  if (folder.path().empty() || !(std::ofstream(in, std::ios::binary) << scene.text)) {
    return Status::io("no temporary file can be written for the picture");
  }
  std::vector<std::string> command = {"povray",
                                      "+I" + in,
                                      "+O" + out,
                                      "+FN8",
                                      "+A0.2",
                                      "-D",
                                      "+W" + std::to_string(scene.width),
                                      "+H" + std::to_string(scene.height)};
  if (threads > 0) command.push_back("+WT" + std::to_string(threads));
  const int code = run_silently(command);
  if (code == -1 || code == 127) {
    return Status::io("pictures need the program povray (Debian package povray)");
  }
  FileBytes file;
  if (code != 0 || !FileBytes::read(out, file).ok()) {
    return Status::io("povray did not render the picture");
  }
  png = file.view();
  return {};
}

}  // namespace reeb::tools
