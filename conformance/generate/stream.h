// Conformance streams, as the generator makes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace reeb::conformance {

using Bytes = std::vector<uint8_t>;

struct Stream {
  std::string kind;      ///< folder: core, uncommon or faulty
  std::string name;      ///< of the file, without ending
  std::string sentence;  ///< what it is for
  Bytes bytes;
  std::string status = "ok";  ///< what a decoder must say of it
};

/// What the product's encoder makes of procedural meshes.
std::vector<Stream> encoded_streams();
/// Odd meshes and random sections, which pin what the encoder's streams leave open.
std::vector<Stream> pinning_streams();
/// The same with attributes.
std::vector<Stream> attribute_streams();
/// What it never writes but the syntax allows, put together from the syntax structures.
std::vector<Stream> built_streams();

}  // namespace reeb::conformance
