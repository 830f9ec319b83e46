// Numbers out of a glTF document's buffers.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {
namespace {

enum class Component { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

std::size_t size_of(Component type) {
    return type == Component::i8 || type == Component::u8     ? 1
           : type == Component::i16 || type == Component::u16 ? 2
                                                              : 4;
}

template <class Stored>
Stored load(const std::byte* at) {
    Stored value{};
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// What a whole number means as a share of the largest.
double share_of(double value, Component type) {
    const double most = type == Component::i8    ? 127
                        : type == Component::u8  ? 255
                        : type == Component::i16 ? 32767
                        : type == Component::u16 ? 65535
                        : type == Component::u32 ? 4294967295.0
                                                 : 1;
    return type == Component::f32 ? value : std::max(value / most, -1.0);
}

double component(const std::byte* at, Component type, bool normalised) {
    const auto stored = [&]() -> double {
        switch (type) {
            case Component::i8:
                return load<std::int8_t>(at);
            case Component::u8:
                return load<std::uint8_t>(at);
            case Component::i16:
                return load<std::int16_t>(at);
            case Component::u16:
                return load<std::uint16_t>(at);
            case Component::u32:
                return load<std::uint32_t>(at);
            default:
                return double(load<float>(at));
        }
    };
    return normalised ? share_of(stored(), type) : stored();
}

std::optional<Component> component_of(const At& at, bool indices) {
    const auto code = at.whole(0);
    for (const auto type :
         {Component::i8, Component::u8, Component::i16, Component::u16, Component::u32, Component::f32})
        if (code == static_cast<std::uint64_t>(type)) {
            if (!indices || type == Component::u8 || type == Component::u16 || type == Component::u32) return type;
            break;
        }
    at.error(indices ? "must be a type of whole numbers without a sign" : "is no component type");
    return std::nullopt;
}

std::optional<std::size_t> width_of(const At& at) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 5> names{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}}};
    const std::string type = at.text("");
    for (const auto& [name, width] : names)
        if (type == name) return width;
    at.error("is no type of vectors");
    return std::nullopt;
}

}  // namespace

struct Document::Layout {
    Component type = Component::f32;
    bool normalised = false;
    std::size_t width = 1, count = 0, stride = 0;
    std::span<const std::byte> bytes;  // empty: zeros
};

/// A file may ask for the same bytes again and again; in all it gets a multiple of what it has.
bool Document::spend(const At& where, std::uint64_t elements) {
    constexpr std::uint64_t at_least = std::uint64_t{1} << 22;
    spent_ += elements;
    if (spent_ <= at_least + 16 * (loaded_ + bytes_->size())) return true;
    where.error("asks for far more than the file holds");
    return false;
}

std::optional<Document::Layout> Document::layout(const At& accessor) {
    Layout layout;
    const auto type = component_of(accessor["componentType"], false);
    const auto width = width_of(accessor["type"]);
    const auto count = accessor["count"].whole();
    if (!type || !width || !count) return std::nullopt;
    layout.type = *type, layout.width = *width;
    layout.normalised = accessor["normalized"].boolean(false);
    const std::size_t element = size_of(*type) * *width;
    layout.stride = element;
    if (accessor["bufferView"]) {
        const auto bytes = view(accessor["bufferView"]);
        if (!bytes) return std::nullopt;
        const At view_at = root()["bufferViews"][static_cast<std::size_t>(accessor["bufferView"].whole(0))];
        const std::uint64_t offset = accessor["byteOffset"].whole(0), stride = view_at["byteStride"].whole(element);
        const bool fits = offset <= bytes->size() && stride >= 1 && stride <= 65536 && *count <= bytes->size() &&
                          (*count == 0 || (offset + element <= bytes->size() &&
                                           (*count - 1) * stride <= bytes->size() - offset - element));
        if (!fits) {
            accessor.error(fmt::format("reaches beyond its buffer view of {} bytes", bytes->size()));
            return std::nullopt;
        }
        layout.bytes = bytes->subspan(offset);
        layout.stride = stride;
    }
    if (!spend(accessor, *count * *width)) return std::nullopt;
    layout.count = *count;
    return layout;
}

template <class Value>
bool Document::overlay(const At& sparse, const Layout& layout, std::vector<Value>& values) {
    const auto count = sparse["count"].whole();
    const auto type = component_of(sparse["indices"]["componentType"], true);
    const auto indices = view(sparse["indices"]["bufferView"]), bytes = view(sparse["values"]["bufferView"]);
    if (!count || !type || !indices || !bytes) {
        sparse.error("is not complete");
        return false;
    }
    const std::uint64_t index_at = sparse["indices"]["byteOffset"].whole(0),
                        value_at = sparse["values"]["byteOffset"].whole(0);
    const std::size_t step = size_of(*type), each = size_of(layout.type), element = each * layout.width;
    if (*count > layout.count || index_at > indices->size() || *count * step > indices->size() - index_at ||
        value_at > bytes->size() || *count * element > bytes->size() - value_at) {
        sparse.error("reaches beyond its buffer views");
        return false;
    }
    for (std::size_t i = 0; i < *count; ++i) {
        const auto target = static_cast<std::size_t>(component(indices->data() + index_at + i * step, *type, false));
        if (target >= layout.count) {
            sparse.error(fmt::format("has the index {}, but there are {}", target, layout.count));
            return false;
        }
        for (std::size_t j = 0; j < layout.width; ++j)
            values[target * layout.width + j] = static_cast<Value>(
                component(bytes->data() + value_at + i * element + j * each, layout.type, layout.normalised));
    }
    return true;
}

template <class Value>
std::optional<std::vector<Value>> Document::decoded(const At& accessor_index, std::size_t& width) {
    const At accessors = root()["accessors"];
    const auto index = accessor_index.index(accessors.size());
    if (!index) return std::nullopt;
    const At accessor = accessors[*index];
    const auto found = layout(accessor);
    if (!found) return std::nullopt;
    const std::size_t each = size_of(found->type);
    if (std::is_integral_v<Value> && !component_of(accessor["componentType"], true)) return std::nullopt;
    std::vector<Value> values(found->count * found->width);
    if (!found->bytes.empty())
        for (std::size_t i = 0; i < found->count; ++i)
            for (std::size_t j = 0; j < found->width; ++j)
                values[i * found->width + j] = static_cast<Value>(
                    component(found->bytes.data() + i * found->stride + j * each, found->type, found->normalised));
    if (accessor["sparse"] && !overlay(accessor["sparse"], *found, values)) return std::nullopt;
    width = found->width;
    return values;
}

std::optional<Values> Document::values(const At& accessor_index) {
    Values values;
    auto numbers = decoded<float>(accessor_index, values.width);
    if (!numbers) return std::nullopt;
    values.numbers = *std::move(numbers);
    return values;
}

void Document::normalise(const At& accessor_index, Values& values) const {
    const At accessors = root()["accessors"];
    const auto index = accessor_index.index(accessors.size());
    if (!index || !accessors[*index]["normalized"].boolean(false)) return;
    const auto type = component_of(accessors[*index]["componentType"], false);
    if (!type) return;
    for (float& number : values.numbers) number = float(share_of(double(number), *type));
}

std::optional<std::vector<std::uint32_t>> Document::indices(const At& accessor_index) {
    std::size_t width = 0;
    auto numbers = decoded<std::uint32_t>(accessor_index, width);
    if (!numbers || width == 1) return numbers;
    accessor_index.error("must name an accessor of single numbers");
    return std::nullopt;
}

}  // namespace lightnet::gltf
