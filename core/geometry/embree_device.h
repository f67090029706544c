// embree_device.h -- one device of Embree, and the errors that it reports.
#pragma once
#include <mutex>
#include <string>

#include "geometry/embree_api.h"

namespace dg::embree {

/// Errors come by callback, from any thread; the first one is kept and thrown by check().
class Device {
  public:
    Device();
    RTCDevice get() const { return handle_.get(); }
    std::string version() const;  // "Embree 3.13.5"

    /// Throws Error that says during `what`, if anything went wrong so far.
    void check(const std::string& what);

    /// `check` follows: nothing is returned that Embree could not make.
    GeometryOwner new_geometry(RTCGeometryType type, const std::string& what);

  private:
    static void on_error(void* self, RTCError code, const char* message);

    DeviceOwner handle_;
    std::mutex mutex_;
    RTCError code_ = RTC_ERROR_NONE;
    std::string message_;
};

}  // namespace dg::embree
