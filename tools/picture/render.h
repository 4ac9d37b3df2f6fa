// Meshes drawn into images: orthographic, depth-buffered, smoothly shaded.
#pragma once

#include <span>
#include <vector>

#include "codec/common/base/sequence.h"
#include "tools/picture/image.h"
#include "tools/vec3.h"

namespace reeb::tools {

/// Axes of the picture in space, of unit length.
struct Camera {
  Vec3 right;
  Vec3 up;
  Vec3 back;  ///< towards the eye

  /// Seen from `azimuth` degrees about the upright axis (0 = from +z, or -y where z is up; 90 =
  /// from +x) and `elevation` degrees above the ground.
  static Camera orbit(double azimuth, double elevation, bool z_up);
};

/// What part of space fills the picture.
struct Framing {
  Vec3 centre;
  double pixels_per_unit = 1;

  /// Where a point of space is in the picture.
  Point place(const Vec3& p, const Camera& camera, const Image& image) const;
};

/// Draws polygons (as fans of triangles, both sides alike), in time linear in corners and pixels.
/// `colours` has one entry per vertex, or one for all.
void draw_mesh(const Connectivity& connectivity, std::span<const float> positions,
               std::span<const Colour> colours, const Camera& camera, const Framing& framing,
               Image& out);

/// What covers a mesh.
struct Paint {
  std::span<const Colour> corners;                  ///< a colour for each corner, or one for all
  const Image* texture = nullptr;                   ///< if any, instead
  std::span<const float> texture_coordinates = {};  ///< two for each corner, from the lower left
};

/// The same, with colours of corners or a texture, which repeats.
void draw_painted(const Connectivity& connectivity, std::span<const float> positions,
                  const Paint& paint, const Camera& camera, const Framing& framing, Image& out);

/// Middle of the bounding box of one frame.
Vec3 box_centre(std::span<const float> positions);

/// Largest extent along the picture's axes from `centre`, in units of the mesh: {right, up}.
std::array<double, 2> half_extent(std::span<const float> positions, const Camera& camera,
                                  const Vec3& centre);

/// Blue - white - yellow - red for 0 .. 1; beyond 1 as 1.
Colour error_colour(double value);

}  // namespace reeb::tools
