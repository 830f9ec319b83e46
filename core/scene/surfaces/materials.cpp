#include "core/scene/surfaces/materials.hpp"

#include <algorithm>
#include <utility>

#include "core/scene/bsdf/check_materials.hpp"
#include "core/scene/surfaces/bumps.hpp"

namespace lightnet {
namespace {

bool turned_grooves(const Material& material) {
    const auto* principled = std::get_if<PrincipledMaterial>(&material.model);
    return principled && principled->grooves.strength > 0;
}

/// Of a coat that does not follow the bumps there are. Null: there is none.
const PrincipledCoatNormal* own_coat(const Material& material) {
    const auto* principled = std::get_if<PrincipledMaterial>(&material.model);
    if (!principled || !(principled->clearcoat > 0) || !principled->coat_normal.own) return nullptr;
    const bool differs = principled->coat_normal.map || material.normal_map || material.bump_map;
    return differs ? &principled->coat_normal : nullptr;
}

bool anisotropic(const Material& material) {
    bool found = false;
    visit_each<Roughness>(material, [&](const Roughness& roughness) { found |= roughness.u != roughness.v; });
    const auto* burley = std::get_if<BurleyMaterial>(&material.model);
    found |= burley && burley->anisotropic;
    const auto* measured = std::get_if<MeasuredMaterial>(&material.model);
    found |= measured && measured->measured && !measured->measured->isotropic();
    return found || turned_grooves(material) || std::holds_alternative<HairMaterial>(material.model);
}

bool hair_by_v(const Material& material) {
    const auto* hair = std::get_if<HairMaterial>(&material.model);
    return hair && hair->across_by_v;
}

/// Where across a fibre a point of flat hair lies, by its texture coordinate v.
float across_flat_hair(const Frame& frame, const SurfacePoint& point) {
    const float across = 2 * std::clamp(point.uv.y, 0.0f, 1.0f) - 1;
    return dot(frame.y, point.along_v) < 0 ? -across : across;
}

template <class Model>
Bsdf::Model as_model(const Model& model) {
    return model;
}
template <class... Models>
Bsdf::Model as_model(const std::variant<Models...>& model) {
    return std::visit([](const auto& one) -> Bsdf::Model { return one; }, model);
}

// Those that are looked up by texture coordinates.
void add_pictures(const SceneData& data, TextureId id, std::vector<const ImageTexture*>& to) {
    const Texture& texture = data.textures[id];
    if (std::holds_alternative<ProjectedTexture>(texture.pattern) ||
        std::holds_alternative<OtherUvTexture>(texture.pattern))
        return;
    if (const auto* picture = std::get_if<ImageTexture>(&texture.pattern)) to.push_back(picture);
    for (const TextureId input : inputs_of(texture)) add_pictures(data, input, to);
}

}  // namespace

Materials::Materials(const SceneData& data) : data_(data) {
    check_textures(data.textures);
    check_materials(data.materials, data.textures.size());
    made_.resize(data.materials.size());
    for (std::uint32_t id = 0; id < data.materials.size(); ++id) make(id);
}

// A mixture has its parts made before itself.
void Materials::make(MaterialId id) {
    const Material& material = data_.materials[id];
    Made& made = made_[id];
    if (made.done) return;
    made.done = true;
    made.needs = needs_of(id);
    std::visit(
        [&]<class M>(const M& model) {
            if constexpr (Coated<M>) made.coating = model.coating(coats_);
            if constexpr (Scatters<M>)
                if (!made.needs.texture) made.constant = as_model(model.at({data_.textures, {}, made.coating}));
        },
        material.model);
    made.bumpy = material.normal_map || material.bump_map;
    if (material.bump_map) made.step = step_of(data_, *material.bump_map);
    const bool absorbs = !is_black(material.absorption) || !is_black(material.absorption_in_front);
    made.filled = transparency_of(material) == Transparency::solid && absorbs;
    made.handed = turned_grooves(material);
    made.coat = own_coat(material);
    made.hair_by_v = hair_by_v(material);
    made.simple = made.constant && !made.bumpy && !made.filled && !made.handed && !made.coat && !made.hair_by_v &&
                  !material.one_sided;
    made.lobes = lobes_everywhere(id);
}

std::uint8_t Materials::lobes_everywhere(MaterialId id) const {
    if (made_[id].constant) return Bsdf({}, {}, *made_[id].constant).lobes();
    const auto& model = data_.materials[id].model;
    if (std::holds_alternative<DiffuseMaterial>(model)) return DiffuseBsdf().lobes();
    const auto with = [](auto bsdf, const Roughness& roughness) -> std::uint8_t {
        const FacetRange range = facet_range_of(roughness);
        bsdf.facets = range.facets;
        return range.varies ? 0 : bsdf.lobes();
    };
    if (const auto* coated = std::get_if<CoatedDiffuseMaterial>(&model))
        return with(CoatedDiffuseBsdf(), coated->roughness);
    if (const auto* metal = std::get_if<ConductorMaterial>(&model)) return with(ConductorBsdf(), metal->roughness);
    return 0;
}

MaterialNeeds Materials::needs_of(MaterialId id) {
    const Material& material = data_.materials[id];
    MaterialNeeds needs;
    visit_each<TextureId>(material, [&](TextureId texture) {
        needs.texture |= !is_constant(data_.textures[texture]);
        add_pictures(data_, texture, made_[id].pictures);
    });
    needs.grooves = anisotropic(material);
    needs.tangent = needs.grooves || material.normal_map || material.bump_map || own_coat(material);
    visit_each<MaterialId>(material, [&](MaterialId part) {
        make(part);
        needs = needs | made_[part].needs;
        made_[id].pictures.insert(made_[id].pictures.end(), made_[part].pictures.begin(), made_[part].pictures.end());
    });
    // parts of a blend may be windows, but holes are the whole's
    needs.holes = material.opacity || std::holds_alternative<NoMaterial>(material.model);
    return needs;
}

Bsdf Materials::bsdf(MaterialId id, const SurfacePoint& point) const {
    const Made& made = made_[id];
    if (made.simple) return {point.shading, point.normal, *made.constant};
    const Material& material = data_.materials[id];
    const auto whole = [&](const Bsdf::Model& model) {
        const Frame frame = frame_at(id, point);
        const bool fits = !made.coat && !made.hair_by_v;
        Bsdf result(frame, point.normal, fits ? model : fitted(id, model, frame, point));
        if (material.one_sided) result.make_one_sided();
        const auto unless_black = [](const Rgb& c) { return is_black(c) ? nullptr : &c; };
        if (made.filled)
            result.fill_with(unless_black(material.absorption), unless_black(material.absorption_in_front));
        return result;
    };
    if (made.constant) return whole(*made.constant);
    const MaterialInputs inputs(data_.textures, place_of(point), made.coating);
    return std::visit(
        [&]<class M>(const M& model) {
            if constexpr (Blends<M>)
                return blend(model.parts_at(inputs), point);
            else
                return whole(as_model(model.at(inputs)));
        },
        material.model);
}

Vec3 Materials::bumpy_normal(MaterialId id, const SurfacePoint& point) const {
    return lightnet::bumpy_normal(data_, data_.materials[id], point, made_[id].step);
}

Frame Materials::frame_at(MaterialId id, const SurfacePoint& point) const {
    const Made& made = made_[id];
    Frame frame = made.bumpy ? bumpy_frame(id, point) : point.shading;
    if (made.handed && dot(frame.y, point.along_v) < 0) frame.y = -frame.y;
    return frame;
}

Bsdf::Model Materials::fitted(MaterialId id, const Bsdf::Model& model, const Frame& frame,
                              const SurfacePoint& point) const {
    Bsdf::Model result = model;
    if (auto* hair = std::get_if<HairBsdf>(&result)) {
        if (!std::holds_alternative<Curves>(data_.shapes[point.geometry].geometry))
            hair->across = across_flat_hair(frame, point);
        return result;
    }
    const Vec3 up = frame.to_local(coat_normal(data_, *made_[id].coat, point));
    if (auto* principled = std::get_if<PrincipledBsdf>(&result); principled && up.z > 0)
        principled->coat_up = normalize(up);
    return result;
}

Frame Materials::bumpy_frame(MaterialId id, const SurfacePoint& point) const {
    const Vec3 normal = bumpy_normal(id, point);
    return made_[id].needs.grooves ? frame_along(normal, point.along_u) : Frame::around(normal);
}

Bsdf Materials::blend(std::span<const BlendPart> of, const SurfacePoint& point) const {
    std::vector<Bsdf::Part> parts;
    for (const BlendPart& part : of)
        if (part.share > 0) parts.push_back({bsdf(part.material, point), part.share, part.from});
    if (parts.size() == 1 && parts[0].from == SeenFrom::both) return parts[0].bsdf;
    return {point.normal, std::move(parts)};
}

// DECISIONS: plain-surfaces-in-columns
ColumnShape::Kind Materials::column_kind(MaterialId id) const {
    using Kind = ColumnShape::Kind;
    const Made& made = made_[id];
    if (made.filled || made.needs.grooves || made.coat) return Kind::none;
    if (made.lobes && !(made.lobes & lobe::rough)) return Kind::none;  // a mirror, say
    const auto& model = data_.materials[id].model;
    const auto by_law = [](const Roughness& roughness, Kind ggx, Kind beckmann) {
        return roughness.law.normals == FacetLaw::Normals::ggx ? ggx : beckmann;
    };
    if (const auto* diffuse = std::get_if<DiffuseMaterial>(&model))
        return diffuse->lambertian() ? Kind::lambertian : Kind::none;
    if (const auto* coated = std::get_if<CoatedDiffuseMaterial>(&model))
        return by_law(coated->roughness, Kind::coated, Kind::coated_beckmann);
    if (const auto* metal = std::get_if<ConductorMaterial>(&model))
        return made.lobes ? by_law(metal->roughness, Kind::metal, Kind::metal_beckmann) : Kind::none;
    if (const auto* principled = std::get_if<PrincipledMaterial>(&model))
        return principled->plain() ? by_law(principled->roughness, Kind::principled, Kind::none) : Kind::none;
    return Kind::none;
}

Rgb Materials::albedo(MaterialId id, const TexturePlace& place) const {
    const auto& diffuse = std::get<DiffuseMaterial>(data_.materials[id].model);
    return MaterialInputs(data_.textures, place).albedo(diffuse.reflectance);
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
