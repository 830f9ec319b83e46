// Plain surfaces as a guide knows them, many at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/scene/surfaces/lambertian_surfaces.hpp"

namespace lightnet {

/// What GuidedPoint is for one point, for many that scatter evenly, to the bit: in loops without a branch where there
/// is arithmetic, and side by side through the guide's tree, where one alone would wait for each of its branches.
class GuidedColumns {
public:
    /// Nobody is guided.
    void clear() { count_ = 0; }
    void find(const LightGuide& guide, const LambertianSurfaces& surfaces);

    bool knows(std::size_t i) const { return i < count_ && cells_[i]; }
    /// Mean radiance that arrives; below 0: nothing is known.
    float radiance(std::size_t i) const { return knows(i) ? cells_[i]->radiance : -1; }
    GuidedPoint point(std::size_t i) const {
        return knows(i) ? GuidedPoint(cells_[i], {up_[i], turned_[i] != 0}, true) : GuidedPoint();
    }

    /// Takes the numbers by which surfaces, those of find(), send paths on to where they lie by the guide; leaves them
    /// as they are where it knows nothing.
    void warp(LambertianSurfaces& surfaces);
    /// How much denser than by the surface alone.
    float favour(std::size_t i) const { return favour_[i]; }

    /// What is left of the light of lamps, sampled whole, when directions by the guide find it as well: share(i).
    void share(const RaysToLamp& rays, Heuristic heuristic);
    float share(std::size_t i) const { return shares_[i]; }

private:
    struct Sides;
    struct Warping;
    struct Places;
    struct Shares;

    // All in one place, so that the compiler sees that no column is another.

    std::size_t count_ = 0;
    Columns3 position_, normal_, shading_, outgoing_;
    Columns3 up_;
    Flags turned_, turn_;
    std::array<const GuideCell*, lanes> cells_;

    struct Parts {
        std::array<std::int32_t, lanes> index, begin, width;
        void set(std::size_t i, const GuideSquare::Part& part) {
            index[i] = part.index, begin[i] = part.begin, width[i] = part.width;
        }
        GuideSquare::Part operator[](std::size_t i) const { return {index[i], begin[i], width[i]}; }
    };
    Columns2 numbers_, warped_;
    Parts column_of_, cell_of_;
    Column favour_;

    Columns3 direction_;
    Columns2 place_;
    Column height_, density_, lamp_pdf_, pdf_, shares_;
    Flags known_, bare_, from_infinity_;
};

}  // namespace lightnet
