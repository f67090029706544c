// bind_errors.cpp -- translates dg::Error and dg::LensError to Python exceptions with their fields.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <string>

#include "optics/lens/lens_error.h"

namespace nb = nanobind;

namespace {

// Never released: the translator needs them until the last exception.
PyObject* error_type = nullptr;
PyObject* lens_error_type = nullptr;

/// Creates an exception class of the module; the class attributes of the fields are empty.
PyObject* add_exception(nb::module_& m, const char* name, const char* doc, PyObject* base) {
    nb::dict fields;
    fields["message"] = "";
    fields["code"] = nb::none();
    fields["surface"] = nb::none();
    const std::string full = nb::cast<std::string>(m.attr("__name__")) + "." + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, fields.ptr());
    if (!type) throw nb::python_error();
    m.attr(name) = nb::handle(type);
    return type;
}

void raise(PyObject* type, const char* what, const std::string& message, nb::object code, nb::object surface) {
    nb::object error = nb::handle(type)(what);
    error.attr("message") = message;
    error.attr("code") = code;
    error.attr("surface") = surface;
    PyErr_SetObject(type, error.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
    try {
        std::rethrow_exception(thrown);
    } catch (const dg::LensError& e) {
        nb::object surface = e.surface < 0 ? nb::object(nb::none()) : nb::object(nb::int_(e.surface));
        raise(lens_error_type, e.what(), e.message, nb::str(e.code.c_str()), surface);
    } catch (const dg::Error& e) {
        raise(error_type, e.what(), e.what(), nb::none(), nb::none());
    }
}

}  // namespace

void bind_errors(nb::module_& m) {
    error_type = add_exception(m, "Error", "Input that the core cannot use.", PyExc_ValueError);
    lens_error_type = add_exception(m, "LensError",
                                    "A lens that the core cannot use. message: without the code; code: such as "
                                    "lens-overlap; surface: its index, None: the lens as a whole.",
                                    error_type);
    nb::register_exception_translator(translate);
}
