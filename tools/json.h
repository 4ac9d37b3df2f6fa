// JSON for other programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace reeb::tools {

using Json = nlohmann::ordered_json;

/// Bytes of names and metadata that are not UTF-8 are replaced.
inline std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace reeb::tools
