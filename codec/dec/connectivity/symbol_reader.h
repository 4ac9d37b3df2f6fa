// The symbols of an edgebreaker (Rossignac 1999): how each triangle joins those before it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bitstream/bytes.h"
#include "codec/dec/connectivity/ans.h"
#include "entropy/raw_bits.h"

namespace reeb {

enum class Symbol : uint8_t { kClose, kSplit, kLeft, kRight, kEnd };

/// How symbols are coded: one after another, or in a list for each degree (number of edges) of the
/// point that the next triangle turns around.
enum class Traversal : uint8_t { kStandard = 0, kValence = 2 };

class SymbolReader {
 public:
  static constexpr uint32_t kLists = 6;

  /// Takes `count` symbols and the bits of starts. False where they are malformed.
  bool open(ByteReader& in, Traversal traversal, uint32_t count);

  /// `degree`: of the point that the active edge starts at; 0 where no edge is active. False where
  /// no symbol is left.
  bool next(uint32_t degree, Symbol& symbol);
  /// Whether the next component starts with a triangle that no symbol gives.
  bool next_start() { return starts_.next(); }
  /// True where all bits and symbols are read and no more than there are.
  bool at_end();

 private:
  bool open_bits(ByteReader& in);
  bool open_lists(ByteReader& in, uint32_t count);
  Symbol next_bits();

  Traversal traversal_ = Traversal::kStandard;
  RawBitReader bits_{{}};
  AnsBits starts_;
  std::vector<uint8_t> symbols_;  ///< of all lists
  std::array<uint32_t, kLists> begin_ = {}, end_ = {};
};

}  // namespace reeb
