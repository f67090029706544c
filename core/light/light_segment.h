// light_segment.h -- weights for choosing lamps for a whole segment in a medium, by the single scattering of a lamp or
// group along the segment.
//
// With s measured from the foot of the lamp's perpendicular of length h, a lamp of 1 cd contributes the integral of
// p / (h^2 + s^2) over the segment, with the phase function p: the integral of p over equiangular angles, divided by h
// (medium/phase_angles.h). Facets with equal normals illuminate only the part of the segment in front of their planes.
// Their cosine falloff was measured to matter little (bench/fog.py).
#pragma once
#include <cmath>
#include <limits>

#include "light/light_tree.h"
#include "medium/equiangular.h"

namespace dg {

/// A ray segment in a homogeneous medium.
struct LightSegment {
    Vec3f origin, direction;      // unit
    float length;                 // m, may be infinite
    float extinction;             // 1/m, minimum over wavelengths
    const PhaseAngles& angles;
};

/// Computes the weights of a node's children; returns their sum. The first of two loops has no branches, for
/// vectorization over four children.
inline float weigh_node(const LightNode& node, const LightSegment& segment, float* weights) {
    constexpr int kWide = LightNode::kWide;
    constexpr float kLongest = 1e9f;                   // m; squares stay finite
    constexpr float kLeastAngle = 1e-14f;              // squared angle to the line, limited by rounding
    constexpr float kLeastShare = 1e-6f;               // keeps probabilities positive
    const auto larger = [](float a, float b) { return a > b ? a : b; };
    const auto smaller = [](float a, float b) { return a < b ? a : b; };
    const float length = smaller(segment.length, kLongest);
    const auto& n = node.facts;
    float first[kWide], last[kWide];
    for (int i = 0; i < kWide; ++i) {
        const Vec3f to = Vec3f{n[0][i], n[1][i], n[2][i]} - segment.origin, axis{n[4][i], n[5][i], n[6][i]};
        const float d2 = length_squared(to), foot = dot(to, segment.direction);
        const float height2 = larger(larger(d2 - foot * foot, n[3][i] * n[3][i]), kLeastAngle * d2 + 1e-20f);
        const float height = std::sqrt(height2);
        const float reach = n[10][i], before = reach - dot(axis, to), slope = dot(axis, segment.direction);
        const bool flat = (reach >= 0) & (reach < std::numeric_limits<float>::infinity());
        const float met = -before / slope, not_before = larger(met, 0.f), up_to_there = smaller(met, length);
        const bool rises = flat & (slope > 0), falls = flat & (slope < 0);
        const float begin = rises ? not_before : 0.f, end = falls ? up_to_there : length;
        const bool dark = (begin >= end) | (flat & (slope == 0) & (before < 0));
        const float from = begin - foot, up_to = end - foot;
        first[i] = from / (height + std::sqrt(height2 + from * from));
        last[i] = up_to / (height + std::sqrt(height2 + up_to * up_to));
        const float passed = 1 / (1 + 0.25f * segment.extinction * std::sqrt(d2));   // to the 4th power: like exp
        const float strength = n[7][i] / height * (passed * passed) * (passed * passed);
        weights[i] = dark ? 0.f : strength;
    }
    for (int i = 0; i < kWide; ++i)
        if (weights[i] > 0)
            weights[i] *= larger(float(segment.angles.before(last[i]) - segment.angles.before(first[i])), kLeastShare);
    return (weights[0] + weights[1]) + (weights[2] + weights[3]);
}

}  // namespace dg
