#include "segmentation/diffusion.h"

#include <cmath>

namespace reeb::segmentation {

Eigen::MatrixXd diffusion_embedding(const Eigenpairs& pairs, double t) {
  return (-t * pairs.values).array().exp().matrix().asDiagonal() * pairs.vectors.transpose();
}

Eigen::VectorXd distances_from(const Eigen::MatrixXd& embedding, uint32_t source) {
  const Eigen::VectorXd origin = embedding.col(source);
  return (embedding.colwise() - origin).colwise().norm().transpose();
}

Eigen::VectorXd distance_function(const Eigen::MatrixXd& embedding,
                                  const std::vector<uint32_t>& sources) {
  Eigen::VectorXd nearest = distances_from(embedding, sources.front());
  for (size_t i = 1; i < sources.size(); ++i) {
    nearest = nearest.cwiseMin(distances_from(embedding, sources[i]));
  }
  const double largest = nearest.maxCoeff();
  if (largest > 0) nearest /= largest;
  return nearest;
}

}  // namespace reeb::segmentation
