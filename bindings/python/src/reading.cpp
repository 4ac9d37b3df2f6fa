// Class _core.Stream.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>

#include "bindings/python/src/arrays.h"
#include "bindings/python/src/module.h"
#include "bindings/python/src/stream.h"
#include "reeb_attributes.hpp"

namespace reeb_python {
namespace {

using namespace nb::literals;

reeb_target target_of(float* positions, size_t vertices, const std::optional<Positions>& normals) {
  reeb_target target = {};
  target.struct_size = sizeof target;
  target.positions = positions;
  target.vertex_capacity = vertices;
  if (normals) {
    target.normals = normals->data();
    target.vertex_capacity = std::min(vertices, normals->shape(0));
  }
  return target;
}

nb::dict info(const Stream& self) {
  const reeb_info i = self.get()->info();
  nb::dict out;
  out["format_version"] = i.format_version;
  out["frame_count"] = i.frame_count;
  out["total_frames"] = i.total_frames;
  out["truncated"] = i.truncated != 0;
  out["frame_rate"] = i.frame_rate;
  out["start_time"] = i.start_time;
  out["file_bytes"] = i.file_bytes;
  return out;
}

nb::list shots(const Stream& self) {
  const auto stream = self.get();
  nb::list out;
  for (uint32_t i = 0; i < stream->info().shot_count; ++i) {
    const reeb_shot s = stream->shot(i);
    out.append(nb::make_tuple(s.first_frame, s.end_frame, s.vertex_count, s.face_count,
                              s.order_kept != 0));
  }
  return out;
}

nb::list groups(const Stream& self) {
  const auto stream = self.get();
  nb::list out;
  for (uint32_t i = 0; i < stream->info().group_count; ++i) {
    const reeb_group g = stream->group(i);
    out.append(nb::make_tuple(g.first_frame, g.frame_count, g.shot, g.bytes));
  }
  return out;
}

nb::list gaps(const Stream& self) {
  const auto stream = self.get();
  nb::list out;
  uint32_t first = 0, count = 0;
  for (uint32_t i = 0; reeb_get_gap(stream->get(), i, &first, &count) == REEB_OK; ++i)
    out.append(nb::make_tuple(first, count));
  return out;
}

nb::dict metadata(const Stream& self) {
  const auto stream = self.get();
  nb::dict out;
  const char *key = nullptr, *value = nullptr;
  for (uint32_t i = 0; reeb_get_metadata(stream->get(), i, &key, &value) == REEB_OK; ++i)
    out[nb::str(key)] = nb::str(value);
  return out;
}

nb::object triangles(Stream& self, uint32_t frame) {
  reeb::IndexView view;
  self.call(frame, [&](reeb::Stream& s) { return s.triangles(frame, view); });
  return to_array(view.data, view.size, {view.size / 3, 3});
}

nb::tuple polygons(Stream& self, uint32_t frame) {
  reeb::IndexView sizes, corners;
  self.call(frame, [&](reeb::Stream& s) { return s.polygons(frame, sizes, corners); });
  return nb::make_tuple(to_array(sizes.data, sizes.size, {sizes.size}),
                        to_array(corners.data, corners.size, {corners.size}));
}

void frame(Stream& self, uint32_t index, const Positions& out,
           const std::optional<Positions>& normals) {
  const reeb_target target = target_of(out.data(), out.shape(0), normals);
  self.call(index, [&](reeb::Stream& s) { return reeb_get_frame(s.get(), index, &target); });
}

/// Frames first, first + 1, ... one after another. Pre-condition: the second dimension has the
/// vertices of their shot.
void frames(Stream& self, uint32_t first, const FramePositions& out) {
  constexpr uint32_t kAtOnce = 64;  // so that Ctrl-C is heard and other threads get their turn
  const size_t stride = out.shape(1) * 3;
  const auto count = static_cast<uint32_t>(out.shape(0));
  for (uint32_t done = 0; done < count; done += kAtOnce) {
    self.call(first + done, [&](reeb::Stream& s) {
      return reeb_get_frames(s.get(), first + done, std::min(kAtOnce, count - done),
                             out.data() + done * stride, stride);
    });
  }
}

void between(Stream& self, double position, const Positions& out,
             const std::optional<Positions>& normals) {
  const reeb_target target = target_of(out.data(), out.shape(0), normals);
  self.call(static_cast<uint32_t>(position),
            [&](reeb::Stream& s) { return reeb_get_between(s.get(), position, &target); });
}

nb::list attributes(const Stream& self) {
  nb::list out;
  for (const reeb_attribute& a : reeb::attributes(*self.get())) {
    nb::dict one;
    one["shot"] = a.shot;
    one["index"] = a.index;
    one["name"] = nb::str(a.name);
    one["semantic"] = a.semantic;
    one["domain"] = a.domain;
    one["type"] = a.type;
    one["channels"] = a.channels;
    one["animated"] = a.animated != 0;
    one["computed"] = a.computed != 0;
    one["bytes"] = a.bytes;
    out.append(one);
  }
  return out;
}

nb::list names(const Stream& self, uint32_t frame, uint32_t index) {
  const auto stream = self.get();
  nb::list out;
  size_t length = 0;
  for (uint32_t entry = 0;
       reeb_get_name(stream->get(), frame, index, entry, nullptr, 0, &length) == REEB_OK; ++entry)
    out.append(nb::str(reeb::name_of_value(*stream, frame, index, entry).c_str()));
  return out;
}

void values(Stream& self, uint32_t frame, uint32_t index, const Bytes& out) {
  const reeb_value_target target = {sizeof target, out.data(), out.shape(1), out.shape(0)};
  self.call(frame,
            [&](reeb::Stream& s) { return reeb_get_values(s.get(), frame, index, &target); });
}

nb::list resources(const Stream& self) {
  const auto stream = self.get();
  nb::list out;
  const char *name = nullptr, *type = nullptr;
  for (uint32_t i = 0; reeb_get_resource(stream->get(), i, &name, &type) == REEB_OK; ++i)
    out.append(nb::make_tuple(name, type));
  return out;
}

nb::bytes resource(Stream& self, uint32_t index) {
  reeb::StreamResource out;
  const auto stream = self.get();
  reeb_result result;
  {
    const nb::gil_scoped_release release;
    result = reeb::resource(*stream, index, out);
  }
  self.check(result, *stream);
  return nb::bytes(out.bytes.data(), out.bytes.size());
}

nb::object bounds(const Stream& self, uint32_t group) {
  float box[6] = {};
  if (reeb_get_bounds(self.get()->get(), group, box, box + 3) != REEB_OK) return nb::none();
  return to_array(box, 6, {2, 3});
}

nb::dict stats(const Stream& self) {
  const reeb_stats s = self.get()->stats();
  nb::dict out;
  out["frames"] = s.frames;
  out["groups_decoded"] = s.groups_decoded;
  out["groups_ahead"] = s.groups_ahead;
  out["longest_stall"] = s.longest_stall;
  out["memory"] = s.memory;
  out["peak_memory"] = s.peak_memory;
  return out;
}

}  // namespace

void add_reading(nb::module_& module) {
  nb::class_<Stream>(module, "Stream", nb::is_weak_referenceable())
      .def(
          "__init__",
          [](Stream* self, std::string name, unsigned threads, bool prefetch, uint64_t cache_bytes,
             uint64_t max_memory) {
            new (self) Stream(std::move(name), {threads, prefetch, cache_bytes, max_memory});
          },
          "name"_a, "threads"_a, "prefetch"_a, "cache_bytes"_a, "max_memory"_a)
      .def("open_path", &Stream::open_path, "path"_a)
      .def("open_bytes", &Stream::open_bytes, "data"_a)
      .def("open_file", &Stream::open_file, "file"_a, "size"_a)
      .def("close", &Stream::close)
      .def_prop_ro("closed", &Stream::closed)
      .def("info", info)
      .def("shots", shots)
      .def("groups", groups)
      .def("gaps", gaps)
      .def("metadata", metadata)
      .def("triangles", triangles, "frame"_a)
      .def("polygons", polygons, "frame"_a)
      .def("frame", frame, "frame"_a, "out"_a, "normals"_a = nb::none())
      .def("frames", frames, "first"_a, "out"_a)
      .def("between", between, "position"_a, "out"_a, "normals"_a = nb::none())
      .def(
          "position_of_time",
          [](const Stream& self, double seconds, bool loop) {
            return self.get()->position_of_time(seconds, loop);
          },
          "seconds"_a, "loop"_a)
      .def("attributes", attributes)
      .def("names", names, "frame"_a, "index"_a)
      .def("values", values, "frame"_a, "index"_a, "out"_a)
      .def("resources", resources)
      .def("resource", resource, "index"_a)
      .def("bounds", bounds, "group"_a)
      .def("stats", stats)
      .def("reset_stats", [](Stream& self) { self.get()->reset_stats(); })
      .def(
          "set_loop", [](Stream& self, bool loop) { self.get()->set_loop(loop); }, "loop"_a)
      .def("cancel", [](Stream& self) { self.get()->cancel(); });
}

}  // namespace reeb_python
