// Counts what this program holds on its heap, by malloc or by operator new, so that tests can bound
// it.
#pragma once

#include <cstddef>

namespace reeb::test {

/// Largest number of bytes held at once since construction, less those held then; always 0 where
/// neither the C library nor a sanitizer tells of blocks.
class AllocationMeter {
 public:
  AllocationMeter();
  size_t peak() const;

 private:
  ptrdiff_t before_;
};

}  // namespace reeb::test
