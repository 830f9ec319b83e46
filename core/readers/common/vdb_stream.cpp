#include "core/readers/common/vdb_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/readers/files/blosc.hpp"
#include "core/readers/files/gzip.hpp"

namespace lightnet::vdb {
namespace {

// As openvdb/io/Compression.h has them.
enum Packing : std::uint32_t { zip = 1, active_only = 2, blosc = 4 };
/// What stands for parts that are not active, where they are not stored.
enum Inactive : std::uint8_t {
    background = 0,
    minus_background = 1,
    one_value = 2,
    either_background = 3,    // a mask says of which sign
    value_or_background = 4,  // a mask says which
    either_of_two = 5,        // a mask says which
    stored = 6
};

/// That many bytes, unpacked, in `room` if they were packed.
std::span<const std::byte> unpacked(Stream& stream, std::uint64_t size, std::uint32_t packing,
                                    std::vector<std::byte>& room) {
    if (!(packing & (zip | blosc))) return stream.part(size);
    const auto packed = stream.get<std::int64_t>();  // bytes; not above 0: they are not packed
    if (packed <= 0) {
        if (packed != -static_cast<std::int64_t>(size)) throw Error("a part of it has another size than it should");
        return stream.part(size);
    }
    const auto bytes = stream.part(static_cast<std::uint64_t>(packed));
    if (packing & blosc) {
        room.resize(size);
        unpack_blosc(bytes, room);
    } else {
        room = unzip(bytes, size);
    }
    if (room.size() != size) throw Error("a part of it has another size than it should");
    return room;
}

// IEEE 754, binary16.
float number_of_half(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    float size = std::ldexp(float(exponent == 0 ? fraction : fraction + 1024), std::max(exponent, 1) - 25);
    if (exponent == 31)
        size = fraction ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    return bits >> 15 ? -size : size;
}

template <class Stored>
std::vector<float> stored_as(Stream& stream, std::uint32_t count, const Storage& storage, const auto& number_of) {
    std::vector<float> values(count);
    std::vector<std::byte> room;
    const CheckedBytes bytes(unpacked(stream, count * sizeof(Stored), storage.packing, room));
    for (std::uint32_t i = 0; i < count; ++i) values[i] = number_of(bytes.get<Stored>(sizeof(Stored) * i));
    return values;
}

std::vector<float> stored_numbers(Stream& stream, std::uint32_t count, const Storage& storage) {
    using Number = Storage::Number;
    const auto as_float = [](auto number) { return static_cast<float>(number); };
    if (storage.of_leaves == Number::single) return stored_as<float>(stream, count, storage, as_float);
    if (storage.of_leaves == Number::twice) return stored_as<double>(stream, count, storage, as_float);
    if (count == 0) return {};  // and nothing is stored
    return stored_as<std::uint16_t>(stream, count, storage, number_of_half);
}

}  // namespace

std::string Stream::text() {
    const auto bytes = part(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

float number(Stream& stream, const Storage& storage) {
    return storage.alone == Storage::Number::twice ? static_cast<float>(stream.get<double>()) : stream.get<float>();
}

std::vector<float> numbers(Stream& stream, const Mask& active, std::uint32_t parts, const Storage& storage) {
    const auto how = stream.get<std::uint8_t>();
    if (how > stored) throw Error(fmt::format("an unknown way ({}) to store what is not active", how));
    std::array<float, 2> values{how == background ? storage.background : -storage.background, storage.background};
    if (how == one_value || how == value_or_background || how == either_of_two) values[0] = number(stream, storage);
    if (how == either_of_two) values[1] = number(stream, storage);
    const Mask chosen = how >= either_background && how <= either_of_two ? stream.mask(parts) : Mask();
    if (!(storage.packing & active_only) || how == stored) return stored_numbers(stream, parts, storage);
    const auto found = stored_numbers(stream, active.count(), storage);
    std::vector<float> all(parts);
    for (std::uint32_t n = 0, next = 0; n < parts; ++n)
        all[n] = active[n] ? found[next++] : values[!chosen.empty() && chosen[n]];
    return all;
}

}  // namespace lightnet::vdb
