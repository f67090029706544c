// medium_values.h -- converts media from Python.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "bind/arrays.h"
#include "medium/medium.h"

namespace dg::bind {

/// A colour, or wavelengths (nm) and values.
using MediumColor = std::variant<std::array<float, 3>, std::pair<std::vector<double>, std::vector<double>>>;
/// Densities (Z, Y, X), and the transform from the unit cube to the space of the grid.
using Densities = nanobind::ndarray<const float, nanobind::ndim<3>, nanobind::c_contig, nanobind::device::cpu>;
using MediumGrid = std::optional<std::pair<Densities, Matrix4>>;

struct MediumValues {
    MediumColor absorption, scattering, emission;
    std::vector<std::pair<float, float>> lobes;   // mean cosine, weight
    MediumGrid density;
};

/// Throws Error for invalid values.
std::shared_ptr<const Medium> to_medium(const MediumValues& values);

}  // namespace dg::bind
