// Allocations of this program that fail on request.
#pragma once

#include <cstdint>

namespace reeb::test {

/// The `count`-th call of operator new from now on throws std::bad_alloc, and those after it until
/// `stop_failing`; counted over all threads.
void fail_after(int64_t count);
void stop_failing();

/// True when a call has failed since `fail_after`.
bool has_failed();

/// Blocks held by operator new now.
int64_t blocks_held();

}  // namespace reeb::test
