#include "core/readers/common/tensor_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/printable.hpp"

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr std::size_t most_dimensions = 8;

[[noreturn]] void unsound(const std::string& what) { throw Error("tensor file: " + what); }

/// Takes a file from its beginning, piece by piece.
class TensorBytes {
public:
    explicit TensorBytes(std::span<const std::byte> bytes) : rest_(bytes) {}

    std::span<const std::byte> take(std::size_t size) {
        if (size > rest_.size()) unsound("the file ends early");
        const auto piece = rest_.first(size);
        rest_ = rest_.subspan(size);
        return piece;
    }
    template <class Number>
    Number number() {
        Number number{};
        std::memcpy(&number, take(sizeof number).data(), sizeof number);
        return number;
    }
    std::string text(std::size_t size) {
        const auto piece = take(size);
        return {reinterpret_cast<const char*>(piece.data()), piece.size()};
    }

private:
    std::span<const std::byte> rest_;
};

std::size_t bytes_of_one(std::uint8_t type) {
    constexpr std::array<std::size_t, 12> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    if (type == 0 || type >= sizes.size()) unsound(fmt::format("there is no type of numbers {}", type));
    return sizes[type];
}

std::pair<std::string, TensorFile::Field> next_field(TensorBytes& header, std::span<const std::byte> whole) {
    std::string name = header.text(header.number<std::uint16_t>());
    const auto dimensions = header.number<std::uint16_t>();
    TensorFile::Field field;
    const auto type = header.number<std::uint8_t>();
    std::size_t size = bytes_of_one(type);
    field.type = static_cast<TensorFile::Type>(type);
    const auto offset = header.number<std::uint64_t>();
    const auto said = [&] { return "field '" + printable(name.substr(0, 32)) + "' "; };
    if (dimensions == 0 || dimensions > most_dimensions)
        unsound(said() + fmt::format("has {} dimensions, not 1 to {}", dimensions, most_dimensions));
    if (offset > whole.size()) unsound(said() + "lies beyond the end of the file");
    const std::size_t room = whole.size() - static_cast<std::size_t>(offset);
    for (std::size_t i = 0; i < dimensions; ++i) {
        const auto length = header.number<std::uint64_t>();
        if (length == 0) unsound(said() + "is empty");
        if (length > room / size) unsound(said() + "reaches beyond the end of the file");
        field.shape.push_back(static_cast<std::size_t>(length));
        size *= static_cast<std::size_t>(length);
    }
    field.bytes = whole.subspan(static_cast<std::size_t>(offset), size);
    return {std::move(name), std::move(field)};
}

template <class Number>
std::vector<float> as_floats(std::span<const std::byte> bytes) {
    std::vector<float> result(bytes.size() / sizeof(Number));
    for (std::size_t i = 0; i < result.size(); ++i) {
        Number number;
        std::memcpy(&number, bytes.data() + i * sizeof number, sizeof number);
        result[i] = static_cast<float>(number);
    }
    return result;
}

}  // namespace

TensorFile::TensorFile(std::span<const std::byte> bytes) {
    TensorBytes header(bytes);
    if (header.text(12) != std::string("tensor_file\0", 12)) unsound("the file does not begin with 'tensor_file'");
    const auto major = header.number<std::uint8_t>(), minor = header.number<std::uint8_t>();
    if (major != 1 || minor != 0) unsound(fmt::format("version {}.{} is not known (1.0 is)", major, minor));
    for (auto left = header.number<std::uint32_t>(); left > 0; --left) {
        auto [name, field] = next_field(header, bytes);
        fields_.insert_or_assign(std::move(name), std::move(field));
    }
}

const TensorFile::Field& TensorFile::field(std::string_view name, std::size_t dimensions) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) unsound(fmt::format("there is no field '{}'", name));
    if (found->second.shape.size() != dimensions)
        unsound(fmt::format("field '{}' has {} dimensions, not {}", name, found->second.shape.size(), dimensions));
    return found->second;
}

std::vector<float> TensorFile::floats(std::string_view name, std::size_t dimensions) const {
    const Field& found = field(name, dimensions);
    if (found.type != Type::float32 && found.type != Type::float64)
        unsound(fmt::format("field '{}' is not of floats", name));
    auto numbers = found.type == Type::float32 ? as_floats<float>(found.bytes) : as_floats<double>(found.bytes);
    if (!std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); }))
        unsound(fmt::format("a number of field '{}' is not finite", name));
    return numbers;
}

}  // namespace lightnet
