// Surfaces with gloss, many at once.
#pragma once

#include <array>
#include <cstdint>

#include "core/scene/bare_lights/light_sample.hpp"
#include "core/scene/bsdf/bsdf.hpp"
#include "core/scene/bsdf/coated_diffuse.hpp"
#include "core/scene/bsdf/conductor.hpp"
#include "core/scene/bsdf/model_columns.hpp"
#include "core/scene/bsdf/principled.hpp"
#include "core/scene/surfaces/heuristic.hpp"
#include "core/scene/surfaces/mesh_points.hpp"

namespace lightnet {

/// Points of one model with gloss, by its formulas (see seen.hpp), shaded in columns as LambertianSurfaces are: what
/// each is told is what it would be told alone, to the bit.
template <class Seen>
class GlossySurfaces : public MeshPoints {
public:
    /// Adds the point of a hit on `shape`, seen from `outgoing`; there is room for it. `who`: the caller's. Only these
    /// `lobes` count: all rough ones, and maybe specular ones.
    void add(std::uint32_t who, const ColumnShape& shape, const Hit& hit, Vec3 outgoing, std::uint8_t lobes);
    void find_points() { find_places(); }
    /// How they scatter: before anything of the following is asked.
    void find_bsdfs();

    Bsdf bsdf(std::size_t i) const;
    std::uint8_t lobes(std::size_t i) const { return lobes_[i]; }
    /// Else what it sends on from lamps goes by the cosine.
    bool has_gloss(std::size_t i) const { return columns_.has_gloss(i); }

    /// Does sample() look at choices?
    static constexpr bool chooses = Seen::Model::chooses;
    void set_choice(std::size_t i, float choice) { choices_[i] = choice; }
    /// As Bsdf has it.
    CosineChoices cosine_choices(std::size_t i) const {
        return dark_[i] ? CosineChoices{} : columns_[i].cosine_choices();
    }
    /// Does sample() go by the cosine, by its choice?
    bool goes_by_cosine(std::size_t i) const { return cosine_choices(i).contain(choices_[i]); }
    /// What Bsdf::sample() gives for each, by set_numbers() and set_choice().
    struct Steps {
        Columns3 incoming, weight;
        Column pdf;
        Flags found, rough, lobe;  // rough: found, and not by a mirror
    };
    const Steps& sample();
    /// What was drawn last.
    const Steps& steps() const { return steps_; }

    /// What ray_to_lamp() gives for each, of lamps that were sampled for it.
    const RaysToLamp& look_at(const LightSamples& lamps, Heuristic heuristic);
    /// What look_at() gives without the weight that both techniques share by: the light is whole.
    const RaysToLamp& look_at_whole(const LightSamples& lamps);

private:
    struct Facing;
    struct Arriving;
    template <bool whole>
    struct Looking;
    template <bool whole>
    const RaysToLamp& look(const LightSamples& lamps, Heuristic heuristic);
    struct Proposing;
    struct Finishing;

    std::array<std::uint8_t, lanes> lobes_;
    ModelColumns<Seen> columns_;
    Columns3 across_, along_, up_;  // the frame of each
    Columns3 seen_;                 // outgoing, in it; z above 0
    Flags turned_, dark_;           // it is seen from below; nothing is seen of it
    Columns3 lit_;                  // where light comes from, in the frame; z as that of seen_
    Flags leaks_;                   // of that light nothing arrives
    Column choices_;
    Flags proposed_;
    Steps steps_;
};

extern template class GlossySurfaces<SeenCoatedDiffuse<GgxLaw>>;
extern template class GlossySurfaces<SeenCoatedDiffuse<BeckmannLaw>>;
extern template class GlossySurfaces<SeenConductor<GgxLaw>>;
extern template class GlossySurfaces<SeenConductor<BeckmannLaw>>;
extern template class GlossySurfaces<SeenPrincipled>;
template <class Law>
using CoatedSurfaces = GlossySurfaces<SeenCoatedDiffuse<Law>>;
template <class Law>
using MetalSurfaces = GlossySurfaces<SeenConductor<Law>>;
using PrincipledSurfaces = GlossySurfaces<SeenPrincipled>;

}  // namespace lightnet
