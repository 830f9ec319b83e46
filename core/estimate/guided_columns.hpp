// Surfaces as a guide knows them, many at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/math/columns.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/scene/surfaces/mesh_points.hpp"

namespace lightnet {

/// What GuidedPoint is for one point, for many of one kind, to the bit: in loops without a branch where there is
/// arithmetic, and side by side through the guide's tree, where one alone would wait for each of its branches.
class GuidedColumns {
public:
    /// Nobody is guided.
    void clear() { count_ = 0; }
    /// Of LambertianSurfaces or GlossySurfaces.
    template <class Surfaces>
    void find(const LightGuide& guide, const Surfaces& surfaces) {
        for (std::size_t i = 0; i < surfaces.size(); ++i) chance_[i] = surfaces.cosine_choices(i).chance();
        find_cells(guide, surfaces);
    }

    bool knows(std::size_t i) const { return i < count_ && cells_[i]; }
    /// Mean radiance that arrives; below 0: nothing is known.
    float radiance(std::size_t i) const { return knows(i) ? cells_[i]->radiance : -1; }
    /// `choices`: of the surface.
    GuidedPoint point(std::size_t i, CosineChoices choices) const {
        return knows(i) ? GuidedPoint(cells_[i], {up_[i], turned_[i] != 0}, choices) : GuidedPoint();
    }

    /// Takes the numbers by which surfaces, those of find(), send paths on to where they lie by the guide, where that
    /// is by the cosine; leaves others as they are, and where it knows nothing.
    /// Those of whoever goes `alone` stay as well.
    template <class Surfaces, class Alone>
    void warp(Surfaces& surfaces, Alone&& alone) {
        for (std::size_t i = 0; i < count_; ++i) {
            alone_[i] = alone(surfaces.who(i));
            leads_[i] = known_[i] & std::uint32_t{surfaces.goes_by_cosine(i)};
        }
        warp_numbers(surfaces);
    }
    /// After warp(), for surfaces that have several lobes: favour() of their directions, by surfaces alone of density
    /// `pdf`. `found`: there is one, and it isn't that of a mirror.
    void find_favours(const Columns3& directions, const Column& pdf, const Flags& found);
    /// How much denser a direction is sampled than by the surface alone.
    float favour(std::size_t i) const { return favour_[i]; }

    /// What is left of the light of lamps, sampled whole, when directions by the guide find it as well: share(i).
    void share(const RaysToLamp& rays, Heuristic heuristic);
    float share(std::size_t i) const { return shares_[i]; }

private:
    struct Sides;
    struct Warping;
    struct Places;
    struct Densities;
    struct Shares;
    void find_cells(const LightGuide& guide, const MeshPoints& surfaces);
    void warp_numbers(MeshPoints& surfaces);
    void find_densities();

    // All in one place, so that the compiler sees that no column is another.

    std::size_t count_ = 0;
    Columns3 position_, normal_, shading_, outgoing_;
    Columns3 up_;
    Column chance_;  // that directions go by the cosine
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
    Column height_, density_, lamp_pdf_, pdf_, guided_pdf_, shares_;
    Flags known_, leads_, alone_, bare_, from_infinity_;
};

/// Surfaces, and what a guide knows of each.
template <class Surfaces>
struct Guided : Surfaces {
    void clear() { Surfaces::clear(), guided.clear(); }

    GuidedColumns guided;
};

}  // namespace lightnet
