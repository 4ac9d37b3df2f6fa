// The order of frames by the numbers in the names of their files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace reeb::tools {

/// What the names of some files say of their order. The sentences are empty where there is nothing
/// to say.
struct FrameOrder {
  std::vector<std::filesystem::path> files;
  std::string doubt;  ///< why the names may mean another order, or are not those of one sequence
  std::string gap;    ///< the first number that is missing
  std::string note;   ///< how the names were understood, where that is not plain
};

/// Orders files by all numbers in their names, the leftmost first. A number may be negative and may
/// be a decimal, as a time is, where the names together show that it is: `f_-1` comes before `f_0`,
/// `t_0.0005` before `t_0.001`, but `take1.9` before `take1.10`.
FrameOrder order_by_name(const std::vector<std::filesystem::path>& files);

/// True where a comes before b, whole numbers in the names compared by value.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace reeb::tools
