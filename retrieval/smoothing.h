// A surface without its noise.
#pragma once

#include "segmentation/surface.h"

namespace reeb::retrieval {

/// Lets the positions flow into each other by heat diffusion, for a time of `time` times the area,
/// in one implicit step (M. Desbrun, M. Meyer, P. Schroeder, A. Barr, "Implicit fairing of
/// irregular meshes", 1999): detail and noise smaller than about the root of that vanishes, however
/// fine the mesh is. The surface itself where the equations have no answer.
segmentation::Surface smoothed(const segmentation::Surface& surface, double time);

}  // namespace reeb::retrieval
