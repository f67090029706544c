// sensor.h -- sensor geometry: conversion between px and mm.
#pragma once
#include "math/vec.h"

namespace dg {

/// Pixel (0,0) has its top left corner at px (0,0); film mm are upright with +y up.
struct Sensor {
    int width = 0, height = 0;              // px
    double width_mm = 36, height_mm = 24;   // size of the frame
    Vec2d center_mm{0, 0};                  // film shift: centre of the frame

    Vec2f mm_from_px(Vec2f px) const {
        return {float((px.x / width - 0.5) * width_mm + center_mm.x),
                float((0.5 - px.y / height) * height_mm + center_mm.y)};
    }
    Vec2f px_from_mm(Vec2f mm) const {
        return {float(((mm.x - center_mm.x) / width_mm + 0.5) * width),
                float((0.5 - (mm.y - center_mm.y) / height_mm) * height)};
    }
    /// Area of a pixel.
    double mm2_per_px() const { return width_mm / width * height_mm / height; }
    /// Whether a point is on the frame.
    bool holds(Vec2f px) const {
        return px.x >= 0 && px.y >= 0 && px.x < float(width) && px.y < float(height);
    }
    /// In double, for ground truth.
    Vec2d mm_from_px(Vec2d px) const {
        return {(px.x / width - 0.5) * width_mm + center_mm.x,
                (0.5 - px.y / height) * height_mm + center_mm.y};
    }
    Vec2d px_from_mm(Vec2d mm) const {
        return {((mm.x - center_mm.x) / width_mm + 0.5) * width,
                (0.5 - (mm.y - center_mm.y) / height_mm) * height};
    }
};

}  // namespace dg
