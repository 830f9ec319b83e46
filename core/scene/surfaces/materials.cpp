#include "core/scene/surfaces/materials.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/error.hpp"
#include "core/scene/bsdf/albedos.hpp"
#include "core/scene/bsdf/fresnel.hpp"
#include "core/scene/surfaces/bumps.hpp"

namespace lightnet {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 can't find it out by itself

/// All textures and materials that a material names.
struct Names {
    std::vector<TextureId> textures;
    std::vector<MaterialId> materials;

    void add(std::optional<TextureId> texture) {
        if (texture) textures.push_back(*texture);
    }
    void add(const Roughness& roughness) { add(roughness.texture); }
    void add(const Metal& metal) {
        if (metal.reflectance) return add(metal.reflectance);
        textures.push_back(metal.eta);
        textures.push_back(metal.k);
    }
};

Names names_of(const Material& material) {
    Names names;
    const auto add = [&](const auto&... each) { (names.add(each), ...); };
    std::visit(
        Overloaded{[&](const DiffuseMaterial& m) { add(std::optional(m.reflectance), m.transmittance); },
                   [&](const ConductorMaterial& m) { add(m.metal, m.roughness, m.tint); },
                   [&](const DielectricMaterial& m) { add(m.roughness, m.reflected, m.transmitted); },
                   [&](const CoatedDiffuseMaterial& m) { add(std::optional(m.reflectance), m.roughness, m.tint); },
                   [&](const CoatedConductorMaterial& m) { add(m.metal, m.roughness, m.coat); },
                   [&](const PrincipledMaterial& m) {
                       add(std::optional(m.base_colour), m.metallic_texture, m.transmission_texture, m.roughness,
                           m.specular_texture, m.specular_colour_texture, m.sheen_texture, m.sheen_roughness_texture,
                           m.clearcoat_texture, m.clearcoat_roughness);
                   },
                   [&](const MixtureMaterial& m) {
                       add(std::optional(m.amount));
                       names.materials = {m.first, m.second};
                   },
                   [&](const TwoFacedMaterial& m) {
                       names.materials = {m.front, m.back};
                   },
                   [](const NoMaterial&) {}},
        material.model);
    add(material.opacity, material.normal_map, material.bump_map);
    return names;
}

bool anisotropic(const Material& material) {
    const auto grooved = [](const Roughness& r) { return r.u != r.v; };
    return std::visit(
        [&](const auto& m) {
            bool result = false;
            if constexpr (requires { m.roughness; }) result |= grooved(m.roughness);
            if constexpr (requires { m.coat; }) result |= grooved(m.coat);
            return result;
        },
        material.model);
}

bool is_solid(const Material& material) {
    if (const auto* glass = std::get_if<DielectricMaterial>(&material.model)) return !glass->thin;
    const auto* principled = std::get_if<PrincipledMaterial>(&material.model);
    return principled && !principled->thin && principled->transmission > 0;
}

bool is_blend(const Material& material) {
    return std::holds_alternative<MixtureMaterial>(material.model) ||
           std::holds_alternative<TwoFacedMaterial>(material.model);
}

void check_names(const SceneData& data) {
    for (const auto& material : data.materials) {
        const Names names = names_of(material);
        const auto missing = [](const auto& ids, std::size_t count) {
            return std::any_of(ids.begin(), ids.end(), [&](auto id) { return id >= count; });
        };
        if (missing(names.textures, data.textures.size()))
            throw Error("scene", "material '" + material.name + "' names a texture that isn't there");
        if (missing(names.materials, data.materials.size()))
            throw Error("scene", "material '" + material.name + "' names a material that isn't there");
    }
}

/// Depth first; a material that is met while it is open contains itself.
void check_cycles(const SceneData& data) {
    enum class State : std::uint8_t { fresh, open, done };
    constexpr std::size_t deepest = 64;
    std::vector<State> states(data.materials.size(), State::fresh);
    const auto visit = [&](const auto& self, MaterialId id, std::size_t depth) -> void {
        if (states[id] == State::done) return;
        if (states[id] == State::open || depth > deepest)
            throw Error("scene", "material '" + data.materials[id].name + "' is mixed from itself");
        states[id] = State::open;
        for (const MaterialId part : names_of(data.materials[id]).materials) self(self, part, depth + 1);
        states[id] = State::done;
    };
    for (MaterialId id = 0; id < data.materials.size(); ++id) visit(visit, id, 0);
}

float alpha_of(float value, Roughness::Means means) {
    switch (means) {
        case Roughness::Means::root:
            return std::sqrt(std::max(0.0f, value));
        case Roughness::Means::square:
            return value * value;
        default:
            return value;
    }
}

// Roughness of a surface that isn't a perfect mirror in both directions must not be one in either.
Ggx facets_of(const Roughness& roughness, float factor) {
    const float alpha_u = alpha_of(roughness.u * factor, roughness.means),
                alpha_v = alpha_of(roughness.v * factor, roughness.means);
    if (is_specular(alpha_u, alpha_v)) return {};
    return {std::max(alpha_u, specular_alpha), std::max(alpha_v, specular_alpha)};
}

/// None: they change over the surface.
std::optional<Ggx> only_facets_of(const Roughness& roughness) {
    return roughness.texture ? std::nullopt : std::optional(facets_of(roughness, 1));
}

Rgb limited(Rgb c) { return {std::min(1.0f, c.r), std::min(1.0f, c.g), std::min(1.0f, c.b)}; }

/// The numbers of one material at one place.
class Mixer {
public:
    Mixer(const SceneData& data, const TexturePlace& place, const Coat* coat, const CoatedMetal* coated_metal)
        : data_(data), place_(place), coat_(coat), coated_metal_(coated_metal) {}

