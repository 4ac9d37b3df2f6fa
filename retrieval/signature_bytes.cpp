#include <algorithm>
#include <cmath>

#include "retrieval/signature.h"

namespace reeb::retrieval {
namespace {

constexpr uint8_t kVersion = 2;
constexpr float kStep = 1.0f / 1024;

// The bytes of a signature described once; Writer and Reader visit it.
template <typename Visitor, typename Chart>
void visit_chart(Visitor& v, Chart& chart) {
  v.flag(chart.annulus);
  v.number(chart.share);
  v.number(chart.area);
  v.number(chart.girth);
  v.number(chart.height);
  v.numbers(chart.area_stretch, kProfileLength);
  v.numbers(chart.angle_stretch, kProfileLength);
  v.numbers(chart.thickness, kProfileLength);
  v.list(chart.neighbours);
}

template <typename Visitor, typename Values>
void visit_body(Visitor& v, Values& s) {
  v.numbers(s.heat, kSpectralValues);
  v.numbers(s.wave, kSpectralValues);
  v.numbers(s.thickness, kBodyValues);
  v.numbers(s.straightness, kBodyValues);
  v.numbers(s.curvature, kBodyValues);
  v.numbers(s.reach, kBodyValues);
}

class Writer {
 public:
  void byte(uint8_t value) { bytes.push_back(value); }
  void flag(bool value) { byte(value); }
  void number(float value) {
    const float steps = std::clamp(std::round(value / kStep), -32768.0f, 32767.0f);
    const auto bits = static_cast<uint16_t>(static_cast<int16_t>(steps));
    byte(static_cast<uint8_t>(bits & 0xff));
    byte(static_cast<uint8_t>(bits >> 8));
  }
  void numbers(const std::vector<float>& values, int count) {
    for (int i = 0; i < count; ++i) number(values[i]);
  }
  void list(const std::vector<uint8_t>& values) {
    byte(static_cast<uint8_t>(values.size()));
    for (const uint8_t value : values) byte(value);
  }

  std::vector<uint8_t> bytes;
};

// Gives zeros past the end and remembers that it did.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  uint8_t byte() {
    if (at_ < bytes_.size()) return bytes_[at_++];
    failed_ = true;
    return 0;
  }
  void flag(bool& value) {
    const uint8_t b = byte();
    failed_ |= b > 1;
    value = b == 1;
  }
  void number(float& value) {
    const uint32_t low = byte();
    value = static_cast<float>(static_cast<int16_t>(low | uint32_t{byte()} << 8)) * kStep;
  }
  void numbers(std::vector<float>& values, int count) {
    values.resize(count);
    for (float& value : values) number(value);
  }
  void list(std::vector<uint8_t>& values) {
    values.resize(byte());
    for (uint8_t& value : values) value = byte();
    failed_ |= !std::is_sorted(values.begin(), values.end(), std::less_equal<>());
  }
  void fail_unless(bool good) { failed_ |= !good; }
  bool failed() const { return failed_; }
  bool finished() const { return !failed_ && at_ == bytes_.size(); }

 private:
  std::span<const uint8_t> bytes_;
  size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace

std::vector<uint8_t> to_bytes(const Signature& signature) {
  Writer writer;
  writer.byte(kVersion);
  writer.flag(!signature.empty());
  if (signature.empty()) return std::move(writer.bytes);
  visit_body(writer, signature);
  writer.byte(static_cast<uint8_t>(signature.charts.size()));
  for (const ChartSignature& chart : signature.charts) visit_chart(writer, chart);
  return std::move(writer.bytes);
}

bool from_bytes(std::span<const uint8_t> bytes, Signature& out) {
  out = {};
  Reader reader(bytes);
  reader.fail_unless(reader.byte() == kVersion);
  bool present = false;
  reader.flag(present);
  if (!present) return reader.finished();
  Signature signature;
  visit_body(reader, signature);
  const uint32_t charts = reader.byte();
  reader.fail_unless(charts <= kMaxCharts);
  for (uint32_t c = 0; c < charts && !reader.failed(); ++c) {
    ChartSignature& chart = signature.charts.emplace_back();
    visit_chart(reader, chart);
    reader.fail_unless(chart.share >= 0 &&
                       (chart.neighbours.empty() || chart.neighbours.back() < charts));
  }
  if (!reader.finished()) return false;
  out = std::move(signature);
  return true;
}

}  // namespace reeb::retrieval
