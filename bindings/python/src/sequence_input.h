// Arrays of Python as a sequence for the encoder.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "codec/common/base/sequence.h"

namespace reeb_python {

namespace nb = nanobind;

using Indices = nb::ndarray<const uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Frames =
    nb::ndarray<const float, nb::ndim<3>, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

reeb::Connectivity connectivity_of(size_t vertices, const Indices& sizes, const Indices& corners);

/// An attribute from a dict: name, semantic, domain, type, channels, animated, names, values
/// (bytes) and keep (text as of `reeb encode --attribute NAME=HOW`, or empty). `lossless`: what
/// that means where it is empty.
reeb::Attribute attribute_of(const nb::dict& from, bool lossless);

}  // namespace reeb_python
