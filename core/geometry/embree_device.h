// embree_device.h -- Embree device and its error reports.
#pragma once
#include <mutex>
#include <string>

#include "geometry/embree_api.h"

namespace dg::embree {

/// Errors are reported by callback, from any thread; check() throws the first.
class Device {
  public:
    Device();
    RTCDevice get() const { return handle_.get(); }
    std::string version() const;  // "Embree 3.13.5"

    /// Throws Error that names the operation `what` if any error was reported.
    void check(const std::string& what);

    /// Throws Error (by check()) instead of returning a null geometry.
    GeometryOwner new_geometry(RTCGeometryType type, const std::string& what);

  private:
    static void on_error(void* self, RTCError code, const char* message);

    DeviceOwner handle_;
    std::mutex mutex_;
    RTCError code_ = RTC_ERROR_NONE;
    std::string message_;
};

}  // namespace dg::embree
