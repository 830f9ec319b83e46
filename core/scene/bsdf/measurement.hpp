// Measurements of a goniophotometer, in the coordinates of Dupuy & Jakob 2018, "An Adaptive
// Parameterization for Efficient Material Acquisition and Rendering".
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/hash.hpp"
#include "core/base/math/rgb.hpp"
#include "core/base/math/vec.hpp"
#include "core/scene/bsdf/scattering.hpp"
#include "core/scene/bsdf/square_densities.hpp"

namespace lightnet {

/// One measured surface; many places of many surfaces look at it. Any thread may ask.
// DECISIONS: measured-as-it-was
class Measurement {
public:
    /// As a file has it. A facet's normal at an angle θ to the surface's, turned by φ from +x, lies at (√(2θ/π),
    /// 1/2 + φ/2π) of the unit square, where φ is counted from the viewer's azimuth if there are one or two azimuths
    /// only (alike however it is turned); a viewer lies there by its own angles.
    struct Numbers {
        std::vector<float> azimuths,
            angles;  // of viewers, radians, ascending: a table for each pair, azimuth by azimuth
        GridSize facet_grid, area_grid;
        std::vector<float> facets, areas;  // density of normals; what the viewer sees of the facets, per area
        GridSize seen_grid, light_grid;
        std::vector<float> seen;   // density of normals by how much the viewer sees of them
        std::vector<float> light;  // how bright, where the former is evenly distributed
        std::vector<Rgb> colours;  // there: of what is reflected
        bool times_facets = true;  // colours are multiplied with facets / (4 × areas)
        std::uint32_t folds = 1;   // 2: alike when turned by π, 4: alike on both sides of x and of y; azimuths
                                   // below 0 (and, of 4, with x below 0) are there then
    };

    /// Numbers that agree with each other: see read_measurement().
    explicit Measurement(Numbers numbers);

    bool isotropic() const { return numbers_.azimuths.size() <= 2; }
    /// As Bsdf says; both directions above the surface.
    BsdfValue value(Vec3 outgoing, Vec3 incoming) const;
    /// The facet's normal that a point of the unit square leads to, by importance.
    Vec3 sample_facet(Vec3 outgoing, Vec2 u) const;
    /// Names what was measured.
    const Hash& content() const { return content_; }

private:
    struct Seen;
    Seen seen_from(Vec3 outgoing) const;
    Rgb colour(Vec2 place, const TableBlend& blend) const;

    Numbers numbers_;  // without densities
    SquareDensities seen_, light_;
    Hash content_;
};

}  // namespace lightnet
