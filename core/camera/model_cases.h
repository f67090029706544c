// model_cases.h -- for tests only: projection models of every kind.
#pragma once
#include <vector>

#include "camera/projection_model.h"

namespace dg::test {

struct ModelCase {
    const char* name;
    ProjectionModel model;
    double far;   // largest tested angle from the axis, radians
};

inline std::vector<ModelCase> model_cases() {
    using Kind = ProjectionModel::Kind;
    return {{"rectilinear", ProjectionModel(Kind::rectilinear), 1.4},
            {"equidistant", ProjectionModel(Kind::equidistant), 3.1},
            {"equisolid", ProjectionModel(Kind::equisolid), 3.1},
            {"stereographic", ProjectionModel(Kind::stereographic), 2.9},
            {"orthographic", ProjectionModel(Kind::orthographic), 1.5},
            {"equirectangular", ProjectionModel(Kind::equirectangular), 3.1},
            {"cube", ProjectionModel(Kind::cube), 3.1},
            {"opencv", ProjectionModel(Kind::opencv, {-0.28, 0.07, 1e-3, -2e-3, 0.01}), 0.8},
            {"rational", ProjectionModel(Kind::opencv, {0.8, -0.3, 1e-3, 2e-3, 0.02, 1.1, -0.1, 0.05}), 0.9},
            {"tilted", ProjectionModel(Kind::opencv, {-0.1, 0.02, 0, 0, 0, 0, 0, 0, 0.01, 0, -0.01, 0, 0.1, -0.2}), 0.8},
            {"kannala_brandt", ProjectionModel(Kind::kannala_brandt, {-0.01, 0.004, -0.003, 5e-4}), 1.7},
            {"double_sphere", ProjectionModel(Kind::double_sphere, {-0.18, 0.59}), 1.7},
            {"double_sphere, xi > 0", ProjectionModel(Kind::double_sphere, {0.3, 0.4}), 1.9},
            {"eucm", ProjectionModel(Kind::eucm, {0.62, 1.1}), 1.7},
            {"omni", ProjectionModel(Kind::omni, {1.2, -0.2, 0.05, 1e-3, -1e-3}), 1.6},
            {"ucm", ProjectionModel(Kind::omni, {0.8}), 1.9},
            {"fov", ProjectionModel(Kind::fov, {0.93}), 1.3},
            {"opencv_inverse", ProjectionModel(Kind::opencv_inverse, {0.2, -0.03, 2e-3, -3e-3, 0.01, -0.05}), 0.8},
            {"ftheta", ProjectionModel(Kind::ftheta, {0.01, -0.02, 0.004, 0.001}), 1.7}};
}

}  // namespace dg::test
