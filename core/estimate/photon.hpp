// A packet of light where it met a surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/base/math/octahedral.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/estimate/photon_time.hpp"

namespace lightnet {

/// Made by PhotonShooter. Directions are rounded, to some 0.003° where light comes from and 0.5° for the surface. The
/// group of the lamp that it left stands behind the latter. Where something moves, the time at which it came takes the
/// place of the last bits of the former: 0.1° is left of it, so that a photon is no larger for it.
struct Photon {
    Vec3 position;
    Rgb flux;  // W
    std::uint32_t incoming = 0;
    std::uint32_t surface = 0;

    Photon() = default;
    Photon(Vec3 at, Rgb power, Vec3 towards_light, Vec3 normal, std::uint32_t group = 0)
        : position(at),
          flux(power),
          incoming(packed_direction(towards_light)),
          surface(packed_normal(normal) | group << 24) {}
    static std::uint32_t group_in(std::uint32_t surface) { return surface >> 24; }

    void put_time(PhotonTime when) {
        const std::uint32_t bits = when.instant | (when.on_what_moves ? PhotonTime::instants : 0);
        incoming = (incoming & ~time_bits) | (bits & 31) | (bits >> 5) << 16;
    }
    /// Of a photon that was given one.
    PhotonTime time() const { return time_in(incoming); }
    static PhotonTime time_in(std::uint32_t incoming) {
        const std::uint32_t bits = (incoming & 31) | (incoming >> 16 & 31) << 5;
        return {bits & (PhotonTime::instants - 1), bits >= PhotonTime::instants};
    }

    /// Unit, away from the surface: where it came from.
    Vec3 towards_light() const { return unpacked_direction(incoming); }
    static Vec3 unpacked_direction(std::uint32_t packed) {
        // as signed, of which vectors can be made
        const auto part = [](std::uint32_t bits) { return float(std::int32_t(bits)) / half - 1; };
        return from_octahedral({part(packed & 0xffff), part(packed >> 16)});
    }
    /// Of the surface, unit; either side.
    Vec3 normal() const {
        const auto part = [&](unsigned shift) { return float(std::int8_t(std::uint8_t(surface >> shift))); };
        return normalize({part(0), part(8), part(16)});
    }
    /// Cosine between `normal` and that of a `surface`.
    static float cosine_between(std::uint32_t surface, Vec3 normal) {
        const auto part = [&](unsigned shift) { return float(std::int32_t((surface >> shift & 255) ^ 128) - 128); };
        return (part(0) * normal.x + part(8) * normal.y + part(16) * normal.z) * (1.0f / 127);
    }
    float cosine_to(Vec3 normal) const { return cosine_between(surface, normal); }

private:
    static constexpr float half = 32767.5f;
    static constexpr std::uint32_t time_bits = 0x001f001f;  // of `incoming`

    static std::uint32_t packed_direction(Vec3 direction) {
        const Vec2 p = to_octahedral(direction);
        const auto part = [](float x) {
            return static_cast<std::uint32_t>(std::clamp(std::nearbyint((x + 1) * half), 0.0f, 2 * half));
        };
        return part(p.x) | part(p.y) << 16;
    }
    static std::uint32_t packed_normal(Vec3 n) {
        const auto part = [](float x) -> std::uint32_t {
            return std::uint8_t(std::int8_t(std::clamp(std::nearbyint(x * 127), -127.0f, 127.0f)));
        };
        return part(n.x) | part(n.y) << 8 | part(n.z) << 16;
    }
};

static_assert(sizeof(Photon) == 32 && std::is_trivially_copyable_v<Photon>, "photons travel as bytes");

}  // namespace lightnet
