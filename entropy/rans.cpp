#include "entropy/rans.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "entropy/integer_coder.h"

namespace reeb {

namespace {

constexpr uint32_t kWhole = 1u << kRansBits;
constexpr uint32_t kLowest = 1u << 16;  // states are kept at or above

/// Syntax of the frequencies, for both directions: classes one after another, each the number of
/// its symbols, how coarse the frequencies are, then all of them but that of the first symbol,
/// which is what they leave. A frequency is near that of the symbol of the other sign, those of the
/// symbols before and those of the class before, which tell its context.
class TableSyntax {
 public:
  template <class Coder>
  bool code(Coder& coder, RansTables& tables) {
    for (RansFrequencies& f : tables) {
      const auto last = std::find_if(f.rbegin(), f.rend(), [](uint16_t x) { return x > 0; });
      const uint32_t count = count_.code(coder, static_cast<uint32_t>(f.rend() - last));
      if (count > kRansSymbols) return false;
      if (count > 0 && !code_class(coder, count, f)) return false;
    }
    return true;
  }

 private:
  template <class Coder>
  bool code_class(Coder& coder, uint32_t count, RansFrequencies& f) {
    const uint32_t shift = shift_.code(coder, shift_of(f));
    if (shift >= kRansBits) return false;
    uint32_t sum = 0;
    for (uint32_t s = 1; s < count; ++s) {
      const uint32_t places = (expected(f, s) + (1u << shift) - 1) >> shift;
      ExpGolombModel& model = place_[s % 2][std::bit_width(places)];
      const uint32_t place = model.code(coder, f[s] == 0 ? 0 : ((f[s] - 1u) >> shift) + 1);
      if (place > kWhole) return false;
      const uint32_t frequency = place == 0 ? 0 : ((place - 1) << shift) + 1;
      if (frequency > kWhole - sum) return false;
      f[s] = static_cast<uint16_t>(frequency);
      sum += frequency;
    }
    f[0] = static_cast<uint16_t>(kWhole - sum);
    before_ = f;
    return true;
  }

  /// The frequencies of a class, but for the first, are 0 or a multiple of 2^shift plus 1.
  static uint32_t shift_of(const RansFrequencies& f) {
    uint32_t bits = kWhole / 2;
    for (uint32_t s = 1; s < kRansSymbols; ++s) bits |= f[s] == 0 ? 0 : f[s] - 1u;
    return static_cast<uint32_t>(std::countr_zero(bits));
  }

  /// What frequency s is likely to be, from those before it.
  uint32_t expected(const RansFrequencies& f, uint32_t s) const {
    if (s % 2 == 0) return (3u * f[s - 1] + before_[s]) / 4;
    const uint32_t same = (before_[s] + before_[s + 1] + 0u) / 2;
    return s == 1 ? same : ((f[s - 2] + f[s - 1] + 0u) / 2 + same) / 2;
  }

  ExpGolombModel count_, shift_;
  std::array<std::array<ExpGolombModel, kRansBits + 2>, 2> place_;
  RansFrequencies before_{};
};

/// About how many bits the class takes with these frequencies, its part of the tables included.
double class_bits(const RansCounts& counts, const RansFrequencies& f, uint32_t shift) {
  double bits = 0;
  for (uint32_t s = 0; s < kRansSymbols; ++s) {
    if (counts[s] == 0) continue;
    bits -= counts[s] * std::log2(static_cast<double>(f[s]) / kWhole);
    if (s > 0) bits += 2 + std::log2(((f[s] - 1u) >> shift) + 1);
  }
  return bits;
}

void append_word(std::vector<uint8_t>& out, uint32_t x) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<uint8_t>(x >> (8 * i)));
}

uint32_t read_u32(const uint8_t* at) {
  return at[0] | uint32_t{at[1]} << 8 | uint32_t{at[2]} << 16 | uint32_t{at[3]} << 24;
}

}  // namespace

RansFrequencies rans_frequencies(const RansCounts& counts) {
  const uint64_t all = std::accumulate(counts.begin(), counts.end(), uint64_t{0});
  RansFrequencies out{};
  if (all == 0) return out;
  uint32_t sum = 0;
  for (uint32_t s = 0; s < kRansSymbols; ++s) {
    if (counts[s] == 0) continue;
    out[s] = static_cast<uint16_t>(std::max<uint64_t>(1, (counts[s] * uint64_t{kWhole}) / all));
    sum += out[s];
  }
  for (; sum > kWhole; --sum) --*std::max_element(out.begin(), out.end());
  uint16_t& most = *std::max_element(out.begin(), out.end());
  most = static_cast<uint16_t>(most + kWhole - sum);
  return out;
}

void coarsen(uint32_t shift, RansFrequencies& f) {
  const bool zero_occurs = f[0] > 0;
  uint32_t sum = 0;
  for (uint32_t s = 1; s < kRansSymbols; ++s) {
    if (f[s] == 0) continue;
    const uint32_t place = (f[s] - 1u + (1u << shift) / 2) >> shift;
    f[s] = static_cast<uint16_t>((place << shift) + 1);
    sum += f[s];
  }
  const uint32_t most = zero_occurs ? kWhole - 1 : kWhole;
  for (; sum > most; sum -= 1u << shift) {
    uint16_t& largest = *std::max_element(f.begin() + 1, f.end());
    largest = static_cast<uint16_t>(largest - (1u << shift));
  }
  f[0] = static_cast<uint16_t>(kWhole - sum);
}

