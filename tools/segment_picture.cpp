#include "tools/segment_picture.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "tools/io/file_bytes.h"

extern char** environ;

namespace reeb::tools {
namespace {

using Vector = std::array<double, 3>;

constexpr double kTurn = 0.45;          // radians that the view is turned off the axis
constexpr double kElevation = 0.2;      // radians that it looks down
constexpr double kGraphRadius = 0.008;  // of the height and width of a mesh
constexpr double kMargin = 1.06;

Vector at(std::span<const float> positions, uint32_t v) {
  const float* p = &positions[3 * static_cast<size_t>(v)];
  return {p[0], p[1], p[2]};
}

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

struct Box {
  Vector low = {1e300, 1e300, 1e300}, high = {-1e300, -1e300, -1e300};

  void add(const Vector& p) {
    for (size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  double extent(size_t i) const { return high[i] - low[i]; }
  Vector centre() const {
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
  }
};

Box box_of(std::span<const float> positions) {
  Box box;
  for (uint32_t v = 0; v < positions.size() / 3; ++v) box.add(at(positions, v));
  return box;
}

// Turns a point about the y axis and tilts it towards the viewer, who looks along -z.
class View {
 public:
  explicit View(const Box& box) : turn_(kTurn) {
    if (box.extent(0) < box.extent(2)) turn_ += std::numbers::pi / 2;
  }

  Vector apply(const Vector& p) const {
    const double x = std::cos(turn_) * p[0] - std::sin(turn_) * p[2];
    const double z = std::sin(turn_) * p[0] + std::cos(turn_) * p[2];
    return {x, std::cos(kElevation) * p[1] - std::sin(kElevation) * z,
            std::sin(kElevation) * p[1] + std::cos(kElevation) * z};
  }

 private:
  double turn_;
};

void write(std::ostream& out, const Vector& v) {
  out << '<' << v[0] << ',' << v[1] << ',' << v[2] << '>';
}

std::vector<Vector> normals_of(const std::vector<Vector>& points,
                               std::span<const uint32_t> triangles) {
  std::vector<Vector> normals(points.size(), Vector{0, 0, 0});
  for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Vector u = minus(points[triangles[t + 1]], points[triangles[t]]);
    const Vector w = minus(points[triangles[t + 2]], points[triangles[t]]);
    const Vector n = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                      u[0] * w[1] - u[1] * w[0]};
    for (size_t k = t; k < t + 3; ++k) {
      for (size_t i = 0; i < 3; ++i) normals[triangles[k]][i] += n[i];
    }
  }
  for (Vector& n : normals) {
    const double length = std::hypot(n[0], n[1], n[2]);
    n = length > 0 ? Vector{n[0] / length, n[1] / length, n[2] / length} : Vector{0, 0, 1};
  }
  return normals;
}

class SceneWriter {
 public:
  SceneWriter(const PictureSubject& subject, const std::vector<PictureFrame>& frames)
      : subject_(subject), frames_(frames), view_(box_of(frames.front().positions)) {
    for (const PictureFrame& frame : frames_) {
      Box turned;
      const Vector centre = box_of(frame.positions).centre();
      for (uint32_t v = 0; v < frame.positions.size() / 3; ++v) {
        turned.add(view_.apply(minus(at(frame.positions, v), centre)));
      }
      cell_width_ = std::max(cell_width_, turned.extent(0));
      cell_height_ = std::max(cell_height_, turned.extent(1));
    }
    cell_width_ *= kMargin;
    cell_height_ *= kMargin;
  }

  std::string run(uint32_t width, uint32_t height) {
    camera(width, height);
    declare_textures();
    for (size_t i = 0; i < frames_.size(); ++i) add_frame(i);
    return out_.str();
  }

 private:
  Vector place(const Vector& p, size_t frame, const Vector& centre) const {
    Vector q = view_.apply(minus(p, centre));
    q[0] += cell_width_ *
            (static_cast<double>(frame) + 0.5 - 0.5 * static_cast<double>(frames_.size()));
    return q;
  }

  void camera(uint32_t width, uint32_t height) {
    const double aspect = static_cast<double>(width) / height;
    const double row = cell_width_ * static_cast<double>(frames_.size());
    const double seen = std::max(row, cell_height_ * aspect);
    const double far = 10 * (row + cell_height_);
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
    return subject_.labels.empty()
               ? 0
               : *std::max_element(subject_.labels.begin(), subject_.labels.end()) + 1;
  }

