#include "core/readers/gltf/draco.hpp"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <exception>
#include <memory>
#include <type_traits>

namespace lightnet::gltf {
namespace {

/// The beginning of a packed mesh, read before the library takes memory for what it promises.
class Beginning {
public:
    explicit Beginning(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// None: not a mesh of the version that glTF has, or it ends early.
    std::optional<std::uint64_t> triangles() {
        constexpr std::uint64_t mesh = 1, by_edges = 1, has_metadata = 0x80;
        for (const char c : {'D', 'R', 'A', 'C', 'O'})
            if (byte() != static_cast<unsigned char>(c)) return std::nullopt;
        if (byte() != 2 || byte() != 2 || byte() != mesh) return std::nullopt;
        const auto method = byte();
        byte();
        if (byte() & has_metadata && !skip_metadata()) return std::nullopt;
        if (method == by_edges) {
            byte();    // how it goes from triangle to triangle
            number();  // vertices
        }
        const auto count = number();
        return early_ ? std::nullopt : std::optional(count);
    }

private:
    std::uint64_t byte() {
        if (at_ < bytes_.size()) return std::to_integer<std::uint64_t>(bytes_[at_++]);
        early_ = true;
        return 0;
    }
    /// Seven bits in each byte, the lowest first.
    std::uint64_t number() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const auto next = byte();
            value |= (next & 0x7f) << shift;
            if (!(next & 0x80)) return value;
        }
        early_ = true;
        return 0;
    }
    void skip(std::uint64_t count) {
        early_ |= count > bytes_.size() - at_;
        at_ = early_ ? bytes_.size() : at_ + static_cast<std::size_t>(count);
    }
    bool skip_metadata() {
        for (auto attributes = number(); attributes > 0 && !early_; --attributes) {
            number();
            skip_entries(0);
        }
        skip_entries(0);
        return !early_;
    }
    void skip_entries(int depth) {
        if (depth > 16) early_ = true;
        for (auto entries = number(); entries > 0 && !early_; --entries) {
            skip(byte());
            skip(number());
        }
        for (auto below = number(); below > 0 && !early_; --below) {
            skip(byte());
            skip_entries(depth + 1);
        }
    }

    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    bool early_ = false;
};

template <class Stored>
bool read(const draco::PointAttribute& attribute, std::uint32_t points, Values& values) {
    std::vector<Stored> one(values.width);
    for (std::uint32_t i = 0; i < points; ++i) {
        if (!attribute.ConvertValue<Stored>(attribute.mapped_index(draco::PointIndex(i)),
                                            static_cast<std::int8_t>(values.width), one.data()))
            return false;
        for (std::size_t j = 0; j < values.width; ++j) values.numbers[i * values.width + j] = float(one[j]);
    }
    return true;
}

std::optional<Values> values_of(const draco::PointAttribute& attribute, std::uint32_t points) {
    Values values;
    values.width = static_cast<std::size_t>(attribute.num_components());
    if (values.width < 1 || values.width > 4) return std::nullopt;
    values.numbers.resize(values.width * points);
    const bool real = attribute.data_type() == draco::DT_FLOAT32 || attribute.data_type() == draco::DT_FLOAT64;
    if (!(real ? read<float>(attribute, points, values) : read<std::int64_t>(attribute, points, values)))
        return std::nullopt;
    return values;
}

std::optional<Unpacked> plain(const draco::Mesh& mesh) {
    Unpacked result;
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
        for (const auto& corner : mesh.face(face)) result.corners.push_back(corner.value());
    for (std::int32_t i = 0; i < mesh.num_attributes(); ++i) {
        const auto* attribute = mesh.attribute(i);
        auto values = values_of(*attribute, mesh.num_points());
        if (!values) return std::nullopt;
        result.attributes.emplace(attribute->unique_id(), *std::move(values));
    }
    return result;
}

std::optional<Unpacked> unpack(std::span<const std::byte> bytes) try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    return mesh.ok() ? plain(*mesh.value()) : std::nullopt;
} catch (const std::exception&) {
    return std::nullopt;
}

}  // namespace

std::optional<Unpacked> unpack_mesh(const At& where, std::span<const std::byte> bytes, std::uint64_t most) {
    const auto promised = Beginning(bytes).triangles();
    if (promised && *promised > most) {
        where.error(fmt::format("promises {} triangles, far more than the file holds", *promised));
        return std::nullopt;
    }
    auto mesh = promised ? unpack(bytes) : std::nullopt;
    if (!mesh) where.error("is damaged, or no Draco mesh of version 2.2: its bytes can't be unpacked");
    return mesh;
}

}  // namespace lightnet::gltf
