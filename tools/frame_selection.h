// Frames as the user names them, in every command alike.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "tools/remainders.h"

namespace reeb::tools {

/// Numbers from 1 and ranges of them: "7", "10:20", "10:", ":20", backwards "20:10", "1,20,30:40".
class FrameSelection {
 public:
  /// Empty where `text` is good, what is wrong otherwise.
  static std::string parse(const std::string& text, FrameSelection& out);

  /// True where nothing was selected, which means all frames.
  bool empty() const { return ranges_.empty(); }

  /// The numbers of the frames, from 1, in the order named. Fails where one is beyond `count`.
  Status numbers(uint32_t count, std::vector<uint32_t>& out) const;

 private:
  struct Range {
    uint32_t first = 0, last = 0;  ///< 0 = an end left open
  };
  std::vector<Range> ranges_;
};

/// --frames; `unless` says what happens without it.
CLI::Option* add_frames_option(CLI::App& command, FrameSelection& selection,
                               const std::string& unless);

/// True where each number is above the one before.
bool ascending(const std::vector<uint32_t>& numbers);

/// The frames of `sequence` that `numbers` name, from 1, in that order. Ascending ones keep their
/// times; others are a new sequence from the same start.
Sequence pick_frames(const Sequence& sequence, const std::vector<uint32_t>& numbers);

/// The same for what belongs to the positions of `sequence`.
Remainders pick_remainders(const Sequence& sequence, const Remainders& remainders,
                           const std::vector<uint32_t>& numbers);

}  // namespace reeb::tools
