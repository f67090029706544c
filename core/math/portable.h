// portable.h -- functions whose bits differ between releases of the C library, made of those that keep
// theirs. Held equal in glibc 2.36, 2.41 and 2.43: acosf, asinf, asinhf, atan2f and atan change there,
// the functions below and what else the core calls do not (portable_test.cpp). A double that is rounded
// to float is the correctly rounded value but for one argument in 10^8 or so.
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
/// The C library's also asks for its newest release (GLIBC 2.35).
template <typename T>
T hypot(T x, T y) { return std::sqrt(x * x + y * y); }

}  // namespace dg
