// The numbers of an attribute in a frame, as they are decoded: a site's once, for all its elements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "bitstream/memory_account.h"
#include "bitstream/status.h"

namespace reeb {

struct KeptAttribute;

/// Where values go: those of element e to `values + e * stride`, numbers as the attribute's type
/// has them in memory.
struct ValueTarget {
  uint8_t* values = nullptr;
  size_t stride = 0;                   ///< bytes; 0 = one element after another
  size_t element_capacity = SIZE_MAX;  ///< elements that there is room for
};

struct SiteNumbers {
  std::span<const uint8_t> numbers;   ///< of all sites
  std::span<const uint32_t> site_of;  ///< of each element; empty where elements are sites
  size_t bytes = 1;                   ///< of a site
  std::shared_ptr<const KeptAttribute> attribute;  ///< what the spans may point into
  std::vector<uint8_t> own;                        ///< the other thing
  Lease lease;

  size_t element_count() const { return site_of.empty() ? numbers.size() / bytes : site_of.size(); }
  const uint8_t* element(size_t e) const {
    return numbers.data() + bytes * (site_of.empty() ? e : site_of[e]);
  }
};

/// Copies the elements of `order`, or all where there is none.
Status copy_numbers(const SiteNumbers& from, const std::vector<uint32_t>* order,
                    const ValueTarget& target);

/// Adds the values of all elements at the end.
void append_numbers(const SiteNumbers& from, std::vector<uint8_t>& values);

}  // namespace reeb
