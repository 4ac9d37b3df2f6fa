#include "tools/segment_picture.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr double kGraphRadius = 0.008;  ///< of the mean of height and width of a mesh
constexpr double kGraphOpacity = 0.7;   ///< shines through the surface
constexpr double kMargin = 1.06;
constexpr int kMaxAspect = 4;  ///< of a tile, either way
constexpr int kLineHeight = 26;
constexpr uint32_t kMaxNumbers = 100;
constexpr Colour kInk{30, 30, 34};
constexpr Colour kPaper{255, 255, 255};

Vec3 vector_of(const segmentation::Position& p) { return {p[0], p[1], p[2]}; }

class SegmentPicture {
 public:
  SegmentPicture(const PictureSubject& subject, const Camera& camera, int tile)
      : subject_(subject), camera_(camera), width_(tile), factor_(tile <= 1024 ? 3 : 1) {
    for (const uint32_t label : subject.labels) {
      region_count_ = std::max(region_count_, label + 1);
      const auto colour = region_colour(label);
      Colour& c = colours_.emplace_back();
      for (size_t k = 0; k < 3; ++k) c[k] = static_cast<uint8_t>(std::lround(255 * colour[k]));
    }
  }

  Image run(const std::vector<PictureFrame>& frames) {
    choose_scale(frames);
    Image image(width_ * static_cast<int>(frames.size()), kLineHeight + height_, kPaper);
    for (size_t i = 0; i < frames.size(); ++i) {
      draw_frame(frames[i], static_cast<int>(i) * width_, image);
    }
    return image;
  }

 private:
  void choose_scale(const std::vector<PictureFrame>& frames) {
    std::array<double, 2> half{};
    for (const PictureFrame& frame : frames) {
      const auto extent = half_extent(frame.positions, camera_, box_centre(frame.positions));
      for (size_t k = 0; k < 2; ++k) half[k] = std::max(half[k], extent[k]);
    }
    const double aspect = half[0] > 0 ? std::min(half[1] / half[0], 1.0 * kMaxAspect) : kMaxAspect;
    height_ = std::max(static_cast<int>(width_ * aspect), width_ / kMaxAspect);
    const double room = 2 * kMargin * std::max(half[0] / width_, half[1] / height_);
    scale_ = room > 0 ? 1 / room : 1;
    radius_ = kGraphRadius * kMargin * (half[0] + half[1]) * scale_;
  }

  void draw_frame(const PictureFrame& frame, int left, Image& out) const {
    const Vec3 centre = box_centre(frame.positions);
    Image tile(width_ * factor_, height_ * factor_, kPaper);
    const Framing framing{centre, scale_ * factor_};
    draw_mesh(*subject_.connectivity, frame.positions, colours_, camera_, framing, tile);
    const Image surface = tile;
    draw_graph(frame.skeleton, framing, tile);
    for (size_t i = 0; i < tile.pixels.size(); ++i) {
      tile.pixels[i] = mixed(surface.pixels[i], tile.pixels[i], kGraphOpacity);
    }
    paste_shrunk(tile, factor_, left, kLineHeight, out);
    draw_text("frame " + grouped(uint64_t{frame.frame} + 1), left + 8,
              (kLineHeight - kTextHeight) / 2, kInk, out);
    if (region_count_ <= kMaxNumbers) draw_numbers(frame, {centre, scale_}, left, out);
  }

  void draw_graph(const segmentation::SkeletonPose& skeleton, const Framing& framing,
                  Image& tile) const {
    const double radius = radius_ * factor_;
    const auto placed = [&](const segmentation::Position& p) {
      return framing.place(vector_of(p), camera_, tile);
    };
    for (const auto& node : skeleton.nodes) {
      draw_line(placed(node), placed(node), 2 * radius, kInk, tile);
    }
    for (size_t a = 0; a < skeleton.arcs.size(); ++a) {
      Point last = placed(skeleton.nodes[subject_.graph->arcs[a].from]);
      for (const auto& point : skeleton.arcs[a]) {
        const Point next = placed(point);
        draw_line(last, next, radius, kInk, tile);
        last = next;
      }
      draw_line(last, placed(skeleton.nodes[subject_.graph->arcs[a].to]), radius, kInk, tile);
    }
  }

  /// At the middle of each region, as files of the graph count them.
  void draw_numbers(const PictureFrame& frame, const Framing& framing, int left, Image& out) const {
    const auto& centroids = region_centroids(frame);
    const Image tile(width_, height_);
    for (uint32_t r = 0; r < region_count_; ++r) {
      const std::string number = std::to_string(r);
      Point at = framing.place(centroids[r], camera_, tile);
      at.x += left;
      at.y += kLineHeight;
      const double half = std::max(0.0, text_width(number) / 2.0 - 5);
      draw_line({at.x - half, at.y}, {at.x + half, at.y}, 10, kInk, out);
      draw_line({at.x - half, at.y}, {at.x + half, at.y}, 9, kPaper, out);
      draw_text(number, static_cast<int>(std::lround(at.x)) - text_width(number) / 2,
                static_cast<int>(std::lround(at.y)) - kTextHeight / 2, kInk, out);
    }
  }

  std::vector<Vec3> region_centroids(const PictureFrame& frame) const {
    std::vector<Vec3> sums(region_count_);
    std::vector<double> counts(region_count_);
    for (size_t v = 0; v < subject_.labels.size(); ++v) {
      const float* p = &frame.positions[3 * v];
      sums[subject_.labels[v]] += {p[0], p[1], p[2]};
      ++counts[subject_.labels[v]];
    }
    for (uint32_t r = 0; r < region_count_; ++r) sums[r] = sums[r] * (1 / std::max(counts[r], 1.0));
    return sums;
  }

  const PictureSubject& subject_;
  const Camera& camera_;
  int width_;
  int height_ = 0;
  int factor_;         ///< of supersampling
  double scale_ = 1;   ///< pixels per unit
  double radius_ = 0;  ///< of the graph's lines, pixels
  uint32_t region_count_ = 0;
  std::vector<Colour> colours_;  ///< per vertex
};

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

Image segment_picture(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                      const Camera& camera, int tile) {
  return SegmentPicture(subject, camera, tile).run(frames);
}

}  // namespace reeb::tools
