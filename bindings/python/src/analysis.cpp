// Functions _core.segment, compare, sign, read_archive, class _core.Signature.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <utility>

#include "bindings/python/src/arrays.h"
#include "bindings/python/src/errors.h"
#include "bindings/python/src/job.h"
#include "bindings/python/src/module.h"
#include "bindings/python/src/sequence_input.h"
#include "codec/common/mesh/faces.h"
#include "conformance/rd/sted.h"
#include "reeb.h"
#include "segmentation/motion.h"
#include "tools/archive/shape_archive.h"
#include "tools/metrics.h"

namespace reeb_python {
namespace {

using namespace nb::literals;
namespace segmentation = reeb::segmentation;
namespace retrieval = reeb::retrieval;

void check(const reeb::Status& status) {
  if (!status.ok()) throw Failure{static_cast<int>(status.code()), status.message()};
}

/// A long calculation that cannot be ended early: only the interpreter's lock is released.
template <class Work>
auto without_lock(Work&& work) {
  const nb::gil_scoped_release release;
  return work();
}

reeb::Sequence sequence_of(const Frames& positions, const Indices& sizes, const Indices& corners) {
  reeb::Sequence out;
  reeb::Shot& shot = out.shots.emplace_back();
  shot.connectivity = connectivity_of(positions.shape(1), sizes, corners);
  shot.frame_count = static_cast<uint32_t>(positions.shape(0));
  shot.positions.assign(positions.data(), positions.data() + positions.size());
  return out;
}

nb::dict graph_of(const segmentation::Graph& graph) {
  std::vector<uint32_t> vertices, types, arcs;
  std::vector<double> values;
  for (const segmentation::Node& n : graph.nodes) {
    vertices.push_back(n.vertex);
    types.push_back(static_cast<uint32_t>(n.type));
    values.push_back(n.value);
  }
  for (const segmentation::Arc& a : graph.arcs) arcs.insert(arcs.end(), {a.from, a.to, a.region});
  const size_t nodes = vertices.size();
  nb::dict out;
  out["vertices"] = to_array(std::move(vertices), {nodes});
  out["types"] = to_array(std::move(types), {nodes});
  out["values"] = to_array(std::move(values), {nodes});
  out["arcs"] = to_array(std::move(arcs), {graph.arcs.size(), 3});
  out["loops"] = graph.loops();
  return out;
}

/// Of the first frame; `regions` > 0: labels follow the motion of all.
nb::dict segment(const Frames& frames, const Indices& sizes, const Indices& corners,
                 uint32_t regions) {
  const std::vector<uint32_t> triangles =
      fan_triangles(connectivity_of(frames.shape(1), sizes, corners));
  const std::span<const float> first(frames.data(), frames.shape(1) * 3);
  segmentation::Result result;
  std::vector<uint32_t> labels;
  without_lock([&] {
    result = segmentation::segment(first, triangles);
    labels = result.labels;
    if (regions == 0) return;
    const segmentation::MotionInput input{first, triangles, {frames.data(), frames.size()}};
    const segmentation::MotionPartitions partitions(input, result);
    if (partitions.finest() > 0)
      labels = adjust_borders(input, partitions.labels(std::min(regions, partitions.finest())));
  });
  nb::dict out;
  const size_t vertices = labels.size(), points = result.feature_points.size();
  out["labels"] = to_array(std::move(labels), {vertices});
  out["scalar"] = to_array(std::move(result.scalar), {vertices});
  out["feature_points"] = to_array(std::move(result.feature_points), {points});
  out["graph"] = graph_of(result.graph);
  out["warnings"] = nb::cast(result.warnings);
  return out;
}

nb::dict compare(const Frames& original, const Frames& other, const Indices& sizes,
                 const Indices& corners) {
  const reeb::Sequence a = sequence_of(original, sizes, corners);
  const reeb::Sequence b = sequence_of(other, sizes, corners);
  reeb::tools::Comparison comparison;
  reeb::conformance::Sted sted;
  check(without_lock([&] {
    const reeb::Status status = compare_sequences(a, b, comparison);
    if (status.ok() && sizes.size() > 0)
      sted = reeb::conformance::spatio_temporal_edge_difference(a.shots[0], b.shots[0].positions,
                                                                comparison.diagonal);
    return status;
  }));
  std::vector<double> frames;
  for (const reeb::tools::ErrorFigures& f : comparison.frames)
    frames.insert(frames.end(), {f.kg, f.rmse, f.max_error});
  nb::dict out;
  out["kg"] = comparison.overall.kg;
  out["rmse"] = comparison.overall.rmse;
  out["max_error"] = comparison.overall.max_error;
  out["max_frame"] = comparison.max_frame;
  out["max_vertex"] = comparison.max_vertex;
  out["diagonal"] = comparison.diagonal;
  out["identical"] = comparison.identical;
  out["sted"] = sizes.size() > 0 ? nb::cast(sted.combined) : nb::none();
  out["frames"] = to_array(std::move(frames), {comparison.frames.size(), 3});
  return out;
}

retrieval::Signature sign(const Frames& mesh, const Indices& sizes, const Indices& corners) {
  const std::vector<uint32_t> triangles =
      fan_triangles(connectivity_of(mesh.shape(1), sizes, corners));
  retrieval::Signed result = without_lock([&] {
    return retrieval::sign({mesh.data(), mesh.shape(1) * 3}, triangles);
  });
  if (result.signature.empty())
    throw Failure{REEB_INVALID_ARGUMENT, "positions: " + result.warnings.back()};
  return std::move(result.signature);
}

nb::dict distance(const retrieval::Signature& a, const retrieval::Signature& b) {
  const retrieval::ShapeDistance d = without_lock([&] { return retrieval::shape_distance(a, b); });
  nb::dict out;
  out["charts"] = d.charts;
  out["spectrum"] = d.spectrum;
  out["body"] = d.body;
  out["all"] = d.total;
  return out;
}

nb::list read_archive(const std::string& path) {
  reeb::tools::ShapeArchive archive;
  check(without_lock([&] { return reeb::tools::read_archive(path, archive); }));
  nb::list out;
  for (const reeb::tools::ArchivedFile& file : archive.files) {
    for (const reeb::tools::SignedFrame& shape : file.shapes)
      out.append(nb::make_tuple(file.path, shape.frame - 1, shape.signature));
  }
  return out;
}

}  // namespace

void add_analysis(nb::module_& module) {
  using retrieval::Signature;
  nb::class_<Signature>(module, "Signature")
      .def("distance", distance, "other"_a)
      .def("to_bytes",
           [](const Signature& self) {
             const std::vector<uint8_t> bytes = to_bytes(self);
             return nb::bytes(bytes.data(), bytes.size());
           })
      .def_static(
          "from_bytes",
          [](const nb::bytes& data) {
            Signature out;
            const auto* const first = reinterpret_cast<const uint8_t*>(data.c_str());
            if (!retrieval::from_bytes({first, data.size()}, out))
              throw Failure{REEB_CORRUPT, "these are not the bytes of a signature"};
            return out;
          },
          "data"_a);
  module.def("segment", segment, "frames"_a, "sizes"_a, "corners"_a, "regions"_a);
  module.def("compare", compare, "original"_a, "other"_a, "sizes"_a, "corners"_a);
  module.def("sign", sign, "mesh"_a, "sizes"_a, "corners"_a);
  module.def("read_archive", read_archive, "path"_a);
}

}  // namespace reeb_python
