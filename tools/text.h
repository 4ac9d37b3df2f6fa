// Numbers and names as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace reeb::tools {

/// 4210 -> "4,210".
std::string grouped(uint64_t value);

/// Up to `digits` significant digits, without trailing zeros; "inf" and "nan" as such.
std::string brief(double value, int digits = 4);

/// The same as people write it: "3,010", "0.00005"; exponents only below 1e-6 and from 1e15 on.
std::string plain(double value, int digits = 4);

/// "1 frame", "2 frames", "2 vertices": `noun` in the singular.
std::string counted(uint64_t value, const std::string& noun);

/// 1234567 -> "1.23 MB"; decimal units.
std::string byte_size(uint64_t bytes);

}  // namespace reeb::tools
