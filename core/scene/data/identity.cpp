#include "core/scene/data/identity.hpp"

#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <variant>

namespace lightnet {
namespace {

/// Of which equal values have equal bytes, as nothing lies between their numbers. (0 and -0 are told apart, which does
/// no harm.)
template <class T>
constexpr bool as_bytes = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
constexpr bool as_bytes<Vec2> = sizeof(Vec2) == 2 * sizeof(float);
template <>
constexpr bool as_bytes<Vec3> = sizeof(Vec3) == 3 * sizeof(float);
template <>
constexpr bool as_bytes<Rgb> = sizeof(Rgb) == 3 * sizeof(float);
template <>
constexpr bool as_bytes<Matrix> = sizeof(Matrix) == 16 * sizeof(double);
template <class T, std::size_t n>
constexpr bool as_bytes<std::array<T, n>> = as_bytes<T>;

/// Everything that it is shown, one after the other; whoever shows less than before must say so, or two scenes could
/// look alike.
class Sum {
public:
    Hash finish() {
        flush();
        return hasher_.finish();
    }

    template <class T>
    void add(const T& value) {
        if constexpr (as_bytes<T>)
            add_bytes(std::as_bytes(std::span(&value, 1)));
        else
            visit_members(value, [&](const auto&... members) { (add(members), ...); });
    }
    template <class T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <class... T>
    void add(const std::variant<T...>& value) {
        add(value.index());
        std::visit([&](const auto& one) { add(one); }, value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        if constexpr (as_bytes<T>)
            add_bytes(std::as_bytes(std::span(values)));
        else
            for (const T& value : values) add(value);
    }
    void add(const std::monostate&) {}
    // Textures share pictures, which are large.
    void add(const std::shared_ptr<const Image>& image) {
        auto& hash = pictures_[image.get()];
        if (!hash) hash = image ? image->content() : Hash{};
        add(hash->bytes);
    }

    void add(const std::shared_ptr<const VolumeGrid>& grid) { add(grid ? grid->content().bytes : Hash{}.bytes); }
    void add(const std::shared_ptr<const Measurement>& measured) {
        add(measured ? measured->content().bytes : Hash{}.bytes);
    }

private:
    void add_bytes(std::span<const std::byte> bytes) {
        constexpr std::size_t enough = 1 << 16;  // many small numbers go to the hash together
        if (bytes.size() >= enough || buffer_.size() >= enough) flush();
        if (bytes.size() >= enough) return hasher_.add(bytes);
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
    void flush() {
        hasher_.add(buffer_);
        buffer_.clear();
    }

    Hasher hasher_;
    std::vector<std::byte> buffer_;
    std::map<const Image*, std::optional<Hash>> pictures_;
};

}  // namespace

// DECISIONS: identity-of-a-scene
Hash identity_of(const SceneData& scene) {
    Sum sum;
    sum.add(scene);
    return sum.finish();
}

}  // namespace lightnet
