#include "core/readers/mitsuba/serialized.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet::mitsuba {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

[[noreturn]] void fail(const std::string& what) { throw Error("serialized mesh: " + what); }

template <class Value>
Value value_at(std::span<const std::byte> bytes, std::size_t at) {
    Value value{};
    if (at > bytes.size() || bytes.size() - at < sizeof value) fail("the file ends early");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// The part of the file that holds one mesh, behind its header; `version` is the header's.
std::span<const std::byte> part_of(std::span<const std::byte> bytes, std::size_t index, std::uint16_t& version) {
    const auto header = [&](std::size_t at) {
        if (value_at<std::uint16_t>(bytes, at) != 0x041C) fail("the file does not begin with 0x041C");
        const auto found = value_at<std::uint16_t>(bytes, at + 2);
        if (found != 3 && found != 4) fail(fmt::format("version {} is not known (3 and 4 are)", found));
        return found;
    };
    version = header(0);
    if (index == 0) return bytes.subspan(4);  // needs no table
    const std::size_t wide = version == 4 ? 8 : 4, end = bytes.size() - 4;
    const std::uint64_t count = value_at<std::uint32_t>(bytes, end);
    if (count > end / wide) fail("the table at its end is not sound");
    if (index >= count) fail(fmt::format("there is no mesh {}: the file has {}", index, count));
    const std::size_t entry = end - wide * count + wide * index;
    const std::uint64_t at =
        version == 4 ? value_at<std::uint64_t>(bytes, entry) : value_at<std::uint32_t>(bytes, entry);
    if (at > bytes.size()) fail("the table at its end is not sound");
    version = header(static_cast<std::size_t>(at));
    return bytes.subspan(static_cast<std::size_t>(at) + 4);
}

/// Inflates piece by piece, so that nothing is allocated but for bytes that are there.
class Inflater {
public:
    explicit Inflater(std::span<const std::byte> bytes) {
        stream_.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
        left_ = bytes.size();
        room_ = (std::uint64_t{16} << 20) + 256 * std::uint64_t{bytes.size()};
        if (inflateInit(&stream_) != Z_OK) fail("zlib can't begin");
    }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream_); }

    void read(void* into, std::size_t size) {
        auto* out = static_cast<Bytef*>(into);
        if (size > room_) fail("the data are packed too tightly to be a mesh");
        room_ -= size;
        while (size > 0) {
            if (stream_.avail_in == 0) {
                stream_.avail_in = static_cast<uInt>(std::min<std::size_t>(left_, 1 << 30));
                left_ -= stream_.avail_in;
            }
            const auto piece = static_cast<uInt>(std::min<std::size_t>(size, 1 << 30));
            stream_.next_out = out;
            stream_.avail_out = piece;
            const int state = inflate(&stream_, Z_NO_FLUSH);
            const std::size_t got = piece - stream_.avail_out;
            out += got, size -= got;
            if (state == Z_STREAM_END && size > 0) fail("the data end early");
            if (state != Z_OK && state != Z_STREAM_END && size > 0) fail("the data end early or are damaged");
        }
    }

    template <class Value>
    Value value() {
        Value value{};
        read(&value, sizeof value);
        return value;
    }

    template <class Value>
    std::vector<Value> values(std::uint64_t count) {
        constexpr std::uint64_t step = 1 << 16;
        std::vector<Value> result;
        for (std::uint64_t done = 0; done < count;) {
            const auto piece = std::min(step, count - done);
            result.resize(static_cast<std::size_t>(done + piece));
            read(result.data() + done, static_cast<std::size_t>(piece) * sizeof(Value));
            done += piece;
        }
        return result;
    }

private:
    z_stream stream_{};
    std::size_t left_ = 0;
    std::uint64_t room_ = 0;  // bytes that may still come out: a small file could ask for all memory
};

/// Floats, from floats or doubles.
std::vector<float> reals(Inflater& input, std::uint64_t count, bool wide) {
    if (!wide) return input.values<float>(count);
    const auto values = input.values<double>(count);
    return {values.begin(), values.end()};
}

template <class Value, class Make>
std::vector<Value> groups(const std::vector<float>& flat, std::size_t width, const Make& make) {
    std::vector<Value> result;
    result.reserve(flat.size() / width);
    for (std::size_t i = 0; i < flat.size(); i += width) result.push_back(make(&flat[i]));
    return result;
}

std::vector<std::array<std::uint32_t, 3>> triangles(Inflater& input, std::uint64_t count, std::uint64_t vertices) {
    const auto flat = input.values<std::uint32_t>(3 * count);
    std::vector<std::array<std::uint32_t, 3>> result;
    result.reserve(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < flat.size(); i += 3) {
        for (std::size_t j = i; j < i + 3; ++j)
            if (flat[j] >= vertices)
                fail(fmt::format("a triangle has the vertex index {}, but there are {} vertices", flat[j], vertices));
        result.push_back({flat[i], flat[i + 1], flat[i + 2]});
    }
    return result;
}

}  // namespace

Mesh read_serialized(std::span<const std::byte> bytes, std::size_t index, bool& face_normals) {
    constexpr std::uint32_t has_normals = 0x1, has_uvs = 0x2, has_colours = 0x8, flat = 0x10, doubles = 0x2000;
    std::uint16_t version = 0;
    Inflater input(part_of(bytes, index, version));
    const auto flags = input.value<std::uint32_t>();
    if (version == 4)
        for (int i = 0; input.value<char>() != '\0'; ++i)  // its name
            if (i > 65536) fail("a name does not end");
    const auto vertices = input.value<std::uint64_t>(), faces = input.value<std::uint64_t>();
    if (vertices > std::numeric_limits<std::uint32_t>::max() || faces > std::numeric_limits<std::uint32_t>::max())
        fail("too many vertices or triangles");
    const bool wide = flags & doubles;
    const auto vector = [](const float* v) { return Vec3{v[0], v[1], v[2]}; };
    Mesh mesh;
    mesh.positions = groups<Vec3>(reals(input, 3 * vertices, wide), 3, vector);
    if (flags & has_normals) mesh.normals = groups<Vec3>(reals(input, 3 * vertices, wide), 3, vector);
    if (flags & has_uvs)
        mesh.uvs = groups<Vec2>(reals(input, 2 * vertices, wide), 2, [](const float* v) { return Vec2{v[0], v[1]}; });
    if (flags & has_colours)
        mesh.colours = groups<Rgb>(reals(input, 3 * vertices, wide), 3, [](const float* v) {
            return Rgb{v[0], v[1], v[2]};
        });
    mesh.triangles = triangles(input, faces, vertices);
    face_normals = flags & flat;
    for (const auto& p : mesh.positions)
        if (!finite(p)) fail("a vertex is not finite");
    return mesh;
}

}  // namespace lightnet::mitsuba