    Bsdf::Model operator()(const DiffuseMaterial& m) const {
        const Rgb reflected = albedo(m.reflectance);
        if (m.transmittance) {
            const Rgb transmitted = albedo(*m.transmittance), sum = reflected + transmitted;
            const float most = std::max(1.0f, max_component(sum));
            return DiffuseTransmissionBsdf{reflected / most, transmitted / most};
        }
        if (m.sigma > 0) return RoughDiffuseBsdf{reflected, roughness_of_slopes(m.sigma)};
        return DiffuseBsdf{reflected};
    }
    Bsdf::Model operator()(const ConductorMaterial& m) const {
        ConductorBsdf metal = metal_of(m.metal, facets(m.roughness));
        if (m.tint) metal.tint = albedo(*m.tint);
        return metal;
    }
    Bsdf::Model operator()(const DielectricMaterial& m) const {
        GlassTints tints;
        if (m.reflected) tints.reflected = albedo(*m.reflected);
        if (m.transmitted) tints.transmitted = albedo(*m.transmitted);
        if (m.thin) return ThinDielectricBsdf{m.eta, tints};
        return DielectricBsdf{m.eta, facets(m.roughness), tints};
    }
    Bsdf::Model operator()(const CoatedDiffuseMaterial& m) const {
        CoatedDiffuseBsdf plastic{albedo(m.reflectance), coat_, facets(m.roughness)};
        if (m.tint) plastic.tint = albedo(*m.tint);
        plastic.base_colours_repeat = m.base_colours_repeat;
        return plastic;
    }
    Bsdf::Model operator()(const CoatedConductorMaterial& m) const {
        const Ggx coat = facets(m.coat), below = facets(m.roughness);
        ConductorBsdf metal = metal_of(m.metal, seen_through(below, coat, m.coat_eta));
        metal.eta = metal.eta / m.coat_eta;
        metal.k = metal.k / m.coat_eta;
        return CoatedConductorBsdf{metal, coat_, coat, coated_metal_, below};
    }
    Bsdf::Model operator()(const PrincipledMaterial& m) const;
    Bsdf::Model operator()(const NoMaterial&) const { return air(); }
    // Blends are made of whole Bsdfs, and nobody asks for the model of one.
    Bsdf::Model operator()(const MixtureMaterial&) const { return air(); }
    Bsdf::Model operator()(const TwoFacedMaterial&) const { return air(); }

private:
    /// A pane of it, which does nothing.
    static Bsdf::Model air() { return ThinDielectricBsdf{1, {}}; }
    Rgb colour(TextureId texture) const { return look_up(data_.textures, texture, place_); }
    Rgb albedo(TextureId texture) const { return limited(colour(texture)); }
    float times(float value, std::optional<TextureId> texture) const {
        return texture ? value * colour(*texture).r : value;
    }
    float share(float value, std::optional<TextureId> texture) const {
        return std::clamp(times(value, texture), 0.0f, 1.0f);
    }
    Ggx facets(const Roughness& roughness) const { return facets_of(roughness, times(1, roughness.texture)); }
    ConductorBsdf metal_of(const Metal& m, const Ggx& facets) const {
        if (m.reflectance) return {{1, 1, 1}, absorption_for(colour(*m.reflectance)), facets};
        return {colour(m.eta), colour(m.k), facets};
    }

