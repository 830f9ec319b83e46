// Parts of a scene, by which a kind of node says what its nodes read.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>

namespace lightnet {

enum class ScenePart : std::uint8_t {
    camera,     // from where it is seen, through what, and the shape of the picture
    film,       // size of the picture, and what it makes of radiance
    geometry,   // shapes and where they stand, how they move, and what has holes
    materials,  // what surfaces are made of and covered with
    lamps,      // all that shines, environments included
    media,      // fog, smoke, fire
    names,      // of shapes, objects, materials and lamps
};

inline constexpr std::array all_scene_parts{ScenePart::camera,    ScenePart::film,  ScenePart::geometry,
                                            ScenePart::materials, ScenePart::lamps, ScenePart::media,
                                            ScenePart::names};

/// Some of these parts. A value.
class SceneParts {
public:
    constexpr SceneParts() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a part is the set of it alone
    constexpr SceneParts(ScenePart one) : bits_(static_cast<std::uint8_t>(1u << static_cast<unsigned>(one))) {}

    constexpr bool contain(SceneParts others) const { return (others.bits_ & ~bits_) == 0; }
    /// Throws Error where somebody reads parts that are not among these, with what should have been declared.
    constexpr void expect(SceneParts read) const {
        if (!contain(read)) [[unlikely]]
            refuse(read);
    }
    constexpr SceneParts& operator|=(SceneParts others) {
        bits_ = static_cast<std::uint8_t>(bits_ | others.bits_);
        return *this;
    }
    friend constexpr auto operator<=>(const SceneParts&, const SceneParts&) = default;

private:
    [[noreturn]] void refuse(SceneParts read) const;

    std::uint8_t bits_ = 0;
};

constexpr SceneParts operator|(SceneParts some, SceneParts others) { return some |= others; }
constexpr SceneParts operator|(ScenePart one, ScenePart other) { return SceneParts(one) | SceneParts(other); }

/// Surfaces, media and lamps: all that a light path depends on from a lamp to where it is looked at.
inline constexpr SceneParts scene_of_light =
    ScenePart::geometry | ScenePart::materials | ScenePart::lamps | ScenePart::media;
inline constexpr SceneParts whole_scene = scene_of_light | ScenePart::camera | ScenePart::film | ScenePart::names;

std::string to_string(ScenePart part);
/// "camera, geometry"; "nothing"; "everything".
std::string to_string(SceneParts parts);

}  // namespace lightnet
