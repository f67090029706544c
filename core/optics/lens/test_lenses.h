// test_lenses.h -- prescriptions for tests of optics and camera, from the cited patents. Columns:
// radius (0: plane), thickness, nd, Vd (0: none), semi-diameter, stop.
#pragma once
#include "optics/lens/prescription.h"

namespace dg::test {

struct Row {
    double radius, thickness, nd, vd, semi_diameter;
    bool stop = false;
};

inline Prescription lens_from_rows(const char* name, const std::vector<Row>& rows,
                                   double scale = 1) {
    Prescription lens;
    lens.name = name;
    for (const Row& r : rows) {
        Surface s;
        s.curvature = r.radius == 0 ? 0 : 1 / (r.radius * scale);
        s.thickness = r.thickness * scale;
        s.semi_diameter = r.semi_diameter * scale;
        if (r.nd != 1 && r.vd > 0) s.glass.formula = AbbeGlass{r.nd, r.vd};
        if (r.nd != 1 && r.vd == 0) s.glass.formula = ConstantIndex{r.nd};
        s.stop = r.stop;
        lens.surfaces.push_back(s);
    }
    return lens;
}

/// US 2,673,491 (Tronnier) as printed in Smith, Modern Lens Design, p. 312; f = 100, clear
/// diameters halved. `patent` selects the patent's indices instead of the rounded ones in the book.
inline Prescription check_lens(bool patent = false, double scale = 1) {
    const double n[5] = {patent ? 1.67125 : 1.670, patent ? 1.69842 : 1.699,
                         patent ? 1.60266 : 1.603, patent ? 1.65953 : 1.658,
                         patent ? 1.71740 : 1.717};
    return lens_from_rows("Tronnier double Gauss",
                          {{58.95, 7.52, n[0], 47.1, 25.2},
                           {169.66, 0.24, 1, 0, 25.2},
                           {38.55, 8.05, n[0], 47.1, 23},
                           {81.54, 6.55, n[1], 30.1, 23},
                           {25.5, 11.41, 1, 0, 18},
                           {0, 9, 1, 0, 17.1, true},
                           {-28.99, 2.36, n[2], 38.0, 17},
                           {81.54, 12.13, n[3], 57.3, 20},
                           {-40.77, 0.38, 1, 0, 20},
                           {874.13, 6.44, n[4], 48.0, 20},
                           {-79.46, 72.228, 1, 0, 20}},
                          scale);
}

/// FR 1.066.698, Tessar 50 mm f/2.8.
inline Prescription tessar() {
    return lens_from_rows("tessar", {{19.677, 5.16, 1.67786, 55.5, 12.26},
                                     {0, 3.05, 1, 0, 10.26},
                                     {-35.56, 1.45, 1.612, 37.2, 8.26},
                                     {16.837, 1.98, 1, 0, 7.76},
                                     {0, 1.75, 1, 0, 7.00239, true},
                                     {382.208, 1.2, 1.5738, 42.5, 8.01},
                                     {16.502, 5.01, 1.6608, 50.8, 8.11},
                                     {-24.551, 40.32, 1, 0, 8.76}});
}

/// US 1,998,704 (Bertele), 50 mm f/2: strongly vignetted.
inline Prescription sonnar() {
    return lens_from_rows("sonnar", {{28.5, 4, 1.6185, 60.5, 13.5},
                                     {73.15, 0.2, 1, 0, 13},
                                     {18.1, 5, 1.6711, 47.3, 12},
                                     {55, 3, 1.4645, 65.7, 10.5},
                                     {-150, 3.4, 1.689, 31.2, 9.697},
                                     {11.85, 2.5, 1, 0, 8.25},
                                     {0, 5, 1, 0, 7.40519, true},
                                     {100, 1, 1.5647, 55.8, 7.25},
                                     {15.35, 6, 1.6711, 47.3, 7.1},
                                     {-76.32, 24.18, 1, 0, 6.5}});
}

/// US 3,506,336 (Takahashi), 35 mm f/2.
inline Prescription wide_angle() {
    return lens_from_rows("wide_angle", {{157.5, 2.45, 1.58913, 61.2, 22.5},
                                         {28.04795, 16.45, 1, 0, 21.4},
                                         {-805, 3.5, 1.762, 40.3, 16.9},
                                         {-102.2819, 0.7, 1, 0, 16.4},
                                         {33.495, 6.3, 1.77252, 49.6, 16.1},
                                         {-247.6138, 0.35, 1, 0, 13.4},
                                         {28, 2.8, 1.53172, 48.9, 13.2},
                                         {29.5708, 3.15, 1, 0, 11.3},
                                         {0, 3.15, 1, 0, 9.207362, true},
                                         {-32.025, 2.275, 1.74077, 27.7, 11.5},
                                         {34.30875, 2.8, 1, 0, 12.2},
                                         {350, 1.4, 1.834, 37.2, 12.2},
                                         {24.85, 6.65, 1.77252, 49.6, 12.6},
                                         {-31.2739, 0.175, 1, 0, 12.6},
                                         {-210, 3.5, 1.77252, 49.6, 16},
                                         {-38.7268, 36.386628, 1, 0, 16.4}});
}

/// JP H01-102413 A, 200 mm f/1.8.
inline Prescription telephoto() {
    return lens_from_rows("telephoto", {{123.12, 19, 1.497, 81.6, 57},
                                        {-430.59, 0.72, 1, 0, 55.417},
                                        {89.981, 13.2, 1.497, 81.6, 53.8},
                                        {255.652, 6, 1, 0, 49},
                                        {-704.106, 4.7, 1.65412, 39.7, 47.994},
                                        {110.405, 18, 1, 0, 44.2},
                                        {67.274, 15.55, 1.497, 81.6, 42},
                                        {502.839, 0.5, 1, 0, 38.294},
                                        {44.766, 4.5, 1.6968, 55.5, 36.5},
                                        {34.941, 21, 1, 0, 31.3},
                                        {-1069.676, 6, 1.84666, 23.9, 27},
                                        {-106.363, 2.5, 1.6134, 43.8, 26},
                                        {57.199, 24.2, 1, 0, 25},
                                        {0, 8, 1, 0, 20.08653, true},
                                        {-35.135, 4.4, 1.65412, 39.7, 20},
                                        {-475.931, 8.49, 1.6516, 58.6, 21.731},
                                        {-42.493, 0.15, 1, 0, 23},
                                        {96.893, 5.5, 1.618, 63.4, 23.5},
                                        {-241.315, 72.089219, 1, 0, 23}});
}

/// US 3,589,798, 16 mm f/2.8, 180 degrees.
inline Prescription fisheye() {
    return lens_from_rows("fisheye", {{121.3312, 2.08, 1.6204, 60.3, 27},
                                      {18.992, 7.8544, 1, 0, 16.8},
                                      {39.6592, 1.92, 1.6176, 52.7, 15.5},
                                      {16.7424, 7.6544, 1, 0, 12},
                                      {-43.368, 1.6, 1.6205, 60.3, 12},
                                      {67.2912, 7.5216, 1.7495, 34.9, 11.5},
                                      {-51.664, 0.144, 1, 0, 10.7},
                                      {34.7952, 7.592, 1.733, 28.2, 9.5},
                                      {0, 2.53335, 1, 0, 7.1},
                                      {0, 4.7696, 1, 0, 5.8174759, true},
                                      {-27.32, 5.4096, 1.6214, 61.2, 7.3},
                                      {-9.7264, 2.3696, 1.733, 28.2, 8.3},
                                      {-21.4528, 0.144, 1, 0, 10.4},
                                      {-129.2096, 1.36, 1.74, 37.5, 11.5},
                                      {25.8256, 6.32, 1.5688, 56, 12.6},
                                      {-32.72, 0.144, 1, 0, 12.8},
                                      {53.8352, 4.56, 1.5168, 64.2, 14.8},
                                      {-56.5568, 36.380359, 1, 0, 15}});
}

inline std::vector<Prescription> all_lenses() {
    return {check_lens(true, 0.5), tessar(),    sonnar(),
            wide_angle(),          telephoto(), fisheye()};
}

}  // namespace dg::test
