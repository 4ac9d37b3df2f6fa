// Class _core.RenderMesh.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "bindings/python/src/arrays.h"
#include "bindings/python/src/module.h"
#include "bindings/python/src/stream.h"
#include "reeb_attributes.hpp"

namespace reeb_python {
namespace {

using namespace nb::literals;

/// A render mesh; its stream lives as long, and its owner, too (keep_alive below).
class RenderMesh {
 public:
  RenderMesh(Stream& owner, uint32_t frame, const std::vector<uint32_t>& split_by)
      : owner_(owner), stream_(owner.get()) {
    owner_.call(frame, [&](reeb::Stream& s) { return mesh_.make(s, frame, split_by); });
  }

  nb::dict info() const {
    const reeb_render_info i = mesh_.info();
    nb::dict out;
    out["shot"] = i.shot;
    out["source_vertices"] = to_array(i.source_vertices, i.vertex_count, {i.vertex_count});
    out["source_corners"] = to_array(i.source_corners, i.vertex_count, {i.vertex_count});
    out["triangles"] = to_array(i.indices, 3 * i.triangle_count, {i.triangle_count, 3});
    out["source_faces"] = to_array(i.source_faces, i.triangle_count, {i.triangle_count});
    out["material_attribute"] = i.material_attribute;
    nb::list ranges;
    for (const auto& r : mesh_.ranges())
      ranges.append(nb::make_tuple(r.material, r.first, r.count));
    out["ranges"] = ranges;
    return out;
  }

  /// The pose at a position in frames, normals where they are wanted.
  void between(double position, const Positions& out, const std::optional<Positions>& normals) {
    reeb_target target = {};
    target.struct_size = sizeof target;
    target.positions = out.data();
    target.vertex_capacity = out.shape(0);
    if (normals) {
      target.normals = normals->data();
      target.vertex_capacity = std::min(out.shape(0), normals->shape(0));
    }
    owner_.call(static_cast<uint32_t>(position), [&](reeb::Stream& s) {
      return reeb_get_render_between(s.get(), position, mesh_.get(), &target);
    });
  }

  void values(uint32_t frame, uint32_t index, const Bytes& out) {
    const reeb_value_target target = {sizeof target, out.data(), out.shape(1), out.shape(0)};
    owner_.call(frame, [&](reeb::Stream& s) {
      return reeb_get_render_values(s.get(), frame, index, mesh_.get(), &target);
    });
  }

 private:
  Stream& owner_;
  std::shared_ptr<reeb::Stream> stream_;
  reeb::StreamRenderMesh mesh_;
};

}  // namespace

void add_render_mesh(nb::module_& module) {
  nb::class_<RenderMesh>(module, "RenderMesh")
      .def(nb::init<Stream&, uint32_t, const std::vector<uint32_t>&>(), "stream"_a, "frame"_a,
           "split_by"_a, nb::keep_alive<1, 2>())
      .def("info", &RenderMesh::info)
      .def("between", &RenderMesh::between, "position"_a, "out"_a, "normals"_a = nb::none())
      .def("values", &RenderMesh::values, "frame"_a, "index"_a, "out"_a);
}

}  // namespace reeb_python