    const SceneData& data_;
    const TexturePlace& place_;
    const Coat* coat_;
    const CoatedMetal* coated_metal_;
};

// A material that nobody thought of here must not compile: it would be seen as a pane of air.
struct ForgottenMaterial {};
static_assert(std::is_invocable_v<const Mixer&, const NoMaterial&> &&
              !std::is_invocable_v<const Mixer&, const ForgottenMaterial&>);

Bsdf::Model Mixer::operator()(const PrincipledMaterial& m) const {
    PrincipledBsdf model;
    model.base = albedo(m.base_colour);
    model.metallic = share(m.metallic, m.metallic_texture);
    model.transmission = share(m.transmission, m.transmission_texture);
    model.facets = facets(m.roughness);
    model.eta = m.eta;
    model.thin = m.thin || m.eta == 1;
    const float specular = share(m.specular, m.specular_texture);
    Rgb tint = m.specular_colour;
    if (m.specular_colour_texture) tint *= colour(*m.specular_colour_texture);
    model.f0 = limited(tint * fresnel_dielectric(1, m.eta)) * specular;
    model.f90 = specular;
    if (m.sheen > 0) {
        model.sheen = m.sheen_colour * m.sheen;
        if (m.sheen_texture) model.sheen *= colour(*m.sheen_texture);
        model.sheen = limited(model.sheen);
        const float rough = share(m.sheen_roughness, m.sheen_roughness_texture);
        model.sheen_alpha = std::max(least_sheen_alpha, rough * rough);
    }
    model.coat = share(m.clearcoat, m.clearcoat_texture);
    model.coat_alpha = facets(m.clearcoat_roughness).alpha_u;
    return model;
}

}  // namespace

Materials::Materials(const SceneData& data) : data_(data) {
    check_textures(data.textures);
    check_names(data);
    check_cycles(data);
    for (MaterialId id = 0; id < data.materials.size(); ++id) made_.push_back(made_of(id));
    for (MaterialId id = 0; id < data.materials.size(); ++id) {
        Made& made = made_[id];
        const auto names = names_of(data.materials[id]);
        const bool changes = std::any_of(names.textures.begin(), names.textures.end(),
                                         [&](TextureId t) { return !is_constant(data.textures[t]); });
        if (!changes && !is_blend(data.materials[id])) made.plain = model_at(id, {});
        made.simple = made.plain && !made.bumpy && !made.filled && !data.materials[id].one_sided;
    }
}

MaterialNeeds Materials::needs_of(MaterialId id) const {
    const Material& material = data_.materials[id];
    const Names names = names_of(material);
    MaterialNeeds needs;
    for (const TextureId texture : names.textures) needs.texture |= !is_constant(data_.textures[texture]);
    needs.tangent = anisotropic(material) || material.normal_map || material.bump_map;
    for (const MaterialId part : names.materials) needs = needs | needs_of(part);
    // parts of a blend may be windows, but holes are the whole's
    needs.holes = material.opacity || std::holds_alternative<NoMaterial>(material.model);
    return needs;
}

