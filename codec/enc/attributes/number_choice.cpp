#include "codec/enc/attributes/number_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reeb {

namespace {

constexpr double kMaxMultiple = 1099511627776.0;  // 2^40
constexpr double kMaxTop = 4294967295.0;
constexpr uint64_t kExceptionBits = 40;  ///< that one takes
/// Bits that a value takes less as one of few multiples than as any binary32, at least.
constexpr uint64_t kSavedBits = 4;

/// One channel on its way to integers.
struct ChannelFit {
  ChannelHeader header;
  std::vector<int64_t> multiples;  ///< of every value; of exceptions, any
  std::vector<size_t> exceptions;
  bool fits = false;
};

float binary32_of(double multiple, double step) { return static_cast<float>(multiple * step); }

/// The multiples of a step nearest to the values. Those further off than `error` are exceptions,
/// and where it is 0, those with other bits.
ChannelFit fit_multiples(const std::vector<float>& values, double step, double error) {
  ChannelFit out;
  out.header.step = step;
  double low = kMaxMultiple, high = -kMaxMultiple;
  out.multiples.resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const auto x = static_cast<double>(values[i]);
    const double n = std::floor(x / step + 0.5);
    bool good = std::abs(n) < kMaxMultiple && std::abs(n * step) <= ChannelHeader::kMaxNumber;
    if (good) {
      const float back = binary32_of(n, step);
      good = error > 0 ? std::abs(static_cast<double>(back) - x) <= error
                       : std::bit_cast<uint32_t>(back) == std::bit_cast<uint32_t>(values[i]);
      // Zeros with a sign are cheap to code as the zero that they nearly are.
      if (good || x == 0) {
        low = std::min(low, n);
        high = std::max(high, n);
        out.multiples[i] = static_cast<int64_t>(n);
      }
    }
    if (!good) out.exceptions.push_back(i);
  }
  if (low > high) low = high = 0;
  if (high - low > kMaxTop) return out;
  out.fits = true;
  out.header.set_low(static_cast<int64_t>(low));
  out.header.top = static_cast<uint64_t>(high - low);
  int64_t before = static_cast<int64_t>(low);
  std::vector<size_t>::const_iterator next = out.exceptions.begin();
  for (size_t i = 0; i < values.size(); ++i) {
    const bool exception = next != out.exceptions.end() && *next == i;
    if (exception) ++next;
    int64_t& n = out.multiples[i];
    if (exception && values[i] != 0) n = before;
    before = n;
  }
  return out;
}

ChannelFit fit_bits(const std::vector<float>& values) {
  ChannelFit out;
  out.header.numbers = ChannelHeader::Numbers::kBinary32;
  for (const float x : values) out.multiples.push_back(ordered_bits(std::bit_cast<uint32_t>(x)));
  const auto [low, high] = std::minmax_element(out.multiples.begin(), out.multiples.end());
  out.fits = true;
  if (values.empty()) return out;
  out.header.set_low(*low);
  out.header.top = static_cast<uint64_t>(*high - *low);
  return out;
}

/// True where exceptions cost less than is saved.
bool pays(const ChannelFit& fit, size_t values) {
  return fit.fits && fit.exceptions.size() * kExceptionBits < values * kSavedBits;
}

// Steps that files are written with: decimals, fractions of integers' ranges, powers of two.
ChannelFit fit_exactly(const std::vector<float>& values) {
  std::vector<double> steps = {1,           1e-1, 1e-2,          1.0 / 255, 1e-3, 1.0 / 4096, 1e-4,
                               1.0 / 65535, 1e-5, 1.0 / 1048576, 1e-6,      1e-7, 1e-8,       1e-9};
  for (const double step : steps) {
    ChannelFit fit = fit_multiples(values, step, 0);
    if (pays(fit, values.size())) return fit;
  }
  return fit_bits(values);
}

ChannelFit fit_within(const std::vector<float>& values, double error) {
  // Rounding to binary32 may take a value past the bound: then it is an exception.
  for (const double share : {2.0, 1.998}) {
    ChannelFit fit = fit_multiples(values, share * error, error);
    if (pays(fit, values.size())) return fit;
  }
  return fit_exactly(values);
}

/// The numbers of an integer type.
ChannelFit fit_integers(const std::vector<int64_t>& values, double error) {
  ChannelFit out;
  out.fits = true;
  const auto step = static_cast<int64_t>(2 * std::min(std::floor(error), 32767.0) + 1);
  out.header.step = static_cast<double>(step);
  for (const int64_t x : values) {
    const int64_t shifted = x + (step - 1) / 2;
    out.multiples.push_back(shifted >= 0 ? shifted / step : -((step - 1 - shifted) / step));
  }
  if (values.empty()) return out;
  const auto [low, high] = std::minmax_element(out.multiples.begin(), out.multiples.end());
  out.header.set_low(*low);
  out.header.top = static_cast<uint64_t>(*high - *low);
  return out;
}

int64_t integer_at(const Attribute& a, size_t i) {
  if (a.type == ValueType::kI32) return a.get<int32_t>(i);
  return size_of(a.type) == 2 ? int64_t{a.get<uint16_t>(i)} : int64_t{a.get<uint8_t>(i)};
}

ChannelFit fit_channel(const Attribute& a, uint32_t channel) {
  const double error = channel_error(a, channel);
  const size_t count = a.values.size() / a.element_bytes();
  if (a.type != ValueType::kBinary32) {
    std::vector<int64_t> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = integer_at(a, i * a.channel_count + channel);
    return fit_integers(values, error);
  }
  std::vector<float> values(count);
  for (size_t i = 0; i < count; ++i) values[i] = a.get<float>(i * a.channel_count + channel);
  return error > 0 ? fit_within(values, error) : fit_exactly(values);
}

}  // namespace

double channel_error(const Attribute& a, uint32_t channel) {
  if (a.max_error.empty()) return 0;
  const double error = a.max_error[channel];
  if (a.type == ValueType::kBinary32) return error;
  const bool normalised = a.type == ValueType::kU8Normalised || a.type == ValueType::kU16Normalised;
  const double whole =
      std::floor(normalised ? error * static_cast<double>(integer_range(a.type).high) : error);
  return whole > 0 ? whole + 0.49 : 0;
}

ChosenNumbers choose_numbers(const Attribute& a) {
  ChosenNumbers out;
  const size_t count = a.values.size() / a.element_bytes();
  out.integers.resize(count * a.channel_count);
  for (uint32_t channel = 0; channel < a.channel_count; ++channel) {
    const ChannelFit fit = fit_channel(a, channel);
    out.channels.push_back(fit.header);
    for (size_t i = 0; i < count; ++i) {
      out.integers[i * a.channel_count + channel] =
          static_cast<uint32_t>(fit.multiples[i] - fit.header.low());
    }
    for (const size_t i : fit.exceptions) {
      const size_t index = i * a.channel_count + channel;
      out.exceptions.push_back({index, a.get<uint32_t>(index)});
    }
  }
  std::sort(out.exceptions.begin(), out.exceptions.end(),
            [](const auto& x, const auto& y) { return x.index < y.index; });
  return out;
}

}  // namespace reeb
