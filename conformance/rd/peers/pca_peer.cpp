// The classical codec for such sequences, as a benchmark: principal components of the trajectories,
// coefficients predicted by parallelograms, an adaptive arithmetic coder, connectivity by Draco.
// SETTING: KG error in percent, met within 0.5 %.
//
// After L. Vasa, V. Skala, "CODDYAC: Connectivity driven dynamic mesh compression", 3DTV 2007.
#include <Eigen/Dense>
#include <optional>

#include "codec/enc/reference/draco_connectivity_encoder.h"
#include "conformance/rd/peers/pca_coder.h"
#include "conformance/rd/peers/peer.h"

namespace reeb::conformance {
namespace {

constexpr double kBitValue = 0.115;  ///< squared error in q^2 that a bit is worth: 2 ln 2 / 12
constexpr int kPatience = 8;         ///< components in a row that may cost more than they bring

using Values = std::vector<double>;

struct Header {
  uint32_t frames, points, isolated, components;
  float step;
};

/// Triangles as Draco gives them back, the points that it made of one vertex united again.
struct Mesh {
  std::vector<uint32_t> triangles;
  uint32_t vertex_count = 0;

  /// `united`: for every point of `mesh` the first one of the same vertex.
  Mesh(const PointTriangles& mesh, const std::vector<uint32_t>& united, uint32_t isolated) {
    std::vector<uint32_t> number(united.size());
    for (uint32_t p = 0; p < united.size(); ++p)
      number[p] = united[p] == p ? vertex_count++ : number[united[p]];
    for (const uint32_t p : mesh.triangles) triangles.push_back(number[p]);
    vertex_count += isolated;
  }
};

/// Codes which points are one vertex: for each, 0 or one more than how far back its first one is.
template <class Coder>
void code_united(Coder& coder, std::vector<uint32_t>& united) {
  ExpGolombModel model;
  for (uint32_t p = 0; p < united.size(); ++p) {
    const uint32_t back = model.code(coder, p - united[p]);
    united[p] = p - std::min(back, p);
  }
}

/// Decoded signal: rows = vertices, columns = frame-major xyz.
struct Reconstruction {
  Eigen::MatrixXd coefficients, basis;
  Eigen::RowVectorXd mean;

  Eigen::MatrixXd positions() const { return (coefficients * basis.transpose()).rowwise() + mean; }
};

void append_column(Eigen::MatrixXd& matrix, const Values& values, double scale) {
  matrix.conservativeResize(static_cast<Eigen::Index>(values.size()), matrix.cols() + 1);
  matrix.col(matrix.cols() - 1) =
      Eigen::Map<const Eigen::VectorXd>(values.data(), matrix.rows()) * scale;
}

Values scaled(const Eigen::VectorXd& vector, double scale) {
  Values out(vector.size());
  Eigen::Map<Eigen::VectorXd>(out.data(), vector.size()) = vector * scale;
  return out;
}

double norm_of(const Values& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()))
      .norm();
}

class Analysis {
 public:
  explicit Analysis(const Eigen::MatrixXd& positions) : mean_(positions.colwise().mean()) {
    const Eigen::MatrixXd centred = positions.rowwise() - mean_;
    energy_ = centred.squaredNorm();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
    basis_ = solver.eigenvectors().rowwise().reverse();
    coefficients_ = centred * basis_;
  }

  const Eigen::MatrixXd& basis() const { return basis_; }
  const Eigen::MatrixXd& coefficients() const { return coefficients_; }
  const Eigen::RowVectorXd& mean() const { return mean_; }
  double energy() const { return energy_; }

 private:
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd basis_, coefficients_;
  double energy_;
};

/// Encodes everything with one quantization step.
class Encoding {
 public:
  Encoding(const Analysis& analysis, const Traversal& traversal, double step)
      : analysis_(analysis), traversal_(traversal), step_(step), coder_(traversal) {
    const auto vertices = static_cast<double>(traversal.order.size());
    Values mean = scaled(analysis.mean(), std::sqrt(vertices) / step);
    coder_.code_trajectory(bytes_, best_order(mean), mean);
    out_.mean = Eigen::Map<Eigen::RowVectorXd>(mean.data(), analysis.mean().size()) *
                (step / std::sqrt(vertices));
    int failures = 0;
    for (Eigen::Index k = 0; k < analysis.basis().cols() && failures < kPatience; ++k)
      failures = add_component(k) ? 0 : failures + 1;
  }

