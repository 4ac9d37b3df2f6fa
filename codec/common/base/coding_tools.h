// Coding tools that a build for measuring can leave out one at a time, in encoder and decoder
// alike.
//
// In the product all are in use, and asking costs nothing. A build with -DREEB_ABLATIONS=ON leaves
// out the one that the environment variable REEB_WITHOUT names when the program runs; its streams
// are not `.reeb` streams. conformance/rd/configurations.py lists the same names.
#pragma once

#ifdef REEB_ABLATIONS
#include <cstdlib>
#include <string_view>
#endif

namespace reeb {

namespace coding_tool {
inline constexpr char kExtraNeighbours[] = "extra-neighbours";  ///< beyond the ring
inline constexpr char kReestimation[] = "re-estimation";        ///< of the weights, per component
inline constexpr char kBasisLearning[] = "basis-learning";      ///< the same for the basis
inline constexpr char kBasisHierarchy[] = "basis-hierarchy";    ///< dyadic in time; else in order
inline constexpr char kMassSteps[] = "mass-steps";              ///< finer where it predicts much
inline constexpr char kRdo[] = "rdo";                           ///< quantization that weighs bits
inline constexpr char kMixing[] = "mixing";                     ///< of contexts; else one table
inline constexpr char kBasisRefit[] = "basis-refit";            ///< to the decoded coefficients
inline constexpr char kGridTrial[] = "grid-trial";              ///< of the reference mesh
inline constexpr char kOrderGuesses[] = "order-guesses";        ///< of the vertex order
}  // namespace coding_tool

#ifdef REEB_ABLATIONS
inline bool uses(std::string_view tool) {
  static const char* const without = std::getenv("REEB_WITHOUT");
  return without == nullptr || tool != without;
}
#else
constexpr bool uses(const char* /*tool*/) { return true; }
#endif

}  // namespace reeb
