// bind_cancel.cpp -- CancelToken, with which another Python thread cancels long work in the core.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <memory>
#include <string>
#include <vector>

#include "math/cancel.h"

namespace nb = nanobind;
using dg::CancelScope;
using dg::CancelToken;

namespace {

/// Stack of this thread's scopes, each a `with` block of Python.
thread_local std::vector<std::unique_ptr<CancelScope>> scopes;

}  // namespace

void bind_cancel(nb::module_& m) {
    // Never released, as the exception translator needs it.
    static PyObject* type = nullptr;
    const std::string name = nb::cast<std::string>(m.attr("__name__")) + ".Cancelled";
    type = PyErr_NewExceptionWithDoc(name.c_str(), "Work that its CancelToken ended.", nullptr, nullptr);
    if (!type) throw nb::python_error();
    m.attr("Cancelled") = nb::handle(type);
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const dg::Cancelled& e) {
            PyErr_SetString(type, e.what());
        }
    });
    nb::class_<CancelToken>(m, "CancelToken", "Ends the work of threads that are within `with token:`.")
        .def(nb::init<>())
        .def("cancel", &CancelToken::cancel, "Ends the work, from any thread; it stays cancelled.")
        .def_prop_ro("cancelled", &CancelToken::cancelled, "Whether it was cancelled.")
        .def("throw_if_cancelled",
             [](const CancelToken& token) {
                 if (token.cancelled()) throw dg::Cancelled();
             },
             "Raises Cancelled if it was cancelled.")
        .def("__enter__",
             [](nb::handle token) {
                 scopes.push_back(std::make_unique<CancelScope>(nb::cast<const CancelToken*>(token)));
                 return nb::borrow(token);
             })
        .def("__exit__", [](nb::handle, nb::args) { scopes.pop_back(); });
}