  const Reconstruction& reconstruction() const { return out_; }
  std::vector<uint8_t> finish() { return bytes_.finish(); }

 private:
  /// False where component k costs more than it brings; nothing is coded then.
  bool add_component(Eigen::Index k) {
    const Eigen::VectorXd exact = analysis_.coefficients().col(k);
    const Values target = scaled(exact, 1 / step_);
    const SurfacePrediction prediction = best_prediction(target);
    Values decoded = target;
    PcaCoder trial = coder_;
    BitCounter counter;
    trial.code_coefficients(counter, prediction, decoded);
    const double norm = norm_of(decoded);
    if (norm == 0) return false;
    Values column = scaled(analysis_.basis().col(k), norm);
    const uint32_t order = best_order(column);
    trial.code_trajectory(counter, order, column);
    double gain = 0;
    for (size_t v = 0; v < target.size(); ++v)
      gain += target[v] * target[v] - (target[v] - decoded[v]) * (target[v] - decoded[v]);
    if (gain < kBitValue * counter.bits()) return false;
    decoded = target;
    coder_.code_coefficients(bytes_, prediction, decoded);
    column = scaled(analysis_.basis().col(k), norm);
    coder_.code_trajectory(bytes_, order, column);
    append_column(out_.coefficients, decoded, step_);
    append_column(out_.basis, column, 1 / norm);
    return true;
  }

  SurfacePrediction best_prediction(const Values& target) const {
    double least = INFINITY;
    SurfacePrediction best{};
    for (const auto p :
         {SurfacePrediction::kParallelogram, SurfacePrediction::kMean, SurfacePrediction::kNone}) {
      double cost = 0;
      for (uint32_t i = 0; i < traversal_.order.size(); ++i)
        cost += std::log2(1 + std::abs(target[traversal_.order[i]] - coder_.predict(p, i, target)));
      if (cost < least) best = p;
      least = std::min(least, cost);
    }
    return best;
  }

  static uint32_t best_order(const Values& target) {
    double least = INFINITY;
    uint32_t best = 0;
    for (uint32_t order = 0; order < 3; ++order) {
      double cost = 0;
      for (size_t i = 0; i < target.size(); ++i)
        cost += std::log2(1 + std::abs(target[i] - PcaCoder::extrapolate(order, i, target)));
      if (cost < least) best = order;
      least = std::min(least, cost);
    }
    return best;
  }

  const Analysis& analysis_;
  const Traversal& traversal_;
  double step_;
  PcaCoder coder_;
  BinaryEncoder bytes_;
  Reconstruction out_;
};

/// Finds the step that meets a KG error, by false position on logarithms.
std::optional<Encoding> search(const Analysis& analysis, const Traversal& traversal,
                               const Eigen::MatrixXd& positions, double kg, double& step) {
  const double target = kg * kg / 1e4 * analysis.energy();
  double log_low = NAN, low = 0, log_high = NAN, high = 0;
  double log_step = std::log(2 * std::sqrt(target / static_cast<double>(positions.rows())));
  std::optional<Encoding> best;
  for (int trial = 0; trial < 16; ++trial) {
    const double q = static_cast<float>(std::exp(log_step));
    Encoding encoding(analysis, traversal, q);
    const double error = (positions - encoding.reconstruction().positions()).squaredNorm();
    const double excess = std::log(error / target);
    if (excess <= 0) {
      log_low = log_step, low = excess, step = q;
      best.emplace(std::move(encoding));
      if (excess > -0.01) break;  // of the squared error
    } else {
      log_high = log_step, high = excess;
    }
    if (std::isnan(log_low) || std::isnan(log_high)) {
      log_step -= 0.7 * excess + (excess > 0 ? 0.05 : -0.05);
    } else {
      const double part = std::clamp((-0.005 - low) / (high - low), 0.1, 0.9);
      log_step = log_low + part * (log_high - log_low);
    }
  }
  return best;
}

/// Used vertices as Draco numbers them, then isolated ones: which of the input each is.
struct Numbering {
  DracoEncoding draco;
  std::vector<uint32_t> united;  ///< see Mesh
  std::vector<uint32_t> order;
  uint32_t isolated = 0;

