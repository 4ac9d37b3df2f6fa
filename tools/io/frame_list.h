// From what the user typed to the files of a sequence, in order.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

/// Exactly one of `meshes` (one file per frame, or one beside `cache`) and `stream` is filled.
struct InputFiles {
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path cache;     ///< a point cache over the one mesh; empty where there is none
  std::filesystem::path stream;    ///< a `.reeb` file, "-" for standard input
  std::vector<std::string> notes;  ///< on the order of the files
};

/// `inputs`: a folder; a pattern (`walk/*.obj`, `f_%04d.ply`); mesh files; a mesh and a point
/// cache; a point cache with a mesh of the same name beside it; one `.reeb` file or "-".
///
/// Names are taken as they stand where something has them, whatever characters are in them.
///
/// The files of a folder or a pattern are put in the order of the numbers in their names (see
/// frame_order.h); where one is not named like the others that is an error. Files named one by one
/// keep their order, unless they come as a shell sorts them (1, 10, 2): then the numbers count
/// here, too. Where a number skips, the message names the first missing file, unless `allow_gaps`.
Status find_input(const std::vector<std::string>& inputs, bool allow_gaps, InputFiles& out);

/// A printf pattern with one %d or %0Nd in its last name, or else in a folder, split at it.
struct NumberPattern {
  std::string prefix;
  std::string suffix;
  size_t digits = 0;  ///< at least so many characters, filled with zeros

  /// False where `text` has no such field, or more than one.
  static bool parse(const std::string& text, NumberPattern& out);
  std::string name(int64_t number) const;
  bool matches(const std::string& text) const;
};

}  // namespace reeb::tools
