#include "tools/encoding_report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "bitstream/container.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr std::array<std::string_view, 5> kTargets{"kg", "max-error", "bpvf", "size", "lossless"};
constexpr std::array<std::pair<std::string_view, double EncodingReport::*>, 3> kErrors{
    {{"kg", &EncodingReport::kg},
     {"rmse", &EncodingReport::rmse},
     {"max-error", &EncodingReport::max_error}}};

/// Takes `word` off the front of `text`.
bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

bool take_number(std::string_view& text, double& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || !std::isfinite(out) || out < 0) return false;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return true;
}

bool take_target(std::string_view& text, EncodingReport& out) {
  const auto* const target = std::find_if(kTargets.begin(), kTargets.end(),
                                          [&](std::string_view t) { return take(text, t); });
  if (target == kTargets.end()) return false;
  out.target = *target;
  return out.target == "lossless" || (take(text, " ") && take_number(text, out.wanted));
}

}  // namespace

std::string report_text(const EncodingReport& report) {
  constexpr int kWantedDigits = 9;  // all of a number of bytes
  std::string out = report.target;
  if (report.target != "lossless") out += " " + brief(report.wanted, kWantedDigits);
  const char* separator = ": ";
  for (const auto& [name, error] : kErrors) {
    out.append(separator).append(name).append(" ").append(brief(report.*error));
    separator = ", ";
  }
  return out;
}

bool parse_report(const std::string& text, EncodingReport& out) {
  out = {};
  std::string_view rest = text;
  if (!take_target(rest, out)) return false;
  std::string_view separator = ": ";
  for (const auto& [name, error] : kErrors) {
    if (!take(rest, separator) || !take(rest, name) || !take(rest, " ") ||
        !take_number(rest, out.*error))
      return false;
    separator = ", ";
  }
  return rest.empty();
}

void reserve_report(const EncodingReport& aim, std::map<std::string, std::string>& metadata) {
  constexpr double kLongest = 1.234e-300;  // as text
  EncodingReport longest = aim;
  for (const auto& [name, error] : kErrors) longest.*error = kLongest;
  metadata[kReportKey] = report_text(longest);
}

Status fill_report(const EncodingReport& report, std::vector<uint8_t>& file) {
  std::vector<uint8_t> filled;
  Status status = add_metadata(file, {{kReportKey, report_text(report)}}, filled);
  if (status.ok()) file = std::move(filled);
  return status;
}

EncodingReport aim_of(const EncodeOptions& aim) {
  EncodingReport out;
  switch (aim.target) {
    case Target::kKg:
      out.target = "kg";
      break;
    case Target::kMaxError:
      out.target = "max-error";
      break;
    case Target::kBpvf:
      out.target = "bpvf";
      break;
    case Target::kSize:
      out.target = "size";
      break;
    case Target::kLossless:
      out.target = "lossless";
      break;
  }
  if (aim.target != Target::kLossless) out.wanted = aim.target_value;
  return out;
}

Status keep_report(EncodingReport report, double vertex_frames, std::vector<uint8_t>& bytes,
                   EncodeStats& stats) {
  report.kg = stats.kg;
  report.rmse = stats.rmse;
  report.max_error = stats.max_error;
  if (Status s = fill_report(report, bytes); !s.ok()) return s;
  stats.bytes = bytes.size();
  stats.bpvf = 8 * static_cast<double>(bytes.size()) / vertex_frames;
  stats.sections.clear();
  ContainerReader container;
  if (!container.parse(bytes, Limits{}).ok()) return {};
  for (const auto& [name, size] : container.sections)
    stats.sections.push_back({name, 8 * static_cast<double>(size)});
  return {};
}

}  // namespace reeb::tools
