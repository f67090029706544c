// record.h -- binds plain structs of the core as Python records with keyword constructors.
#pragma once
#include <nanobind/nanobind.h>

#include <utility>

#include "math/vec.h"

namespace dg::bind {

namespace nb = nanobind;

using Pair = std::pair<double, double>;

inline Pair pair(Vec2d v) { return {v.x, v.y}; }
inline Vec2d vec(Pair p) { return {p.first, p.second}; }

/// Constructor: sets the given fields of a default T. AttributeError for a field that T lacks.
template <typename T>
void def_fields_init(nb::class_<T>& c, const char* doc) {
    c.def(
        "__init__",
        [](nb::pointer_and_handle<T> self, const nb::kwargs& fields) {
            new (self.p) T();
            nb::inst_mark_ready(self.h);   // setters are called before the constructor returns
            for (const auto& [name, value] : fields) nb::setattr(self.h, name, value);
        },
        nb::sig("def __init__(self, **fields: object) -> None"), doc);
}

/// Binds a Vec2d field as a pair.
template <typename T>
void def_pair(nb::class_<T>& c, const char* name, Vec2d T::*member, const char* doc = "") {
    c.def_prop_rw(
        name, [member](const T& t) { return pair(t.*member); },
        [member](T& t, Pair p) { t.*member = vec(p); }, doc);
}

}  // namespace dg::bind
