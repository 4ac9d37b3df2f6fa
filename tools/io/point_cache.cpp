#include "tools/io/point_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include "tools/io/file_bytes.h"
#include "tools/io/mesh_file.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 12> kPc2Magic{'P', 'O', 'I', 'N', 'T', 'C',
                                         'A', 'C', 'H', 'E', '2', '\0'};
constexpr size_t kPc2HeaderBytes = 32;
constexpr size_t kMddHeaderBytes = 8;

uint32_t reversed(uint32_t x) {
  return x >> 24 | (x >> 8 & 0xff00) | (x << 8 & 0xff0000) | x << 24;
}

/// Values in the order of the file <-> values in the order of this machine.
uint32_t swap_if_foreign(uint32_t x, CacheFormat format) {
  const auto order = format == CacheFormat::kMdd ? std::endian::big : std::endian::little;
  return std::endian::native == order ? x : reversed(x);
}

void swap_if_foreign(std::span<float> values, CacheFormat format) {
  if (swap_if_foreign(1, format) == 1) return;
  for (float& x : values) x = std::bit_cast<float>(reversed(std::bit_cast<uint32_t>(x)));
}

class CacheReader {
 public:
  CacheReader(const std::string& name, CacheFormat format, std::FILE* file, uint64_t size,
              const std::function<void(double)>& progress, PointCache& out)
      : name_(name), format_(format), file_(file), size_(size), progress_(progress), out_(out) {}

  Status run() {
    Status status = format_ == CacheFormat::kPc2 ? read_pc2_header() : read_mdd_header();
    if (!status.ok()) return status;
    status = read_floats(out_.positions, uint64_t{3} * out_.point_count * out_.frame_count);
    return status.ok() ? check_finite() : status;
  }

 private:
  Status error(const std::string& what) const { return Status::corrupt(name_ + ": " + what); }

  void note(const std::string& what) { out_.notes.push_back(name_ + ": " + what); }

  bool read_words(std::span<uint32_t> words) {
    if (std::fread(words.data(), 4, words.size(), file_) != words.size()) return false;
    for (uint32_t& w : words) w = swap_if_foreign(w, format_);
    return true;
  }

  Status read_pc2_header() {
    std::array<char, 12> magic{};
    std::array<uint32_t, 5> words{};
    if (std::fread(magic.data(), 1, magic.size(), file_) != magic.size() || magic != kPc2Magic ||
        !read_words(words)) {
      return error("not a PC2 point cache, or cut in its header; export it again");
    }
    if (words[0] != 1)
      return error("PC2 version " + std::to_string(words[0]) + " is not supported");
    take_pc2_times(std::bit_cast<float>(words[2]), std::bit_cast<float>(words[3]));
    return take_counts(words[1], words[4], kPc2HeaderBytes, 0);
  }

  void take_pc2_times(double start, double frames_per_sample) {
    if (std::isfinite(start)) {
      out_.start_time = start;
    } else {
      note("the start frame is no number; 0 is taken");
    }
    if (frames_per_sample > 0 && std::isfinite(frames_per_sample)) {
      out_.frames_per_sample = frames_per_sample;
    } else {
      note("the frames per sample are " + brief(frames_per_sample) + "; 1 is taken");
    }
  }

  Status read_mdd_header() {
    std::array<uint32_t, 2> words{};
    if (!read_words(words)) return error("cut in its header; export it again");
    Status status = take_counts(words[1], words[0], kMddHeaderBytes, 4);
    if (!status.ok()) return status;
    std::vector<float> times;
    status = read_floats(times, out_.frame_count);
    if (status.ok()) take_times(times);
    return status;
  }

  // Checks the counts against the size of the file before anything is allocated for them.
  Status take_counts(uint32_t points, uint32_t frames, uint64_t header_bytes,
                     uint64_t extra_frame_bytes) {
    if (points == 0 || frames == 0) return error("holds no points or no frames; export it again");
    // Below 2^36 bytes a frame and 2^32 frames; in double there is no overflow.
    const uint64_t frame_bytes = uint64_t{12} * points + extra_frame_bytes;
    const double need =
        static_cast<double>(frame_bytes) * frames + static_cast<double>(header_bytes);
    if (need > static_cast<double>(size_)) {
      const uint64_t whole = size_ < header_bytes ? 0 : (size_ - header_bytes) / frame_bytes;
      return error("frame " + grouped(whole + 1) + " is missing: the header announces " +
                   counted(frames, "frame") + " of " + counted(points, "point") +
                   ", the file ends before; it is truncated, export it again");
    }
    if (need < static_cast<double>(size_)) {
      note(counted(size_ - static_cast<uint64_t>(need), "byte") + " behind the last frame ignored");
    }
    out_.point_count = points;
    out_.frame_count = frames;
    return {};
  }

