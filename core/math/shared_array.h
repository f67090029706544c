// shared_array.h -- immutable array with shared ownership.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace dg {

/// Elements in a vector or in external memory (a numpy array) that `owner` keeps alive. Copies
/// share the elements.
template <typename T>
class SharedArray {
  public:
    SharedArray() = default;
    SharedArray(std::vector<T> values) {
        auto kept = std::make_shared<const std::vector<T>>(std::move(values));
        data_ = kept->data();
        size_ = kept->size();
        owner_ = std::move(kept);
    }
    SharedArray(std::initializer_list<T> values) : SharedArray(std::vector<T>(values)) {}
    SharedArray(const T* data, std::size_t size, std::shared_ptr<const void> owner)
        : data_(data), size_(size), owner_(std::move(owner)) {}

    const T* data() const { return data_; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }

  private:
    const T* data_ = nullptr;
    std::size_t size_ = 0;
    std::shared_ptr<const void> owner_;
};

}  // namespace dg
