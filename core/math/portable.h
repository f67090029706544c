// portable.h -- replacements for functions with results that differ between releases of the C
// library. acosf, asinf, asinhf, atan2f and atan differ between glibc 2.36, 2.41 and 2.43; the
// functions below and all others that the core calls do not (portable_test.cpp). A result in
// double, rounded to float, is correctly rounded for all but about one in 10^8 arguments.
#pragma once
#include <cmath>

namespace dg {

inline double acos(double x) { return std::acos(x); }
inline double asin(double x) { return std::asin(x); }
inline double asinh(double x) { return std::asinh(x); }
inline double atan2(double y, double x) { return std::atan2(y, x); }
inline float acos(float x) { return float(std::acos(double(x))); }
inline float asin(float x) { return float(std::asin(double(x))); }
inline float asinh(float x) { return float(std::asinh(double(x))); }
inline float atan2(float y, float x) { return float(std::atan2(double(y), double(x))); }
inline double atan(double x) { return std::atan2(x, 1.0); }
/// std::hypot also requires the newest C library (GLIBC 2.35).
template <typename T>
T hypot(T x, T y) { return std::sqrt(x * x + y * y); }

}  // namespace dg