  // A constant rate explains the times to within float32, or a note says that none does.
  void take_times(const std::vector<float>& times) {
    const double span = double{times.back()} - double{times.front()};
    if (times.size() < 2) return;
    if (!(span > 0) || !std::isfinite(span)) {
      note("the times of the frames do not increase; they are ignored");
      return;
    }
    const double measured = static_cast<double>(times.size() - 1) / span;
    out_.frame_rate = nearest_usual_rate(measured, times);
    out_.start_time = double{times.front()} * out_.frame_rate;
    const double rounded = std::round(out_.start_time);
    if (std::abs(out_.start_time - rounded) < 1e-4) out_.start_time = rounded;
    if (!evenly_spaced(times, out_.frame_rate)) {
      note("the times of the frames are not evenly spaced; " + brief(out_.frame_rate, 6) +
           " frames per second are assumed");
    }
  }

  static bool evenly_spaced(const std::vector<float>& times, double rate) {
    for (size_t i = 0; i < times.size(); ++i) {
      const double expected = times[0] + static_cast<double>(i) / rate;
      if (std::abs(times[i] - expected) > 1e-3 / rate + 1e-6 * std::abs(expected)) return false;
    }
    return true;
  }

  // The whole rate, or the whole rate by 1000/1001, that gives the same times; else the measured
  // one.
  static double nearest_usual_rate(double measured, const std::vector<float>& times) {
    for (const double scale : {1.0, 1000.0 / 1001.0}) {
      const double rate = std::round(measured / scale) * scale;
      const double end = times.front() + static_cast<double>(times.size() - 1) / rate;
      if (rate > 0 && std::abs(end - times.back()) <= 3e-7 * std::abs(end)) return rate;
    }
    return measured;
  }

  Status read_floats(std::vector<float>& values, uint64_t count) {
    constexpr uint64_t kStep = uint64_t{1} << 22;  // floats from one report to the next
    values.resize(count);
    for (uint64_t done = 0; done < count;) {
      const std::span<float> part(values.data() + done, std::min(kStep, count - done));
      if (std::fread(part.data(), sizeof(float), part.size(), file_) != part.size())
        return std::ferror(file_) ? read_failure(name_) : error("became shorter while it was read");
      swap_if_foreign(part, format_);
      done += part.size();
      if (progress_) progress_(static_cast<double>(done) / static_cast<double>(count));
    }
    return {};
  }

  Status check_finite() const {
    const auto& p = out_.positions;
    const auto bad = std::find_if_not(p.begin(), p.end(), [](float x) { return std::isfinite(x); });
    if (bad == p.end()) return {};
    const auto point = static_cast<uint64_t>(bad - p.begin()) / 3;
    return error("frame " + grouped(point / out_.point_count + 1) + ", vertex " +
                 grouped(point % out_.point_count + 1) +
                 " is not finite (NaN or infinity); repair the frame and export the cache again");
  }

  std::string name_;
  CacheFormat format_;
  std::FILE* file_;
  uint64_t size_;
  const std::function<void(double)>& progress_;
  PointCache& out_;
};

void append_word(std::string& out, uint32_t value, CacheFormat format) {
  const uint32_t word = swap_if_foreign(value, format);
  std::array<char, 4> bytes{};
  std::memcpy(bytes.data(), &word, 4);
  out.append(bytes.data(), 4);
}

void append_float(std::string& out, double value, CacheFormat format) {
  append_word(out, std::bit_cast<uint32_t>(static_cast<float>(value)), format);
}

}  // namespace

std::optional<CacheFormat> cache_format(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".pc2") return CacheFormat::kPc2;
  if (extension == ".mdd") return CacheFormat::kMdd;
  return std::nullopt;
}

Status read_point_cache(const fs::path& path, PointCache& out,
                        const std::function<void(double)>& progress) {
  const std::optional<CacheFormat> format = cache_format(path);
  if (!format) return Status::invalid(path.string() + ": not a point cache (.pc2 or .mdd)");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  std::error_code failed;
  const uintmax_t size = fs::file_size(path, failed);
  if (!file || failed) return read_failure(path.string());
  return read_point_cache(file.get(), size, path.string(), *format, out, progress);
}

Status read_point_cache(std::FILE* file, uint64_t size, const std::string& name, CacheFormat format,
                        PointCache& out, const std::function<void(double)>& progress) {
  out = PointCache();
  return CacheReader(name, format, file, size, progress, out).run();
}

std::string cache_header(CacheFormat format, uint32_t point_count, uint32_t frame_count,
                         double frame_rate, double start_time, double frames_per_sample) {
  std::string out;
  if (format == CacheFormat::kPc2) {
    out.append(kPc2Magic.data(), kPc2Magic.size());
    append_word(out, 1, format);
    append_word(out, point_count, format);
    append_float(out, start_time, format);
    append_float(out, frames_per_sample, format);
    append_word(out, frame_count, format);
    return out;
  }
  append_word(out, frame_count, format);
  append_word(out, point_count, format);
  for (uint32_t t = 0; t < frame_count; ++t)
    append_float(out, (start_time + t) / frame_rate, format);
  return out;
}

std::string cache_positions(CacheFormat format, std::span<const float> positions) {
  std::string out;
  out.reserve(positions.size_bytes());
  for (const float x : positions) append_word(out, std::bit_cast<uint32_t>(x), format);
  return out;
}

}  // namespace reeb::tools
