// What `reeb encode` notes in a file of how it was made, and `reeb info` tells.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/enc/encoder.h"

namespace reeb::tools {

/// Key of the metadata entry.
inline constexpr const char* kReportKey = "encoding";

struct EncodingReport {
  std::string target;    ///< "kg", "max-error", "bpvf", "size" or "lossless"
  double wanted = 0;     ///< of the target, in its unit; 0 where it has none
  double kg = 0;         ///< percent
  double rmse = 0;       ///< per vertex, units of the input
  double max_error = 0;  ///< of a coordinate, units of the input
};

/// Value of the entry, as `kg 0.05: kg 0.04987, rmse 0.0012, max-error 0.0101`, and back; false
/// where it is none.
std::string report_text(const EncodingReport& report);
bool parse_report(const std::string& text, EncodingReport& out);

/// Keeps room for the report of an encoding that aims at this: an entry as long as any.
void reserve_report(const EncodingReport& aim, std::map<std::string, std::string>& metadata);

/// Puts the report where room was kept for it. The file does not grow.
Status fill_report(const EncodingReport& report, std::vector<uint8_t>& file);

/// What the file is to say of its target, as that was asked for.
EncodingReport aim_of(const EncodeOptions& aim);

/// Fills the report with the measured errors in `stats`, whose sizes become those of the file.
Status keep_report(EncodingReport report, double vertex_frames, std::vector<uint8_t>& bytes,
                   EncodeStats& stats);

}  // namespace reeb::tools
