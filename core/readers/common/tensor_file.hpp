// Files of named arrays of numbers, as RGL's measured materials come in ("tensor_file", version 1.0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lightnet {

/// The fields of such a file, whose bytes it keeps looking at.
class TensorFile {
public:
    /// Of numbers, in the order of the file's own codes.
    enum class Type : std::uint8_t {
        invalid,
        uint8,
        int8,
        uint16,
        int16,
        uint32,
        int32,
        uint64,
        int64,
        float16,
        float32,
        float64
    };
    struct Field {
        Type type = Type::invalid;
        std::vector<std::size_t> shape;  // the last index runs fastest; none of them is 0
        std::span<const std::byte> bytes;
    };

    /// Throws Error, without a file name, where the file is not sound: no field reaches beyond it.
    explicit TensorFile(std::span<const std::byte> bytes);

    bool has(std::string_view name) const { return fields_.contains(name); }
    /// Throws Error when there is none, or it has not that many dimensions.
    const Field& field(std::string_view name, std::size_t dimensions) const;
    /// The numbers of a field as floats, from float32 or float64, all of them finite. Throws Error as field() does, and
    /// where they are not.
    std::vector<float> floats(std::string_view name, std::size_t dimensions) const;

private:
    std::map<std::string, Field, std::less<>> fields_;
};

}  // namespace lightnet
