// The best one-to-one matching.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace reeb::retrieval {

/// Per row of `cost`, whose values are finite, the column it is matched with, so that the sum is
/// least; every row has one if there are as many columns, or else every column, and kNone (all bits
/// set) marks a row without (H. Kuhn's Hungarian method, in the order of R. Jonker, A. Volgenant,
/// 1987).
std::vector<uint32_t> best_assignment(const Eigen::MatrixXd& cost);

}  // namespace reeb::retrieval