Materials::Made Materials::made_of(MaterialId id) {
    const Material& material = data_.materials[id];
    Made made;
    made.needs = needs_of(id);
    if (const auto* m = std::get_if<CoatedDiffuseMaterial>(&material.model))
        made.coat = &coats_.coat(m->eta, only_facets_of(m->roughness), {m->layer.thickness, m->layer.bounces});
    if (const auto* m = std::get_if<CoatedConductorMaterial>(&material.model)) {
        const auto above = only_facets_of(m->coat), below = only_facets_of(m->roughness);
        made.coat = &coats_.coat(m->coat_eta, above, {m->layer.thickness, m->layer.bounces});
        made.coated_metal = coats_.over_metal(*made.coat, above, below);
    }
    made.bumpy = material.normal_map || material.bump_map;
    if (material.bump_map) made.step = step_of(data_, *material.bump_map);
    made.filled = is_solid(material) && !is_black(material.absorption);
    return made;
}

Bsdf Materials::bsdf(MaterialId id, const SurfacePoint& point) const {
    const Made& made = made_[id];
    if (made.simple) return {point.shading, point.normal, *made.plain};
    const Material& material = data_.materials[id];
    if (is_blend(material)) return blend(id, point);
    const Frame shading = made.bumpy ? bumpy_frame(data_, material, point, made.step) : point.shading;
    Bsdf result(shading, point.normal, made.plain ? *made.plain : model_at(id, {point.uv, point.vertex_colour}));
    if (material.one_sided) result.make_one_sided();
    if (made.filled) result.fill_with(&material.absorption);
    return result;
}

Bsdf Materials::blend(MaterialId id, const SurfacePoint& point) const {
    using Face = Bsdf::Part::Face;
    std::vector<Bsdf::Part> parts;
    if (const auto* mixture = std::get_if<MixtureMaterial>(&data_.materials[id].model)) {
        const float amount =
            std::min(1.0f, look_up(data_.textures, mixture->amount, {point.uv, point.vertex_colour}).r);
        if (amount < 1) parts.push_back({bsdf(mixture->first, point), 1 - amount, Face::both});
        if (amount > 0) parts.push_back({bsdf(mixture->second, point), amount, Face::both});
        if (parts.size() == 1) return parts[0].bsdf;
    } else {
        const auto& faces = std::get<TwoFacedMaterial>(data_.materials[id].model);
        parts.push_back({bsdf(faces.front, point), 1, Face::front});
        parts.push_back({bsdf(faces.back, point), 1, Face::back});
    }
    return {point.normal, std::move(parts)};
}

Bsdf::Model Materials::model_at(MaterialId id, const TexturePlace& place) const {
    const Made& made = made_[id];
    return std::visit(Mixer(data_, place, made.coat, made.coated_metal), data_.materials[id].model);
}

bool Materials::is_plain(MaterialId id) const {
    const auto* diffuse = std::get_if<DiffuseMaterial>(&data_.materials[id].model);
    const Made& made = made_[id];
    return diffuse && !diffuse->transmittance && !(diffuse->sigma > 0) && !made.bumpy && !made.filled &&
           !made.needs.tangent;
}

const Rgb* Materials::plain_albedo(MaterialId id) const {
    const auto& model = made_[id].plain;
    return model ? &std::get<DiffuseBsdf>(*model).albedo : nullptr;
}

Rgb Materials::albedo(MaterialId id, const TexturePlace& place) const {
    return std::get<DiffuseBsdf>(model_at(id, place)).albedo;
}

float Materials::opacity(MaterialId id, const TexturePlace& place) const {
    const Material& material = data_.materials[id];
    if (std::holds_alternative<NoMaterial>(material.model)) return 0;
    if (!material.opacity) return 1;
    const float opacity = look_up(data_.textures, *material.opacity, place).r;
    if (material.opacity_cutoff > 0) return opacity >= material.opacity_cutoff ? 1 : 0;
    return std::min(opacity, 1.0f);
}

}  // namespace lightnet