  bool make(const Connectivity& connectivity) {
    const CompactMesh mesh(connectivity);
    const std::vector<uint32_t>& used = mesh.used;
    if (!encode_draco_connectivity(mesh.triangles, static_cast<uint32_t>(used.size()), draco))
      return false;
    std::vector<uint32_t> first(used.size(), 0xFFFFFFFF);
    for (uint32_t p = 0; p < draco.vertex_of.size(); ++p) {
      const uint32_t v = draco.vertex_of[p];
      if (first[v] == 0xFFFFFFFF) {
        first[v] = p;
        order.push_back(used[v]);
      }
      united.push_back(first[v]);
    }
    order.insert(order.end(), mesh.isolated.begin(), mesh.isolated.end());
    isolated = static_cast<uint32_t>(mesh.isolated.size());
    return true;
  }
};

Eigen::MatrixXd matrix_of(const Shot& shot, const std::vector<uint32_t>& order) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(order.size()), Eigen::Index{shot.frame_count} * 3);
  for (uint32_t t = 0; t < shot.frame_count; ++t) {
    const std::span<const float> xyz = shot.frame(t);
    for (uint32_t i = 0; i < order.size(); ++i) {
      for (uint32_t axis = 0; axis < 3; ++axis)
        out(i, Eigen::Index{t} * 3 + axis) = xyz[size_t{order[i]} * 3 + axis];
    }
  }
  return out;
}

class PcaPeer : public Peer {
 public:
  Status encode(const Shot& shot, double kg, PeerStream& out) override {
    Numbering numbering;
    if (!numbering.make(shot.connectivity)) return Status::io("Draco does not take the mesh");
    const Mesh mesh(numbering.draco.mesh, numbering.united, numbering.isolated);
    const Traversal traversal = traverse(mesh.triangles, mesh.vertex_count);
    const Eigen::MatrixXd positions = matrix_of(shot, numbering.order);
    double step = 0;
    const Analysis analysis(positions);
    std::optional<Encoding> found = search(analysis, traversal, positions, kg, step);
    if (!found) return Status::invalid("the KG error is out of reach");
    BinaryEncoder united;
    code_united(united, numbering.united);
    put(out.bytes,
        Header{shot.frame_count, static_cast<uint32_t>(numbering.united.size()), numbering.isolated,
               static_cast<uint32_t>(found->reconstruction().basis.cols()),
               static_cast<float>(step)});
    put_block(out.bytes, numbering.draco.section);
    put_block(out.bytes, united.finish());
    put_block(out.bytes, found->finish());
    out.order = std::move(numbering.order);
    return {};
  }

  Status decode(std::span<const uint8_t> bytes, std::vector<float>& positions) override {
    const auto header = take<Header>(bytes);
    PointTriangles draco;
    const Limits any;
    if (Status s = decode_connectivity(take_block(bytes), any, UINT32_MAX, draco); !s.ok())
      return s;
    BinaryDecoder splits(take_block(bytes));
    std::vector<uint32_t> united(header.points);
    code_united(splits, united);
    const Mesh mesh(draco, united, header.isolated);
    const Traversal traversal = traverse(mesh.triangles, mesh.vertex_count);
    const Reconstruction decoded = decode_signal(header, traversal, take_block(bytes));
    const Eigen::MatrixXf values = decoded.positions().cast<float>();
    for (Eigen::Index t = 0; t < header.frames; ++t) {
      for (Eigen::Index v = 0; v < values.rows(); ++v) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) positions.push_back(values(v, t * 3 + axis));
      }
    }
    return {};
  }

 private:
  static Reconstruction decode_signal(const Header& header, const Traversal& traversal,
                                      std::span<const uint8_t> bytes) {
    Reconstruction out;
    BinaryDecoder decoder(bytes);
    PcaCoder coder(traversal);
    const double step = header.step;
    Values mean(size_t{header.frames} * 3);
    coder.code_trajectory(decoder, 0, mean);
    out.mean = Eigen::Map<Eigen::RowVectorXd>(mean.data(), static_cast<Eigen::Index>(mean.size())) *
               (step / std::sqrt(static_cast<double>(traversal.order.size())));
    for (uint32_t k = 0; k < header.components; ++k) {
      Values coefficients(traversal.order.size());
      Values column(mean.size());
      coder.code_coefficients(decoder, {}, coefficients);
      coder.code_trajectory(decoder, 0, column);
      append_column(out.coefficients, coefficients, step);
      append_column(out.basis, column, 1 / norm_of(coefficients));
    }
    return out;
  }
};

}  // namespace
}  // namespace reeb::conformance

int main(int argc, char** argv) {
  reeb::conformance::PcaPeer peer;
  return run_peer(argc, argv, peer);
}
