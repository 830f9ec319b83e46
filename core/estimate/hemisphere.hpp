// All light that arrives at a point, and how it changes around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/math/frame.hpp"
#include "core/base/math/random.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/estimate/gather.hpp"

namespace lightnet {

/// What is known of the irradiance around a point. Travels and is kept as bytes.
struct IrradianceRecord {
    Vec3 position, normal;       // the side that the light falls on; unit
    Rgb irradiance;              // W·m⁻²
    float distance = 0;          // m: harmonic mean of the distances to what is seen
    float nearest = 0;           // m: the least of them
    std::array<Vec3, 3> moved;   // ∂irradiance per metre, per colour
    std::array<Vec3, 3> turned;  // ∂irradiance per radian, about an axis, per colour

    /// At a point nearby. Ward & Heckbert 1992, "Irradiance gradients", equation 1.
    Rgb at(Vec3 point, Vec3 towards) const;
};

/// Samples a cosine-weighted, stratified hemisphere: `rings` of equal projected area, each of `sectors`.
class Hemisphere {
public:
    /// Of about so many rays, so that cells are about as wide as high.
    explicit Hemisphere(std::size_t rays);

    std::size_t size() const { return rings_ * sectors_; }
    /// Appends the rays of one point, ring by ring. `origin`: off the surface.
    void add_rays(Vec3 origin, Vec3 normal, Key stream, std::uint8_t depth, std::vector<GatherRay>& rays) const;
    /// What they found, as a record. Gradients: Ward & Heckbert 1992, in the form of Krivanek et al. 2005, equation 14.
    IrradianceRecord record(Vec3 position, Vec3 normal, std::span<const GatherResult> found) const;
    /// How noisy the irradiance is that rays find from one point, from two times that they looked from there: standard
    /// deviation of either, relative. Light of `groups` of lamps stands side by side.
    static float noise(std::span<const GatherResult> once, std::span<const GatherResult> again, std::size_t groups = 1);

private:
    struct Ring {
        float low, high;  // sines of its borders
        float cosine;     // at the lower one
        float tangent;    // on average
    };
    struct Sector {
        Vec2 middle, across, start;  // directions in the plane: its middle's, turned by 90°; its start's turned by 90°
    };

    std::size_t rings_, sectors_;
    std::vector<Ring> ring_;
    std::vector<Sector> sector_;
};

}  // namespace lightnet
