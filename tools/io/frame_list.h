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
  std::filesystem::path cache;   ///< a point cache over the one mesh; empty where there is none
  std::filesystem::path stream;  ///< a `.reeb` file, "-" for standard input
};

/// `inputs`: a folder; a pattern (`walk/*.obj`, `f_%04d.ply`); mesh files; a mesh and a point
/// cache; a point cache with a mesh of the same name beside it; one `.reeb` file or "-".
///
/// Several files are put in natural numeric order (2 before 10). Where the names differ in one
/// number and it skips, the message names the first missing file, unless `allow_gaps`.
Status find_input(const std::vector<std::string>& inputs, bool allow_gaps, InputFiles& out);

/// True where a comes before b, numbers in the names compared by value.
bool natural_less(const std::string& a, const std::string& b);

/// A printf pattern with one %d or %0Nd split at it.
struct NumberPattern {
  std::string prefix;
  std::string suffix;
  size_t digits = 0;  ///< at least so many, filled with zeros

  /// False where `text` has no such field, or more than one.
  static bool parse(const std::string& text, NumberPattern& out);
  std::string name(int64_t number) const;
  bool matches(const std::string& text) const;
};

}  // namespace reeb::tools
