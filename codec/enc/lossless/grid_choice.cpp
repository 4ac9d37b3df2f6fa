#include "codec/enc/lossless/grid_choice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace reeb {

namespace {

constexpr double kTolerance = 0.125;  ///< of a step, by which values may miss their levels
constexpr uint32_t kDivisors = 4;     ///< of the least distance: steps that are tried
constexpr double kGridBits = 16 + 128 + 2;
constexpr size_t kSamples = 1 << 20;       ///< values in the frames that decide
constexpr double kMinGain = 0.5;           ///< bits per value that grids must save more than others
constexpr size_t kSharedValues = 1 << 22;  ///< in all frames, at most, to look for one grid of all

/// Numbers of the levels that rising values are; empty where they are none of such a step.
std::vector<uint32_t> number_levels(const std::vector<float>& values, double step) {
  std::vector<uint32_t> levels{0};
  const double first = values.front();
  for (size_t i = 1; i < values.size(); ++i) {
    const double steps = std::round((double{values[i]} - values[i - 1]) / step);
    const double n = levels.back() + steps;
    if (steps < 1 || n >= FrameGrid::kMaxCount) return {};
    levels.push_back(static_cast<uint32_t>(n));
    step = (values[i] - first) / n;  // the better known the further
  }
  return levels;
}

/// The line through the values by least squares: origin and step.
FrameGrid fit(const std::vector<float>& values, const std::vector<uint32_t>& levels) {
  const auto count = static_cast<double>(values.size());
  double mean_n = 0, mean_x = 0, nn = 0, nx = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    mean_n += levels[i] / count;
    mean_x += values[i] / count;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    nn += (levels[i] - mean_n) * (levels[i] - mean_n);
    nx += (levels[i] - mean_n) * (values[i] - mean_x);
  }
  FrameGrid grid;
  grid.count = levels.back() + 1;
  // A single level is worth as much as it is alone.
  grid.step = nn > 0 ? nx / nn : std::max(std::abs(mean_x), 1e-30) * 0x1p-24;
  // Through the least value, whose places are the finest.
  const auto least = std::min_element(values.begin(), values.end(),
                                      [](float a, float b) { return std::abs(a) < std::abs(b); });
  grid.origin = *least - levels[static_cast<size_t>(least - values.begin())] * grid.step;
  return grid;
}

/// Corrects the levels that are not quite the values; false where one is too far off.
bool correct(const std::vector<float>& values, const std::vector<uint32_t>& levels,
             FrameGrid& grid) {
  constexpr double kMax = std::numeric_limits<float>::max();
  constexpr double kMin = std::numeric_limits<float>::min();  // no subnormal steps
  if (!(grid.step >= kMin && grid.step <= kMax && std::abs(grid.origin) <= kMax)) return false;
  const NumberSet all;
  for (size_t i = 0; i < values.size(); ++i) {
    const double x = grid.origin + levels[i] * grid.step;
    if (!(std::abs(values[i] - x) <= kTolerance * grid.step)) return false;
    const int64_t places = all.nearest(values[i]) - all.nearest(x);
    if (std::abs(places) > (1 << 24)) return false;
    if (places != 0) grid.corrections.push_back({levels[i], static_cast<int32_t>(places)});
  }
  return true;
}

std::vector<float> along(std::span<const float> frame, uint32_t axis) {
  std::vector<float> out;
  out.reserve(frame.size() / 3);
  for (size_t i = axis; i < frame.size(); i += 3) out.push_back(frame[i]);
  return out;
}

double bits_of(const FrameGrid& grid) {
  double bits = kGridBits;
  uint32_t next = 0;
  for (const FrameGrid::Correction& c : grid.corrections) {
    bits += 2 + 2 * std::log2(c.level - next + 1.0) +
            2 * std::log2(std::abs(static_cast<double>(c.places)));
    next = c.level + 1;
  }
  return bits;
}

/// Bits that the distances of the set spare against all binary32 numbers near x.
double gain_near(const NumberSet& set, float x) {
  const double size = std::max(std::abs(x), 1e-30f);
  const double least =
      double{std::nextafter(static_cast<float>(size), std::numeric_limits<float>::max())} - size;
  if (least <= 0) return 0;
  if (set.step() > 0) return std::max(0.0, std::log2(set.step() / least));
  const int64_t n = set.nearest(size);
  if (!set.valid(n + 1)) return 0;
  return std::max(0.0, std::log2((double{set.number(n + 1)} - double{set.number(n)}) / least));
}

/// Bits that the set spares over the values against binary32.
double gain(const NumberSet& set, const std::vector<float>& values) {
  double bits = 0;
  for (const float x : values) bits += gain_near(set, x);
  return bits;
}

double gain(const FrameGrid& grid, const std::vector<float>& values) {
  return grid.count > 0 ? gain(NumberSet::levels(grid), values) - bits_of(grid) : 0;
}

bool holds(const FrameGrid& grid, const std::vector<float>& values) {
  if (grid.count == 0) return false;
  const NumberSet set = NumberSet::levels(grid);
  return std::all_of(values.begin(), values.end(), [&](float x) {
    bool found = false;
    set.find(x, found);
    return found;
  });
}

/// One grid of all frames, or none.
FrameGrid find_shared(const ExactFrames& frames, uint32_t axis) {
  std::vector<float> values;
  if (frames.stored_count() * (frames.stored(0).size() / 3) > kSharedValues) return {};
  for (uint32_t t = 0; t < frames.stored_count(); ++t) {
    const std::vector<float> more = along(frames.stored(t), axis);
    values.insert(values.end(), more.begin(), more.end());
  }
  return find_grid(std::move(values));
}

}  // namespace

FrameGrid find_grid(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() > FrameGrid::kMaxCount) return {};
  double least = std::numeric_limits<double>::max();
  for (size_t i = 1; i < values.size(); ++i)
    least = std::min(least, double{values[i]} - double{values[i - 1]});
  for (uint32_t divisor = 1; divisor <= kDivisors; ++divisor) {
    const std::vector<uint32_t> levels = number_levels(values, least / divisor);
    if (levels.empty()) continue;
    FrameGrid grid = fit(values, levels);
    if (correct(values, levels, grid)) return grid;
  }
  return {};
}

bool GridChoice::choose(const ExactFrames& frames, uint32_t axis, const NumberSet& set) {
  axis_ = axis;
  const size_t vertices = frames.stored(0).size() / 3;
  const auto most = static_cast<uint32_t>(std::clamp<size_t>(kSamples / vertices, 2, 8));
  const uint32_t count = std::min(frames.stored_count(), most);
  FrameGrid shared = find_shared(frames, axis);
  double spared = 0, spared_shared = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const std::vector<float> values = along(frames.stored(i * frames.stored_count() / count), axis);
    const double least = gain(set, values) + kMinGain * static_cast<double>(values.size());
    spared += std::max(0.0, gain(find_grid(values), values)) - least;
    spared_shared += gain(shared, values) - gain(set, values);
  }
  // Frames that keep one grid follow each other more smoothly; if each of them lies on a coarser
  // one, that is worth more.
  const bool one_grid = shared.count > 0 && spared_shared >= std::max(spared, 0.0);
  if (one_grid) last_ = std::move(shared);
  return one_grid || spared > 0;
}

FrameGrid GridChoice::next(std::span<const float> frame) {
  const std::vector<float> values = along(frame, axis_);
  if (holds(last_, values)) return last_;
  FrameGrid grid = find_grid(values);
  if (gain(grid, values) <= 0) grid = {};
  return last_ = grid;
}

}  // namespace reeb
