#include "bindings/python/src/errors.h"

#include "reeb.h"

namespace reeb_python {
namespace {

namespace nb = nanobind;

/// By number, the module's own exceptions; the others are Python's.
PyObject* exceptions[REEB_NEED_MORE_DATA + 1] = {};

PyObject* exception_of(int code) {
  const bool known = code >= 0 && code <= REEB_NEED_MORE_DATA && exceptions[code] != nullptr;
  return known ? exceptions[code] : PyExc_RuntimeError;
}

PyObject* add_exception(nb::module_& module, const char* name, PyObject* base, const char* text) {
  const std::string full = std::string("reeb.") + name;
  PyObject* const made = PyErr_NewExceptionWithDoc(full.c_str(), text, base, nullptr);
  if (made == nullptr) throw nb::python_error();
  module.attr(name) = nb::borrow(made);
  return made;
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Failure& failure) {
    PyErr_SetString(exception_of(failure.code), failure.message.c_str());
  }
}

}  // namespace

void add_errors(nb::module_& module) {
  PyObject* const base =
      add_exception(module, "ReebError", PyExc_Exception, "Base of the errors that only Reeb has.");
  const auto own = [&](int code, const char* name, const char* text) {
    exceptions[code] = add_exception(module, name, base, text);
  };
  own(REEB_CORRUPT, "CorruptError", "The bytes break the format, or what is asked for is damaged.");
  own(REEB_TRUNCATED, "TruncatedError", "The file ends before its first header does.");
  own(REEB_UNSUPPORTED, "UnsupportedError",
      "A newer format version, or something that must be understood and is not.");
  own(REEB_LIMIT_EXCEEDED, "LimitError", "It takes more than the limits allow.");
  own(REEB_CANCELLED, "CancelledError", "Ended on request.");
  exceptions[REEB_NEED_MORE_DATA] = exceptions[REEB_TRUNCATED];
  exceptions[REEB_INVALID_ARGUMENT] = PyExc_ValueError;
  exceptions[REEB_IO] = PyExc_OSError;
  exceptions[REEB_OUT_OF_MEMORY] = PyExc_MemoryError;
  nb::register_exception_translator(translate, nullptr);
}

}  // namespace reeb_python
