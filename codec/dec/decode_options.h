// What the caller of the decoder may choose.
#pragma once

#include <cstdint>
#include <memory_resource>

#include "bitstream/limits.h"

namespace reeb {

struct DecodeOptions {
  Limits limits;         ///< refused beyond these, before anything is allocated
  unsigned threads = 1;  ///< 0 = all cores; results do not depend on it
  /// Decode the next group on a thread of its own while frames are asked for in sequence.
  bool prefetch = false;
  /// Bytes of decoded groups to keep, least recently used ones go first. The group in use and the
  /// one after it are kept in any case, as far as limits.max_memory allows.
  uint64_t cache_bytes = uint64_t{256} << 20;
  /// Where pushed bytes, faces and frames in between are kept; nullptr = operator new. It must
  /// outlive the decoder and be fit for several threads if `prefetch` is used.
  std::pmr::memory_resource* memory = nullptr;

  std::pmr::memory_resource* resource() const {
    return memory != nullptr ? memory : std::pmr::new_delete_resource();
  }
};

}  // namespace reeb
