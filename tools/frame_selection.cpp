#include "tools/frame_selection.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <span>
#include <string_view>

#include "tools/text.h"

namespace reeb::tools {
namespace {

// A frame number, or 0 for nothing.
bool parse_number(std::string_view text, uint32_t& frame) {
  frame = 0;
  if (text.empty()) return true;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  return error == std::errc() && stop == text.data() + text.size() && frame > 0;
}

void append_range(uint32_t first, uint32_t last, std::vector<uint32_t>& out) {
  for (uint32_t t = first;; first < last ? ++t : --t) {
    out.push_back(t);
    if (t == last) return;
  }
}

/// Calls visit(shot, frame of the shot, first of a run of frames of that shot) for every number.
template <class Visit>
void visit_frames(const Sequence& sequence, const std::vector<uint32_t>& numbers,
                  const Visit& visit) {
  size_t current = SIZE_MAX;
  for (const uint32_t number : numbers) {
    uint32_t frame = number - 1;
    size_t shot = 0;
    for (; frame >= sequence.shots[shot].frame_count; ++shot) {
      frame -= sequence.shots[shot].frame_count;
    }
    visit(shot, frame, shot != current);
    current = shot;
  }
}

void append(std::span<const float> values, std::vector<float>& out) {
  out.insert(out.end(), values.begin(), values.end());
}

// All but the values of frames.
void begin_shot(const Shot& from, Shot& to) {
  to.connectivity = from.connectivity;
  to.attributes = from.attributes;
  for (Attribute& a : to.attributes) {
    if (a.animated) a.values.clear();
  }
}

void append_attributes(const Shot& from, uint32_t frame, Shot& to) {
  for (size_t i = 0; i < from.attributes.size(); ++i) {
    const Attribute& a = from.attributes[i];
    if (!a.animated) continue;
    const size_t size = from.element_count(a.domain) * a.element_bytes();
    const auto first = a.values.begin() + static_cast<std::ptrdiff_t>(frame * size);
    auto& values = to.attributes[i].values;
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(size));
  }
}

}  // namespace

std::string FrameSelection::parse(const std::string& text, FrameSelection& out) {
  out.ranges_.clear();
  std::string_view rest(text);
  for (bool more = true; more;) {
    const size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    const size_t colon = part.find(':');
    Range range;
    bool good = !part.empty() && parse_number(part.substr(0, colon), range.first);
    if (colon == part.npos) {
      range.last = range.first;
    } else {
      good = good && parse_number(part.substr(colon + 1), range.last);
    }
    if (!good) return "'" + text + "' does not name frames from 1, as in 7, 10:20 or 1,20,30:";
    out.ranges_.push_back(range);
    more = comma != rest.npos;
    rest.remove_prefix(more ? comma + 1 : rest.size());
  }
  return {};
}

Status FrameSelection::numbers(uint32_t count, std::vector<uint32_t>& out) const {
  out.clear();
  if (count == 0) return Status::invalid("there are no frames");
  if (empty()) append_range(1, count, out);
  for (const Range& range : ranges_) {
    const uint32_t first = range.first == 0 ? 1 : range.first;
    const uint32_t last = range.last == 0 ? count : range.last;
    if (std::max(first, last) > count) {
      return Status::invalid("frame " + grouped(std::max(first, last)) +
                             " does not exist; there are frames 1 to " + grouped(count));
    }
    append_range(first, last, out);
  }
  return {};
}

CLI::Option* add_frames_option(CLI::App& command, FrameSelection& selection,
                               const std::string& unless) {
  return command
      .add_option_function<std::string>(
          "--frames",
          [&selection](const std::string& text) {
            const std::string wrong = FrameSelection::parse(text, selection);
            if (!wrong.empty()) throw CLI::ValidationError("--frames", wrong);
          },
          "Frames from 1: one 7, a range 10:20, 10:, :20, backwards 20:10, several 1,20,30:40; "
          "default " +
              unless)
      ->type_name("LIST");
}

bool ascending(const std::vector<uint32_t>& numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) ==
         numbers.end();
}

Sequence pick_frames(const Sequence& sequence, const std::vector<uint32_t>& numbers) {
  Sequence out;
  out.frame_rate = sequence.frame_rate;
  out.metadata = sequence.metadata;
  out.start_time = sequence.start_time;
  out.resources = sequence.resources;
  if (ascending(numbers) && !numbers.empty()) out.start_time += numbers.front() - 1;
  visit_frames(sequence, numbers, [&](size_t shot, uint32_t frame, bool first) {
    const Shot& from = sequence.shots[shot];
    if (first) begin_shot(from, out.shots.emplace_back());
    append(from.frame(frame), out.shots.back().positions);
    append_attributes(from, frame, out.shots.back());
    ++out.shots.back().frame_count;
  });
  return out;
}

Remainders pick_remainders(const Sequence& sequence, const Remainders& remainders,
                           const std::vector<uint32_t>& numbers) {
  Remainders out;
  if (remainders.empty()) return out;
  visit_frames(sequence, numbers, [&](size_t shot, uint32_t frame, bool first) {
    if (first) out.emplace_back();
    if (remainders[shot].empty()) return;
    const size_t size = size_t{3} * sequence.shots[shot].connectivity.vertex_count;
    append(std::span(remainders[shot]).subspan(frame * size, size), out.back());
  });
  return out;
}

}  // namespace reeb::tools
