#include "retrieval/assignment.h"

#include <limits>

namespace reeb::retrieval {
namespace {

constexpr uint32_t kFree = 0xffffffffu;

// Augmenting paths of least reduced cost, one row after another; there are no more rows than
// columns.
std::vector<uint32_t> assign_rows(const Eigen::MatrixXd& cost) {
  const auto rows = static_cast<uint32_t>(cost.rows()),
             columns = static_cast<uint32_t>(cost.cols());
  std::vector<double> row_price(rows, 0.0), column_price(columns + 1, 0.0);
  std::vector<uint32_t> row_of(columns + 1, kFree), previous(columns + 1);
  const uint32_t start = columns;  // stands for the column of the row that has none yet
  for (uint32_t row = 0; row < rows; ++row) {
    row_of[start] = row;
    std::vector<double> slack(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<bool> visited(columns + 1, false);
    uint32_t at = start;
    while (row_of[at] != kFree) {
      visited[at] = true;
      const uint32_t i = row_of[at];
      uint32_t next = start;
      double least = std::numeric_limits<double>::infinity();
      for (uint32_t j = 0; j < columns; ++j) {
        if (visited[j]) continue;
        const double reduced = cost(i, j) - row_price[i] - column_price[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          previous[j] = at;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      for (uint32_t j = 0; j <= columns; ++j) {
        if (visited[j]) {
          row_price[row_of[j]] += least;
          column_price[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      at = next;
    }
    for (; at != start; at = previous[at]) row_of[at] = row_of[previous[at]];
  }
  std::vector<uint32_t> match(rows, kFree);
  for (uint32_t j = 0; j < columns; ++j) {
    if (row_of[j] != kFree) match[row_of[j]] = j;
  }
  return match;
}

}  // namespace

std::vector<uint32_t> best_assignment(const Eigen::MatrixXd& cost) {
  if (cost.rows() <= cost.cols()) return assign_rows(cost);
  const std::vector<uint32_t> of_columns = assign_rows(cost.transpose());
  std::vector<uint32_t> match(static_cast<size_t>(cost.rows()), kFree);
  for (uint32_t j = 0; j < of_columns.size(); ++j) match[of_columns[j]] = j;
  return match;
}

}  // namespace reeb::retrieval
