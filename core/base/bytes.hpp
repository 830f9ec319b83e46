// Bytes that several may look at, and values as such bytes.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace lightnet {

/// Constant and shared: a file's content, a result. Any thread may read.
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

/// A copy of these values, as they lie in memory.
template <class T>
Bytes bytes_of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto bytes = std::as_bytes(values);
    return std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
}
template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    return bytes_of(std::span<const T>(values));
}

/// The reverse; null holds no values. What is left over behind the last whole value is dropped.
template <class T>
std::vector<T> values_of(const Bytes& data) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(data ? data->size() / sizeof(T) : 0);
    if (!values.empty()) std::memcpy(values.data(), data->data(), values.size() * sizeof(T));
    return values;
}

}  // namespace lightnet
