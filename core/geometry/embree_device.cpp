// embree_device.cpp -- conversion of Embree's errors to exceptions.
#include "geometry/embree_device.h"

#include "math/error.h"

namespace dg::embree {

Device::Device() : handle_(rtcNewDevice(nullptr)) {
    if (!handle_) {
        const RTCError code = rtcGetDeviceError(nullptr);   // also clears the error
        if (code == RTC_ERROR_OUT_OF_MEMORY) throw Error("Embree: no device: out of memory");
        throw Error("Embree: no device: error " + std::to_string(code) +
                    " (the CPU or the installation of Embree is not supported)");
    }
    rtcSetDeviceErrorFunction(handle_.get(), &Device::on_error, this);
}

std::string Device::version() const {
    auto property = [&](RTCDeviceProperty p) {
        return std::to_string(rtcGetDeviceProperty(handle_.get(), p));
    };
    return "Embree " + property(RTC_DEVICE_PROPERTY_VERSION_MAJOR) + "." +
           property(RTC_DEVICE_PROPERTY_VERSION_MINOR) + "." +
           property(RTC_DEVICE_PROPERTY_VERSION_PATCH);
}

void Device::check(const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (code_ == RTC_ERROR_NONE) return;
    if (code_ == RTC_ERROR_OUT_OF_MEMORY) throw Error(what + ": out of memory");
    throw Error(what + ": Embree error " + std::to_string(code_) + ": " + message_);
}

GeometryOwner Device::new_geometry(RTCGeometryType type, const std::string& what) {
    GeometryOwner geometry(rtcNewGeometry(handle_.get(), type));
    check(what);
    return geometry;
}

void Device::on_error(void* self, RTCError code, const char* message) {
    Device& device = *static_cast<Device*>(self);
    const std::lock_guard lock(device.mutex_);
    if (device.code_ != RTC_ERROR_NONE) return;
    device.code_ = code;
    device.message_ = message ? message : "";
}

}  // namespace dg::embree