RansTables RansEncoder::tables() const {
  std::vector<RansCounts> counts(kRansClasses);
  for (const Item& item : items_) ++counts[item.cls][rans_symbol(item.n)];
  RansTables out;
  for (const RansCounts& c : counts) {
    const RansFrequencies exact = rans_frequencies(c);
    RansFrequencies& best = out.emplace_back(exact);
    if (exact == RansFrequencies{}) continue;
    double least = class_bits(c, exact, 0);
    for (uint32_t shift = 1; shift < kRansBits; ++shift) {
      RansFrequencies f = exact;
      coarsen(shift, f);
      const double bits = class_bits(c, f, shift);
      if (bits >= least) continue;
      least = bits;
      best = f;
    }
  }
  return out;
}

std::vector<uint8_t> RansEncoder::finish() const {
  RansTables tables = this->tables();
  BinaryEncoder table_coder;
  TableSyntax().code(table_coder, tables);
  std::vector<std::array<uint32_t, kRansSymbols>> starts(tables.size());
  for (size_t c = 0; c < tables.size(); ++c)
    std::exclusive_scan(tables[c].begin(), tables[c].end(), starts[c].begin(), 0u);
  RawBitWriter raw;
  for (const Item& item : items_) {
    const auto magnitude = static_cast<uint32_t>(item.n < 0 ? -item.n : item.n);
    const uint32_t b = RansBuckets::of(magnitude);
    raw.code(magnitude - RansBuckets::begin(b), RansBuckets::extra_bits(b));
  }
  std::array<uint32_t, kRansLanes> state;
  state.fill(kLowest);
  std::vector<uint16_t> words;  // last first
  for (size_t i = items_.size(); i-- > 0;) {
    const Item& item = items_[i];
    uint32_t& x = state[item.lane];
    const uint32_t symbol = rans_symbol(item.n);
    const uint32_t frequency = tables[item.cls][symbol];
    if (x >> (32 - kRansBits) >= frequency) {
      words.push_back(static_cast<uint16_t>(x));
      x >>= 16;
    }
    x = (x / frequency << kRansBits) + x % frequency + starts[item.cls][symbol];
  }
  const std::vector<uint8_t> table_bytes = table_coder.finish();
  const std::vector<uint8_t> raw_bytes = raw.finish();
  std::vector<uint8_t> out;
  append_word(out, static_cast<uint32_t>(table_bytes.size()));
  append_word(out, static_cast<uint32_t>(raw_bytes.size()));
  out.insert(out.end(), table_bytes.begin(), table_bytes.end());
  out.insert(out.end(), raw_bytes.begin(), raw_bytes.end());
  for (uint32_t l = 0; l < lanes_; ++l) append_word(out, state[l]);
  for (size_t i = words.size(); i-- > 0;) {
    out.push_back(static_cast<uint8_t>(words[i]));
    out.push_back(static_cast<uint8_t>(words[i] >> 8));
  }
  return out;
}

bool RansDecoder::open(std::span<const uint8_t> section, uint32_t lanes) {
  constexpr size_t kFront = 8;
  if (section.size() < kFront) return false;
  const uint64_t table_bytes = read_u32(section.data());
  const uint64_t raw_bytes = read_u32(section.data() + 4);
  const uint64_t fixed = kFront + table_bytes + raw_bytes + uint64_t{4} * lanes;
  if (fixed > section.size() || (section.size() - fixed) % 2 != 0) return false;
  BinaryDecoder table_coder(section.subspan(kFront, table_bytes));
  RansTables tables(kRansClasses);
  if (!TableSyntax().code(table_coder, tables) || table_coder.overrun()) return false;
  slots_.assign(size_t{kRansClasses} << kRansBits, kWhole);  // of a class not there: always 0
  for (size_t c = 0; c < tables.size(); ++c) {
    uint32_t* slot = &slots_[c << kRansBits];
    for (uint32_t s = 0; s < kRansSymbols; ++s) {
      for (uint32_t i = 0; i < tables[c][s]; ++i) *slot++ = s << 24 | i << 12 | tables[c][s];
    }
  }
  raw_ = RawBitReader(section.subspan(kFront + table_bytes, raw_bytes));
  const uint8_t* at = section.data() + kFront + table_bytes + raw_bytes;
  cursor_ = {};
  for (uint32_t l = 0; l < lanes; ++l, at += 4) cursor_.state[l] = read_u32(at);
  cursor_.end = (section.size() - fixed) / 2;
  words_.assign(cursor_.end + kRansLanes, 0);
  for (size_t i = 0; i < cursor_.end; ++i, at += 2)
    words_[i] = static_cast<uint16_t>(at[0] | at[1] << 8);
  cursor_.slots = slots_.data();
  cursor_.words = words_.data();
  overrun_ = false;
  return true;
}

int32_t RansDecoder::large(uint32_t symbol) {
  const uint32_t b = rans_symbol_bucket(symbol);
  const uint32_t size = RansBuckets::begin(b) + raw_.code(0, RansBuckets::extra_bits(b));
  const auto magnitude = static_cast<int32_t>(size);
  return symbol % 2 == 1 ? -magnitude : magnitude;
}

}  // namespace reeb
