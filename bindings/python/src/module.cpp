// reeb._core: what the package reeb is written over. Arrays are checked and made there.
#include "bindings/python/src/module.h"

#include "bindings/python/src/errors.h"
#include "reeb.h"

NB_MODULE(_core, module) {
  nanobind::set_leak_warnings(false);  // of what is still open when the interpreter ends
  module.attr("version") = reeb_version_string();
  module.attr("format_version") = reeb_format_version();
  reeb_python::add_errors(module);
  reeb_python::add_analysis(module);
  reeb_python::add_reading(module);
  reeb_python::add_render_mesh(module);
  reeb_python::add_writing(module);
}
