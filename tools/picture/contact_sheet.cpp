#include "tools/picture/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "tools/metrics.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr int kSupersampling = 3;
constexpr int kLineHeight = 26;
constexpr double kFilled = 0.92;  ///< part of a tile that the largest frame takes
constexpr Colour kInk{60, 60, 66};
constexpr Colour kPaper{255, 255, 255};
constexpr Colour kClay{214, 196, 178};

/// One frame of a sequence.
struct FrameView {
  const Connectivity* connectivity = nullptr;
  std::span<const float> positions;
  const Shot* shot = nullptr;
  uint32_t t = 0;  ///< in the shot
};

FrameView frame_view(const Sequence& sequence, uint32_t frame) {
  for (const Shot& shot : sequence.shots) {
    if (frame < shot.frame_count) return {&shot.connectivity, shot.frame(frame), &shot, frame};
    frame -= shot.frame_count;
  }
  static const Connectivity kNothing;
  return {&kNothing, {}};
}

std::vector<double> displacements(const FrameView& a, const FrameView& b) {
  std::vector<double> out(a.positions.size() / 3);
  for (size_t v = 0; v < out.size(); ++v) {
    double squared = 0;
    for (size_t i = 3 * v; i < 3 * v + 3; ++i) {
      const double d = double{a.positions[i]} - double{b.positions[i]};
      squared += d * d;
    }
    out[v] = std::sqrt(squared);
  }
  return out;
}

class Sheet {
 public:
  Sheet(const Sequence& original, const Sequence* other, const SheetOptions& options)
      : original_(original),
        other_(other),
        options_(options),
        image_(options.tile_width * static_cast<int>(options.frames.size()),
               other == nullptr ? kLineHeight + options.tile_height
                                : 4 * kLineHeight + 3 * options.tile_height + kLineHeight,
               kPaper) {}

  Image run() {
    choose_scale();
    for (size_t column = 0; column < options_.frames.size(); ++column) draw_column(column);
    if (other_ != nullptr) {
      text("original", 0, row_top(0) - kLineHeight);
      text("decoded", 0, row_top(1) - kLineHeight);
      draw_legend(row_top(2) - kLineHeight);
    }
    return std::move(image_);
  }

 private:
  int row_top(int row) const {
    return 2 * kLineHeight + row * (options_.tile_height + kLineHeight);
  }

  void text(const std::string& words, int left, int top) {
    draw_text(words, left + 8, top + (kLineHeight - kTextHeight) / 2, kInk, image_);
  }

  void choose_scale() {
    double scale = 1e300;
    for (const uint32_t frame : options_.frames) {
      const FrameView a = frame_view(original_, frame);
      const auto extent = half_extent(a.positions, options_.camera, box_centre(a.positions));
      if (extent[0] > 0) scale = std::min(scale, options_.tile_width * kFilled / 2 / extent[0]);
      if (extent[1] > 0) scale = std::min(scale, options_.tile_height * kFilled / 2 / extent[1]);
      if (other_ == nullptr) continue;
      for (const double d : displacements(a, frame_view(*other_, frame))) {
        largest_error_ = std::max(largest_error_, d);
      }
    }
    scale_ = scale < 1e300 ? scale : 1;
  }

  void draw_column(size_t column) {
    const uint32_t frame = options_.frames[column];
    const FrameView a = frame_view(original_, frame);
    const int left = static_cast<int>(column) * options_.tile_width;
    text("frame " + grouped(uint64_t{frame} + 1), left, 0);
    if (other_ == nullptr) {
      draw_tile(a, a, left, kLineHeight);
      return;
    }
    const FrameView b = frame_view(*other_, frame);
    draw_tile(a, a, left, row_top(0));
    draw_tile(b, a, left, row_top(1));
    const std::vector<double> errors = displacements(a, b);
    std::vector<Colour> colours;
    for (const uint32_t v : b.connectivity->corners)
      colours.push_back(error_colour(largest_error_ > 0 ? errors[v] / largest_error_ : 0));
    draw_tile(b, {.corners = colours}, a, left, row_top(2));
  }

  // As the options say.
  void draw_tile(const FrameView& frame, const FrameView& centred, int left, int top) {
    const std::vector<Colour> colours =
        paint_corners(*frame.shot, frame.t, options_.attribute, options_.scale);
    const std::vector<float> places = texture_coordinates(*frame.shot, frame.t);
    Paint paint{.corners = {&kClay, 1}};
    if (!colours.empty()) paint.corners = colours;
    if (options_.texture != nullptr && !places.empty()) {
      paint.texture = options_.texture;
      paint.texture_coordinates = places;
    }
    draw_tile(frame, paint, centred, left, top);
  }

  // `centred` gives the middle, so that both sides of a comparison stand alike.
  void draw_tile(const FrameView& frame, const Paint& paint, const FrameView& centred, int left,
                 int top) {
    Image tile(options_.tile_width * kSupersampling, options_.tile_height * kSupersampling, kPaper);
    draw_painted(*frame.connectivity, frame.positions, paint, options_.camera,
                 {box_centre(centred.positions), scale_ * kSupersampling}, tile);
    paste_shrunk(tile, kSupersampling, left, top, image_);
  }

  void draw_legend(int top) {
    const std::string before = "error  0 ";
    const double diagonal = bounding_diagonal(original_);
    const double percent = diagonal > 0 ? 100 * largest_error_ / diagonal : 0;
    const std::string after =
        brief(largest_error_, 3) + " (" + brief(percent, 3) + "% of the diagonal)";
    const int bar_left = 8 + text_width(before);
    const int bar_width = std::clamp(image_.width / 5, 40, 120);
    text(before, 0, top);
    for (int x = 0; x < bar_width && bar_left + x < image_.width; ++x) {
      for (int y = top + 6; y < top + kLineHeight - 6; ++y) {
        image_.at(bar_left + x, y) = error_colour(static_cast<double>(x) / bar_width);
      }
    }
    text(after, bar_left + bar_width, top);
  }

  const Sequence& original_;
  const Sequence* other_;
  const SheetOptions& options_;
  Image image_;
  double scale_ = 1;
  double largest_error_ = 0;
};

}  // namespace

std::vector<uint32_t> spread_frames(uint32_t frame_count, uint32_t columns) {
  columns = std::min(columns, frame_count);
  std::vector<uint32_t> frames;
  for (uint32_t i = 0; i < columns; ++i) {
    const uint64_t gaps = std::max(columns, 2u) - 1;
    frames.push_back(static_cast<uint32_t>(uint64_t{i} * (frame_count - 1) / gaps));
  }
  return frames;
}

Image contact_sheet(const Sequence& original, const Sequence* other, const SheetOptions& options) {
  return Sheet(original, other, options).run();
}

}  // namespace reeb::tools
