// Parts of the extension module reeb._core.
#pragma once

#include <nanobind/nanobind.h>

namespace reeb_python {

void add_analysis(nanobind::module_& module);
void add_reading(nanobind::module_& module);
void add_render_mesh(nanobind::module_& module);
void add_writing(nanobind::module_& module);

}  // namespace reeb_python
