// Sequences in any format the tools read.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/dec/decoder.h"
#include "tools/remainders.h"

namespace reeb::tools {

struct ReadOptions {
  unsigned threads = 0;                       ///< 0 = all cores
  uint64_t max_memory = Limits().max_memory;  ///< bytes that decoding may take
  bool allow_gaps = false;                    ///< a missing frame number is not an error
  bool list_order = false;  ///< OBJ: the order of its lists is kept, as `vt.index` and `vn.index`
  bool embed = false;       ///< OBJ: material texts and textures become resources
  /// Called with the done part in [0,1]. May be empty.
  std::function<void(double)> progress = {};
};

struct ReadReport {
  std::vector<std::string> notes;    ///< sentences for the user, e.g. where a new reference starts
  std::optional<StreamInfo> stream;  ///< filled where the input is a `.reeb` stream
  Remainders remainders;             ///< where binary32 does not hold what the files say
  double largest_remainder = 0;
  /// Frames that a damaged or truncated stream did not give; those after them close up.
  std::vector<StreamInfo::Gap> missing;
};

/// Reads what `inputs` name (see `find_input`). A new shot starts where the connectivity or the
/// vertex count changes. The message of a failure names the file, the frame and the remedy.
Status read_sequence(const std::vector<std::string>& inputs, const ReadOptions& options,
                     Sequence& out, ReadReport& report);

/// Why a stream is not decoded, with its name, and with what to do where it is for want of memory.
Status stream_failure(const std::string& name, const Status& status, uint64_t max_memory);

}  // namespace reeb::tools
