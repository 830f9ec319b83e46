// A question about light: exactly what travels, so that no mode sees more precision than another.
#pragma once

#include <cstdint>
#include <type_traits>

#include "core/base/math/random.hpp"
#include "core/base/math/vec.hpp"

namespace lightnet {

/// Kinds of scattering, as bits: which lobes of a BSDF a question is about, or a sample came from.
/// A coated surface is specular and diffuse at once, so one surface may be asked about twice.
namespace lobe {
inline constexpr std::uint8_t diffuse = 1;   // broad
inline constexpr std::uint8_t glossy = 2;    // rough, but peaked
inline constexpr std::uint8_t specular = 4;  // a delta function, or too near to one to be sampled otherwise
inline constexpr std::uint8_t rough = diffuse | glossy;
inline constexpr std::uint8_t all = rough | specular;
}  // namespace lobe

/// "How much light leaves this surface point in this direction?" A light operator answers with radiance,
/// W·sr⁻¹·m⁻², that the lobes named here scatter towards `outgoing`.
struct Query {
    Key stream = 0;  // root of all random numbers of the answer
    std::uint32_t instance = no_instance;
    std::uint32_t geometry = 0;   // index into the scene's shapes
    std::uint32_t primitive = 0;  // triangle of a mesh; 0 for a sphere
    float u = 0, v = 0;           // barycentric; for spheres the octahedral normal
    Vec3 outgoing{};              // unit, world space, away from the surface
    std::uint32_t sample = 0;     // index of the sample within `stream`
    std::uint8_t lobes = lobe::rough;
    std::uint8_t depth = 0;  // scattering events between the eye and this point
    std::uint16_t pass = 0;  // mark of the pass that it belongs to: mark_of_pass(); 0 where the graph has no passes

    static constexpr std::uint32_t no_instance = 0xffffffffu;
    friend bool operator==(const Query&, const Query&) = default;
};

static_assert(sizeof(Query) == 48 && std::is_trivially_copyable_v<Query>, "a question travels in 48 bytes");

}  // namespace lightnet
