#include "tools/io/frame_order.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "tools/io/text_number.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

/// How numbers in names are to be understood.
struct Reading {
  bool glued_signs;  ///< a minus belongs to the number behind it, even behind a letter or digit
  bool decimals;     ///< a point between digits is that of a decimal
};

struct Number {
  bool negative = false;
  std::string whole;     ///< digits
  std::string fraction;  ///< digits behind the point
  size_t begin = 0;      ///< in the name, with the sign
  size_t end = 0;

  /// Rounded.
  double value() const {
    const double magnitude = std::stod("0" + whole + "." + fraction + "0");
    return negative ? -magnitude : magnitude;
  }
};

struct Name {
  std::string text;
  std::string mould;  ///< the text with # for each number
  std::vector<Number> numbers;
};

bool digit_at(const std::string& text, size_t i) { return i < text.size() && is_digit(text[i]); }

size_t digits_end(const std::string& text, size_t i) {
  while (digit_at(text, i)) ++i;
  return i;
}

// A point with digits on both sides; not in 1.2.3, which is no decimal.
bool has_fraction(const std::string& text, size_t begin, size_t end) {
  const auto point_in_digits = [&](size_t at) {
    return at > 0 && at < text.size() && text[at] == '.' && digit_at(text, at - 1) &&
           digit_at(text, at + 1);
  };
  return point_in_digits(end) && !point_in_digits(digits_end(text, end + 1)) &&
         (begin == 0 || !point_in_digits(begin - 1));
}

Name parse(const std::string& text, Reading reading) {
  Name out{text, {}, {}};
  for (size_t i = 0; i < text.size();) {
    if (!is_digit(text[i])) {
      out.mould += text[i++];
      continue;
    }
    Number number;
    number.begin = i;
    number.end = digits_end(text, i);
    number.whole = text.substr(i, number.end - i);
    if (reading.decimals && has_fraction(text, i, number.end)) {
      const size_t end = digits_end(text, number.end + 1);
      number.fraction = text.substr(number.end + 1, end - number.end - 1);
      number.end = end;
    }
    const bool glued = i > 1 && std::isalnum(static_cast<unsigned char>(text[i - 2]));
    number.negative = i > 0 && text[i - 1] == '-' && (reading.glued_signs || !glued);
    if (number.negative) {
      out.mould.pop_back();
      --number.begin;
    }
    out.mould += '#';
    i = number.end;
    out.numbers.push_back(std::move(number));
  }
  return out;
}

std::string without_zeros(const std::string& digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1));
}

int compare_digits(const std::string& a, const std::string& b) {
  const std::string x = without_zeros(a);
  const std::string y = without_zeros(b);
  if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
  return x.compare(y);
}

int compare_fractions(const std::string& a, const std::string& b) {
  const size_t size = std::max(a.size(), b.size());
  return (a + std::string(size - a.size(), '0')).compare(b + std::string(size - b.size(), '0'));
}

int compare(const Number& a, const Number& b) {
  const auto is_zero = [](const Number& n) {
    return (n.whole + n.fraction).find_first_not_of('0') == std::string::npos;
  };
  if (is_zero(a) && is_zero(b)) return 0;
  if (a.negative != b.negative) return a.negative ? -1 : 1;
  const int whole = compare_digits(a.whole, b.whole);
  const int magnitude = whole != 0 ? whole : compare_fractions(a.fraction, b.fraction);
  return a.negative ? -magnitude : magnitude;
}

int compare(const Name& a, const Name& b) {
  for (size_t i = 0; i < a.numbers.size(); ++i) {
    if (const int order = compare(a.numbers[i], b.numbers[i]); order != 0) return order;
  }
  return 0;
}

/// All names, in the order that a reading gives them.
class Sequel {
 public:
  Sequel(const std::vector<std::string>& texts, Reading reading) {
    for (const std::string& text : texts) names_.push_back(parse(text, reading));
    uniform_ = std::all_of(names_.begin(), names_.end(),
                           [&](const Name& n) { return n.mould == names_[0].mould; });
    if (!uniform_) return;
    std::stable_sort(names_.begin(), names_.end(),
                     [](const Name& a, const Name& b) { return compare(a, b) < 0; });
    gap_ = find_gap(0, names_.size(), 0);
  }

