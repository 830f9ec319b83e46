// A NanoVDB grid's tree, read with a check of each offset.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "core/base/error.hpp"
#include "core/readers/common/nanovdb_file.hpp"

namespace lightnet::nanovdb {

[[noreturn]] inline void refuse(const std::string& what) { throw Error("NanoVDB file: " + what); }

/// Bytes that are read at any offset, if they are there.
class Checked {
public:
    explicit Checked(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::span<const std::byte> part(std::uint64_t at, std::uint64_t size) const {
        if (at > bytes_.size() || size > bytes_.size() - at)
            refuse("it ends early, or an offset in it leads beyond it");
        return bytes_.subspan(at, size);
    }
    template <class Value>
    Value get(std::uint64_t at) const {
        Value value;
        std::memcpy(&value, part(at, sizeof value).data(), sizeof value);
        return value;
    }
    std::size_t size() const { return bytes_.size(); }

private:
    std::span<const std::byte> bytes_;
};

/// The tree of a grid of floats.
NanovdbGrid tree_in(const Checked& grid);

}  // namespace lightnet::nanovdb
