// Mitsuba's bsdfs, made into the materials that a scene has.
#pragma once

#include <map>
#include <optional>

#include "core/readers/common/measurements.hpp"
#include "core/readers/mitsuba/textures.hpp"

namespace lightnet::mitsuba {

/// Makes the materials of one scene; what several shapes refer to is made once.
class Bsdfs {
public:
    explicit Bsdfs(Textures& textures)
        : textures_(textures), context_(textures.context()), measurements_(context_.report()) {}

    /// The material of a <bsdf>. What is wrong is reported and grey.
    MaterialId of(const Node& node);
    /// The material of a shape that names none; lamps are black.
    MaterialId unnamed(bool lamp);

private:
    using Maker = Material (Bsdfs::*)(Properties&);
    static const std::map<std::string, Maker, std::less<>>& makers();

    Material make(const Node& node);
    Material copy_of(MaterialId id) const;
    Material grey();
    std::vector<const Node*> nested(Properties& properties, std::size_t count);

    Material diffuse(Properties&);
    Material rough_diffuse(Properties&);
    Material translucent(Properties&);
    Material dielectric(Properties&);
    Material thin_dielectric(Properties&);
    Material rough_dielectric(Properties&);
    Material conductor(Properties&);
    Material rough_conductor(Properties&);
    Material plastic(Properties&);
    Material polarising_filter(Properties&);
    Material phong(Properties&);
    Material ward(Properties&);
    Material principled(Properties&);
    Material thin_principled(Properties&);
    Material two_sided(Properties&);
    Material mask(Properties&);
    Material blend(Properties&);
    Material mixture(Properties&);
    Material bump_map(Properties&);
    Material normal_map(Properties&);
    Material coating(Properties&);
    Material measured(Properties&);
    Material hair(Properties&);
    Material nothing(Properties&);

    Roughness roughness(Properties& properties, float fallback);
    ConductorMaterial metal(Properties& properties);
    Material glass(Properties& properties, const Roughness& roughness, bool thin);
    CoatedDiffuseMaterial coat(Properties& properties);
    BurleyMaterial burley(Properties& properties);
    Roughness burley_roughness(Properties& properties, bool varies);
    float mean_of(Properties& properties, std::string_view name, float fallback);
    Material highlight(Properties& properties, Roughness roughness);

    Textures& textures_;
    const Context& context_;
    Measurements measurements_;
    std::map<const Node*, std::optional<MaterialId>> made_;  // none: being made
    std::optional<MaterialId> unnamed_[2];
    int depth_ = 0;
};

}  // namespace lightnet::mitsuba