  /// True where the names differ in nothing but numbers.
  bool uniform() const { return uniform_; }
  const std::vector<Name>& names() const { return names_; }
  const std::string& gap() const { return gap_; }

  bool same_order(const Sequel& other) const {
    return std::equal(names_.begin(), names_.end(), other.names_.begin(), other.names_.end(),
                      [](const Name& a, const Name& b) { return a.text == b.text; });
  }

  std::string duplicates() const {
    const auto twice =
        std::adjacent_find(names_.begin(), names_.end(),
                           [](const Name& a, const Name& b) { return compare(a, b) == 0; });
    if (twice == names_.end()) return {};
    return twice->text + " and " + twice[1].text + ": two files have one frame number";
  }

  // Whether a number that varies is negative in all names: then the minus may be meant as a dash.
  std::string negatives() const {
    for (size_t i = 0; i < names_[0].numbers.size(); ++i) {
      const bool all = std::all_of(names_.begin(), names_.end(),
                                   [&](const Name& n) { return n.numbers[i].negative; });
      if (!all || compare(names_[0].numbers[i], names_.back().numbers[i]) == 0) continue;
      return names_[0].text + " to " + names_.back().text +
             ": taken for negative numbers; name the files one by one for another order";
    }
    return {};
  }

 private:
  // The first gap in number `place`, or in those behind it, of names [first, last), which agree in
  // all numbers before.
  std::string find_gap(size_t first, size_t last, size_t place) const {
    if (last - first < 2 || place == names_[0].numbers.size()) return {};
    std::vector<size_t> starts{first};
    for (size_t i = first + 1; i < last; ++i) {
      const bool same = compare(names_[i - 1].numbers[place], names_[i].numbers[place]) == 0;
      if (!same) starts.push_back(i);
    }
    const double step = step_between(starts, place);
    starts.push_back(last);
    for (size_t i = 0; i + 1 < starts.size(); ++i) {
      if (i > 0 && difference(starts[i] - 1, starts[i], place) > 1.5 * step) {
        return missing(starts[i] - 1, starts[i], place);
      }
      std::string behind = find_gap(starts[i], starts[i + 1], place + 1);
      if (!behind.empty()) return behind;
    }
    return {};
  }

  double difference(size_t a, size_t b, size_t place) const {
    return names_[b].numbers[place].value() - names_[a].numbers[place].value();
  }

  // Whole numbers count by one, decimals by their smallest difference.
  double step_between(const std::vector<size_t>& starts, size_t place) const {
    double step = HUGE_VAL;
    bool whole = true;
    for (size_t i = 1; i < starts.size(); ++i) {
      const Number& number = names_[starts[i]].numbers[place];
      if (number.whole.size() > 15) return HUGE_VAL;  // beyond what can be subtracted
      whole =
          whole && number.fraction.empty() && names_[starts[i] - 1].numbers[place].fraction.empty();
      step = std::min(step, difference(starts[i] - 1, starts[i], place));
    }
    return whole ? 1 : step;
  }

  std::string missing(size_t before, size_t after, size_t place) const {
    const Name& name = names_[before];
    const Number& number = name.numbers[place];
    const std::string between = " is missing between " + name.text + " and " + names_[after].text +
                                "; restore it, or pass --allow-gaps to go on without it";
    if (!number.fraction.empty() || !names_[after].numbers[place].fraction.empty()) {
      return "a frame" + between;
    }
    const auto next = static_cast<int64_t>(number.value()) + 1;
    std::string digits = std::to_string(next < 0 ? -next : next);
    const bool padded = number.whole.size() > 1 && number.whole[0] == '0';
    if (padded && digits.size() < number.whole.size()) {
      digits.insert(0, number.whole.size() - digits.size(), '0');
    }
    const std::string file = name.text.substr(0, number.begin) + (next < 0 ? "-" : "") + digits +
                             name.text.substr(number.end);
    return file + ": frame " + std::to_string(next) + between;
  }

  std::vector<Name> names_;
  bool uniform_ = false;
  std::string gap_;
};

