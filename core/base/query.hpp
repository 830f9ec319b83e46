// A question about light: exactly what travels, so that no mode sees more precision than another.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "core/base/math/random.hpp"
#include "core/base/math/shutter.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Kinds of scattering, as bits: which lobes of a BSDF a question is about, or a sample came from.
/// A coated surface is specular and diffuse at once, so one surface may be asked about twice. Questions may have other
/// bits besides: ways of light through hair that are left out.
namespace lobe {
inline constexpr std::uint8_t diffuse = 1;   // broad
inline constexpr std::uint8_t glossy = 2;    // rough, but peaked
inline constexpr std::uint8_t specular = 4;  // a delta function, or too near to one to be sampled otherwise
inline constexpr std::uint8_t rough = diffuse | glossy;
inline constexpr std::uint8_t all = rough | specular;
}  // namespace lobe

/// "How much light leaves this point in this direction?" A light operator answers with radiance, W·sr⁻¹·m⁻², that the
/// lobes named here scatter towards `outgoing`. The point lies on a surface, or in a medium: there the answer is what
/// one collision of light with the medium sends on.
struct Query {
    Key stream = 0;  // root of all random numbers of the answer
    std::uint32_t instance = no_instance;
    std::uint32_t geometry = 0;   // index into the scene's shapes; in_space: the point lies in a medium
    std::uint32_t primitive = 0;  // triangle of a mesh; 0 for a sphere
    float u = 0, v = 0;           // barycentric; for spheres the octahedral normal
    Vec3 outgoing{};              // unit, world space, away from the point
    std::uint32_t sample = 0;     // index of the sample within `stream`
    std::uint8_t lobes = lobe::rough;
    std::uint8_t depth = 0;  // scattering events between the eye and this point
    std::uint16_t pass = 0;  // mark of the pass that it belongs to: mark_of_pass(); 0 where the graph has no passes
    ShutterTime time = 0;    // in the shutter, at which all is meant
    std::uint16_t medium = no_medium;  // index into the scene's media: of a point in space
    std::uint32_t room = 0;            // for what comes

    /// A point in a medium, world space. Its coordinates stand where a surface has its primitive, u and v.
    void put_into_space(Vec3 at, std::uint16_t in) {
        geometry = in_space, instance = no_instance, medium = in;
        primitive = std::bit_cast<std::uint32_t>(at.x), u = at.y, v = at.z;
    }
    bool is_in_space() const { return geometry == in_space; }
    /// Of a point in space only.
    Vec3 place_in_space() const { return {std::bit_cast<float>(primitive), u, v}; }

    static constexpr std::uint32_t in_space = 0xffffffffu;
    static constexpr std::uint16_t no_medium = 0xffff;
    static constexpr std::uint32_t no_instance = 0xffffffffu;
    friend bool operator==(const Query&, const Query&) = default;
};

static_assert(sizeof(Query) == 56 && std::is_trivially_copyable_v<Query>, "a question travels in 56 bytes");

}  // namespace lightnet
