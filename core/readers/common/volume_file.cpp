#include "core/readers/common/volume_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

[[noreturn]] void refuse(const std::string& what) { throw Error("volume file: " + what); }

struct Header {
    std::array<char, 3> magic;
    std::uint8_t version;
    std::int32_t type;
    std::array<std::int32_t, 3> size;
    std::int32_t channels;
    std::array<float, 6> box;
};
static_assert(sizeof(Header) == 48);

enum Type : std::int32_t { float32 = 1, uint8 = 3 };

Header checked_volume_header(std::span<const std::byte> bytes) {
    Header header{};
    if (bytes.size() < sizeof header) refuse("the file ends early");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.magic != std::array{'V', 'O', 'L'}) refuse("the file does not begin with 'VOL'");
    if (header.version != 3) refuse(fmt::format("version {} is not known (3 is)", header.version));
    if (header.type != float32 && header.type != uint8)
        refuse(fmt::format("numbers of type {} are not known (1, floats, and 3, bytes, are)", header.type));
    if (header.channels != 1 && header.channels != 3)
        refuse(fmt::format("{} numbers a point are not known (1 and 3 are)", header.channels));
    constexpr std::int32_t most = 1 << 14;
    for (const std::int32_t size : header.size)
        if (size < 1 || size > most)
            refuse(fmt::format("{} points along an axis are not between 1 and {}", size, most));
    return header;
}

}  // namespace

VolumeFile read_volume_file(std::span<const std::byte> bytes, VolumeGrid grid, VolumeNumbers allowed) {
    const Header header = checked_volume_header(bytes);
    for (std::size_t axis = 0; axis < 3; ++axis) grid.size[axis] = static_cast<std::uint32_t>(header.size[axis]);
    grid.channels = static_cast<std::uint32_t>(header.channels);
    const std::size_t count = grid.points() * grid.channels, each = header.type == float32 ? 4 : 1;
    const auto numbers = bytes.subspan(sizeof header);
    if (numbers.size() / each < count) refuse("the file ends early");
    grid.values.resize(count);
    if (header.type == float32)
        std::memcpy(grid.values.data(), numbers.data(), count * each);
    else
        std::transform(numbers.begin(), numbers.begin() + std::ptrdiff_t(count), grid.values.begin(),
                       [](std::byte value) { return float(value) / 255; });
    const bool any = allowed == VolumeNumbers::any;
    const auto sound = [&](float value) { return std::isfinite(value) && (any || value >= 0); };
    if (!std::all_of(grid.values.begin(), grid.values.end(), sound))
        refuse(any ? "a number is not finite" : "a number is negative or not finite");
    const auto& box = header.box;
    if (!std::all_of(box.begin(), box.end(), [](float value) { return std::isfinite(value); }))
        refuse("its box is not finite");
    return {std::make_shared<const VolumeGrid>(std::move(grid)), {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}};
}

}  // namespace lightnet