// Whether digits behind points are those of decimals. Where some are more than others, 05 is no
// whole number, and 10 no decimal, which would be written 1.
enum class Fractions { kDecimal, kWhole, kUnclear };
Fractions judge_fractions(const std::vector<Name>& names) {
  bool leading = false;
  bool trailing = false;
  for (const Name& name : names) {
    for (const Number& number : name.numbers) {
      leading = leading || (number.fraction.size() > 1 && number.fraction.front() == '0');
      trailing = trailing || (number.fraction.size() > 1 && number.fraction.back() == '0');
    }
  }
  if (leading != trailing) return leading ? Fractions::kDecimal : Fractions::kWhole;
  return Fractions::kUnclear;
}

FrameOrder describe(const Sequel& sequel) {
  FrameOrder out;
  for (const Name& name : sequel.names()) out.files.emplace_back(name.text);
  out.doubt = sequel.duplicates();
  out.gap = sequel.gap();
  out.note = sequel.negatives();
  return out;
}

// One of the two readings of points is uniform at least.
FrameOrder choose(const Sequel& decimal, const Sequel& whole) {
  if (!whole.uniform()) return describe(decimal);
  if (!decimal.uniform()) return describe(whole);
  const auto plausible = [](const Sequel& s) { return s.gap().empty() && s.duplicates().empty(); };
  if (decimal.same_order(whole)) return describe(plausible(decimal) ? decimal : whole);
  if (plausible(decimal) != plausible(whole)) {
    return describe(plausible(decimal) ? decimal : whole);
  }
  const Fractions fractions = judge_fractions(decimal.names());
  FrameOrder out = describe(fractions == Fractions::kWhole ? whole : decimal);
  if (fractions == Fractions::kUnclear) {
    out.doubt = decimal.names().front().text + " to " + decimal.names().back().text +
                ": the numbers may be decimals or not, which gives two orders";
  }
  return out;
}

// Names that differ in more than numbers: some of one sequence and a stray, or no sequence at all.
FrameOrder order_apart(std::vector<std::string> texts) {
  std::sort(texts.begin(), texts.end(), natural_less);
  std::vector<std::string> moulds;
  std::map<std::string, size_t> sizes;
  for (const std::string& text : texts) {
    const Name name = parse(text, {.glued_signs = false, .decimals = true});
    moulds.push_back(name.mould);
    sizes[name.mould] += !name.numbers.empty();
  }
  const auto largest = std::max_element(
      sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  FrameOrder out;
  out.files.assign(texts.begin(), texts.end());
  if (largest->second < 2) return out;
  size_t stray = 0;
  while (moulds[stray] == largest->first) ++stray;
  const auto one = std::find(moulds.begin(), moulds.end(), largest->first) - moulds.begin();
  out.doubt = texts[stray] + ": not named like " + texts[static_cast<size_t>(one)] + " and " +
              grouped(largest->second - 1) + " more";
  return out;
}

/// Runs of digits and runs of other characters, in turn.
std::vector<std::string> pieces(const std::string& text) {
  std::vector<std::string> out;
  for (size_t i = 0; i < text.size();) {
    size_t end = i + 1;
    while (end < text.size() && is_digit(text[end]) == is_digit(text[i])) ++end;
    out.push_back(text.substr(i, end - i));
    i = end;
  }
  return out;
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  const std::vector<std::string> x = pieces(a);
  const std::vector<std::string> y = pieces(b);
  for (size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const bool numbers = is_digit(x[i][0]) && is_digit(y[i][0]);
    const int order = numbers ? compare_digits(x[i], y[i]) : x[i].compare(y[i]);
    if (order != 0) return order < 0;
  }
  return x.size() != y.size() ? x.size() < y.size() : a < b;
}

FrameOrder order_by_name(const std::vector<fs::path>& files) {
  std::vector<std::string> texts;
  texts.reserve(files.size());
  for (const fs::path& file : files) texts.push_back(file.string());
  if (texts.size() < 2) return {files, {}, {}, {}};
  for (const bool glued_signs : {false, true}) {
    const Sequel decimal(texts, {.glued_signs = glued_signs, .decimals = true});
    const Sequel whole(texts, {.glued_signs = glued_signs, .decimals = false});
    if (decimal.uniform() || whole.uniform()) return choose(decimal, whole);
  }
  return order_apart(std::move(texts));
}

}  // namespace reeb::tools