  void declare_textures() {
    for (uint32_t r = 0; r < region_count(); ++r) {
      const auto c = region_colour(r);
      out_ << "#declare R" << r << " = texture { pigment { rgb <" << c[0] << ',' << c[1] << ','
           << c[2] << "> transmit 0.35 } finish { ambient 0.25 diffuse 0.6 specular 0.15 } }\n";
    }
    out_ << "#declare Graph = texture { pigment { rgb 0.08 } finish { ambient 0.3 } }\n";
  }

  template <typename Item>
  void list(const char* name, const std::vector<Item>& items) {
    out_ << name << " { " << items.size();
    for (const Item& item : items) {
      out_ << ",\n";
      write(out_, item);
    }
    out_ << " }\n";
  }

  void add_frame(size_t index) {
    const PictureFrame& frame = frames_[index];
    const Vector centre = box_of(frame.positions).centre();
    std::vector<Vector> points;
    for (uint32_t v = 0; v < frame.positions.size() / 3; ++v) {
      points.push_back(place(at(frame.positions, v), index, centre));
    }
    out_ << "mesh2 {\n";
    list("vertex_vectors", points);
    list("normal_vectors", normals_of(points, subject_.triangles));
    out_ << "texture_list { " << region_count();
    for (uint32_t r = 0; r < region_count(); ++r) out_ << ", texture { R" << r << " }";
    out_ << " }\nface_indices { " << subject_.triangles.size() / 3;
    for (size_t t = 0; t + 2 < subject_.triangles.size(); t += 3) {
      const uint32_t* v = &subject_.triangles[t];
      out_ << ",\n<" << v[0] << ',' << v[1] << ',' << v[2] << ">, " << subject_.labels[v[0]] << ','
           << subject_.labels[v[1]] << ',' << subject_.labels[v[2]];
    }
    out_ << " }\n}\n";
    add_graph(index, centre);
  }

  void add_graph(size_t index, const Vector& centre) {
    const auto& skeleton = frames_[index].skeleton;
    const double radius = kGraphRadius * (cell_width_ + cell_height_) / 2;
    const auto placed = [&](const std::array<float, 3>& p) {
      return place({p[0], p[1], p[2]}, index, centre);
    };
    for (const auto& node : skeleton.nodes) sphere(placed(node), 2 * radius);
    for (size_t a = 0; a < skeleton.arcs.size(); ++a) {
      const auto& arc = subject_.graph->arcs[a];
      Vector last = placed(skeleton.nodes[arc.from]);
      for (const auto& point : skeleton.arcs[a]) {
        const Vector next = placed(point);
        cylinder(last, next, radius);
        sphere(next, radius);
        last = next;
      }
      cylinder(last, placed(skeleton.nodes[arc.to]), radius);
    }
  }

  void sphere(const Vector& p, double radius) {
    out_ << "sphere { ";
    write(out_, p);
    out_ << ", " << radius << " texture { Graph } }\n";
  }

  void cylinder(const Vector& p, const Vector& q, double radius) {
    const Vector d = minus(p, q);
    if (std::hypot(d[0], d[1], d[2]) < 1e-3 * radius) return;  // POV-Ray refuses it
    out_ << "cylinder { ";
    write(out_, p);
    out_ << ", ";
    write(out_, q);
    out_ << ", " << radius << " texture { Graph } }\n";
  }

  const PictureSubject& subject_;
  const std::vector<PictureFrame>& frames_;
  View view_;
  double cell_width_ = 0, cell_height_ = 0;
  std::ostringstream out_;
};

// A folder of its own for the scene and the picture, removed with everything in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "reeb-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
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
  // Hues by the golden section never come close again soon; the value alternates on top.
  const double hue = std::fmod(0.58 + 0.618033988749895 * region, 1.0) * 6;
  const double value = region % 3 == 2 ? 0.72 : 0.95, saturation = region % 2 == 1 ? 0.55 : 0.8;
  std::array<double, 3> colour;
  for (size_t i = 0; i < 3; ++i) {
    const double k = std::fmod(5 - 2 * static_cast<double>(i) + hue, 6);
    colour[i] = value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  }
  return colour;
}

std::string povray_scene(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                         uint32_t width, uint32_t height) {
  return SceneWriter(subject, frames).run(width, height);
}

Status render(const std::string& scene, uint32_t width, uint32_t height, unsigned threads,
              std::string& png) {
  const ScratchFolder folder;
  const std::string in = folder.path() / "scene.pov", out = folder.path() / "picture.png";
  if (folder.path().empty() || !(std::ofstream(in, std::ios::binary) << scene)) {
    return Status::io("no temporary file can be written for the picture");
  }
  std::vector<std::string> command = {"povray",
                                      "+I" + in,
                                      "+O" + out,
                                      "+FN8",
                                      "+A0.2",
                                      "-D",
                                      "+W" + std::to_string(width),
                                      "+H" + std::to_string(height)};
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
