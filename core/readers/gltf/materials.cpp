#include "core/readers/gltf/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"

namespace lightnet::gltf {
namespace {

constexpr std::size_t no_material = ~std::size_t{0};
using Channel = ImageTexture::Channel;

Rgb rgb(const std::array<double, 3>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

Rgb rgb(const At& at, Rgb fallback) {
    return rgb(at.numbers<3>({double(fallback.r), double(fallback.g), double(fallback.b)}));
}

float share(const At& at, float fallback) { return std::clamp(at.real(fallback), 0.0f, 1.0f); }

Wrap wrap_of(const At& at) {
    const auto code = at.whole(10497);
    return code == 33071 ? Wrap::clamp : code == 33648 ? Wrap::mirror : Wrap::repeat;
}

/// KHR_texture_transform, whose v goes down, for our v, which goes up.
UvTransform transform_of(const At& at) {
    const auto offset = at["offset"].numbers<2>({0, 0}), scale = at["scale"].numbers<2>({1, 1});
    const double turn = at["rotation"].number(0), c = std::cos(turn), s = std::sin(turn);
    UvTransform result;
    result.scale = {float(scale[0]), float(scale[1])};
    result.turn = float(turn);
    result.offset = {float(offset[0] + scale[1] * s), float(1 - scale[1] * c - offset[1])};
    return result;
}

/// Which texture coordinates an image lies on.
std::size_t set_of(const At& info) {
    const At moved = info["extensions"]["KHR_texture_transform"]["texCoord"], own = info["texCoord"];
    return (moved ? moved : own).whole(0);
}

Rgb inverse_of_attenuation(Rgb colour, float distance) {
    const auto one = [&](float c) { return -std::log(std::clamp(c, 1e-6f, 1.0f)) / distance; };
    return {one(colour.r), one(colour.g), one(colour.b)};
}

}  // namespace

Materials::Materials(Document& document, Assets& assets, const std::string& variant)
    : document_(document), assets_(assets) {
    const At list = document.root()["extensions"]["KHR_materials_variants"]["variants"];
    std::vector<std::string> names;
    for (std::size_t i = 0; i < list.size(); ++i) names.push_back(list[i]["name"].text(""));
    for (const auto& name : names) assets.scene().variants.push_back({name, name == variant});
    if (variant.empty()) return;
    const auto found = std::ranges::find(names, variant);
    if (found != names.end())
        variant_ = static_cast<std::size_t>(found - names.begin());
    else if (names.empty())
        assets.report().error({document.path(), 0}, fmt::format("has no variants: there is no '{}'", variant));
    else
        assets.report().error({document.path(), 0}, fmt::format("has no variant '{}', but {}{}", variant, joined(names),
                                                                did_you_mean(variant, names)));
}

/// Of the material of a primitive in the chosen variant.
At Materials::index_of(const At& primitive) const {
    const At mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
    for (std::size_t i = 0; i < mappings.size(); ++i) {
        const At variants = mappings[i]["variants"], material = mappings[i]["material"];
        for (std::size_t j = 0; j < variants.size(); ++j)
            if (variant_ && variants[j].whole() == *variant_) return material;
    }
    return primitive["material"];
}

const Surface& Materials::of(const At& primitive, Painted painted) {
    const At index = index_of(primitive);
    const At list = document_.root()["materials"];
    const auto which = index.index(list.size());
    const std::pair key{which.value_or(no_material), painted};
    if (const auto known = made_.find(key); known != made_.end()) return known->second;
    const At at = list[which.value_or(no_material)];
    lay(at);
    Surface surface = make(at, painted);
    surface.turned = turned_;
    surface.uv_sets = uv_sets_;
    return made_.emplace(key, surface).first->second;
}

std::shared_ptr<const Image> Materials::image(const At& index, Kind kind) {
    const At list = document_.root()["images"];
    const auto which = index.index(list.size());
    if (!which) return nullptr;
    const At at = list[*which];
    const Encoding encoding = kind == Kind::colour ? Encoding{} : Encoding{Encoding::Curve::linear, 1};
    const std::string name = fmt::format("{} images[{}]", document_.path(), *which);
    const SourceLine where{document_.path(), 0};
    if (at["bufferView"]) {
        const auto bytes = document_.view(at["bufferView"]);
        return bytes ? assets_.picture(name, *bytes, encoding, where) : nullptr;
    }
    const auto [bytes, problem] = document_.try_resource(at["uri"]);
    return bytes ? assets_.picture(name, *bytes, encoding, where) : assets_.no_picture(name, "it " + problem, where);
}

std::optional<ImageTexture> Materials::picture(const At& info, Kind kind) {
    if (!info) return std::nullopt;
    const At list = document_.root()["textures"];
    const auto index = info["index"].index(list.size());
    if (!index) return std::nullopt;
    const At at = list[*index];
    // images of WebP are read as well as what stands in for them; those of Basis Universal are not
    const At webp = at["extensions"]["EXT_texture_webp"]["source"], plain = at["source"],
             basis = at["extensions"]["KHR_texture_basisu"]["source"];
    const At& source = webp ? webp : plain ? plain : basis;
    if (!source) {
        at.warn("a texture without an image of a known format is left out: its factor alone counts");
        return std::nullopt;
    }
    ImageTexture pattern;
    pattern.image = image(source, kind);
    if (!pattern.image) return std::nullopt;
    const At samplers = document_.root()["samplers"];
    if (const auto sampler = at["sampler"].index(samplers.size())) {
        pattern.wrap_u = wrap_of(samplers[*sampler]["wrapS"]), pattern.wrap_v = wrap_of(samplers[*sampler]["wrapT"]);
        pattern.nearest = samplers[*sampler]["magFilter"].whole(9729) == 9728;
    }
    if (const At moved = info["extensions"]["KHR_texture_transform"]) pattern.uv = transform_of(moved);
    return pattern;
}

/// The main texture coordinates are those of what is turned along them.
void Materials::lay(const At& material) {
    uv_sets_.clear();
    const At more = material["extensions"];
    for (const At& map : {material["normalTexture"], more["KHR_materials_clearcoat"]["clearcoatNormalTexture"],
                          more["KHR_materials_anisotropy"]["anisotropyTexture"]})
        if (map && uv_sets_.empty()) uv_sets_.push_back(set_of(map));
    turned_ = !uv_sets_.empty() || more["KHR_materials_anisotropy"]["anisotropyStrength"];
}

/// Among those of the material: 0 are the main ones.
std::size_t Materials::place_of_set(const At& info) {
    const std::size_t set = set_of(info);
    const auto found = std::ranges::find(uv_sets_, set);
    const auto place = static_cast<std::size_t>(found - uv_sets_.begin());
    if (found == uv_sets_.end()) uv_sets_.push_back(set);
    return place;
}

std::optional<TextureId> Materials::texture(const At& info, Kind kind, Rgb scale, Channel channel) {
    auto pattern = picture(info, kind);
    if (!pattern) return std::nullopt;
    pattern->channel = channel;
    const TextureId map = assets_.add({scale, *pattern, false});
    const std::size_t place = place_of_set(info);
    return place ? assets_.add({{1, 1, 1}, OtherUvTexture{map, std::uint32_t(place - 1)}, false}) : map;
}

std::optional<NormalMap> Materials::normal_map(const At& info) {
    const float scale = info["scale"].real(1);
    const auto map = texture(info, Kind::numbers, {1, 1, 1});
    return map ? std::optional(NormalMap{*map, scale}) : std::nullopt;
}

/// The colour of a surface: factor × image × the colours of the mesh.
TextureId Materials::base(const At& info, Rgb factor, bool painted) {
    const auto map = texture(info, Kind::colour, factor);
    if (!painted) return map ? *map : assets_.colour(factor);
    const TextureId paint = assets_.add({map ? Rgb{1, 1, 1} : factor, VertexColour{}, false});
    return map ? assets_.add({{1, 1, 1}, ProductTexture{*map, paint}, false}) : paint;
}

PrincipledMaterial Materials::model(const At& at, bool painted) {
    const At rough = at["pbrMetallicRoughness"];
    const auto factor = rough["baseColorFactor"].numbers<4>({1, 1, 1, 1});
    if (std::ranges::any_of(factor, [](double value) { return value > 1; }))
        rough["baseColorFactor"].warn(
            "a baseColorFactor is above 1: no surface reflects more light than it gets, and 1 is taken");
    PrincipledMaterial model;
    model.base_colour = base(rough["baseColorTexture"], rgb({factor[0], factor[1], factor[2]}), painted);
    model.metallic = share(rough["metallicFactor"], 1);
    const float roughness = share(rough["roughnessFactor"], 1);
    model.roughness = {roughness, roughness, {}, Roughness::Means::square};
    const At map = rough["metallicRoughnessTexture"];
    model.metallic_texture = texture(map, Kind::numbers, {1, 1, 1}, Channel::blue);
    model.roughness.texture = texture(map, Kind::numbers, {1, 1, 1}, Channel::green);
    return model;
}

/// KHR_materials_pbrSpecularGlossiness, which metallic-roughness has replaced.
void Materials::older(const At& at, PrincipledMaterial& model, bool painted) {
    at.warn("KHR_materials_pbrSpecularGlossiness is approximated by a dielectric with that colour of reflection");
    const auto diffuse = at["diffuseFactor"].numbers<4>({1, 1, 1, 1});
    model.base_colour = base(at["diffuseTexture"], rgb({diffuse[0], diffuse[1], diffuse[2]}), painted);
    model.metallic = 0;
    model.metallic_texture.reset(), model.roughness.texture.reset();
    const float gloss = share(at["glossinessFactor"], 1);
    model.roughness.u = model.roughness.v = 1 - gloss;
    model.specular_colour = rgb(at["specularFactor"], {1, 1, 1}) / 0.04f;  // over what an index of 1.5 reflects
    const At map = at["specularGlossinessTexture"];
    model.specular_colour_texture = texture(map, Kind::colour, {1, 1, 1});
    if (const auto glossy = texture(map, Kind::colour, {gloss, gloss, gloss}, Channel::alpha)) {
        Texture rough = assets_.scene().textures[*glossy];
        rough.invert = true;
        model.roughness.texture = assets_.add(rough), model.roughness.u = model.roughness.v = 1;
    }
}

void Materials::coat(const At& clear, PrincipledMaterial& model) {
    model.clearcoat = share(clear["clearcoatFactor"], 0);
    model.clearcoat_texture = texture(clear["clearcoatTexture"], Kind::numbers, {1, 1, 1}, Channel::red);
    const float rough = share(clear["clearcoatRoughnessFactor"], 0);
    model.clearcoat_roughness = {rough, rough, {}, Roughness::Means::square};
    model.clearcoat_roughness.texture =
        texture(clear["clearcoatRoughnessTexture"], Kind::numbers, {1, 1, 1}, Channel::green);
    const At bumps = clear["clearcoatNormalTexture"];
    model.coat_normal = {true, normal_map(bumps)};
}

/// What becomes of light at the surface.
void Materials::shine(const At& at, PrincipledMaterial& model) {
    const At sheen = at["KHR_materials_sheen"], specular = at["KHR_materials_specular"];
    const At grooves = at["KHR_materials_anisotropy"], film = at["KHR_materials_iridescence"];
    if (sheen) {
        model.sheen_colour = rgb(sheen["sheenColorFactor"], {0, 0, 0});
        model.sheen = is_black(model.sheen_colour) ? 0 : 1;
        model.sheen_roughness = share(sheen["sheenRoughnessFactor"], 0);
        model.sheen_texture = texture(sheen["sheenColorTexture"], Kind::colour, {1, 1, 1});
        model.sheen_roughness_texture =
            texture(sheen["sheenRoughnessTexture"], Kind::numbers, {1, 1, 1}, Channel::alpha);
    }
    model.specular = share(specular["specularFactor"], 1);
    model.specular_texture = texture(specular["specularTexture"], Kind::numbers, {1, 1, 1}, Channel::alpha);
    model.specular_colour = rgb(specular["specularColorFactor"], {1, 1, 1});
    model.specular_colour_texture = texture(specular["specularColorTexture"], Kind::colour, {1, 1, 1});
    const float turn = grooves["anisotropyRotation"].real(0);
    model.grooves = {share(grooves["anisotropyStrength"], 0),
                     {std::cos(turn), std::sin(turn)},
                     texture(grooves["anisotropyTexture"], Kind::numbers, {1, 1, 1})};
    const At thickness = film["iridescenceThicknessTexture"];
    model.film = {share(film["iridescenceFactor"], 0),
                  std::clamp(film["iridescenceIor"].real(1.3f), 1.0f, 10.0f),
                  std::clamp(film["iridescenceThicknessMinimum"].real(100), 0.0f, 1e5f),
                  std::clamp(film["iridescenceThicknessMaximum"].real(400), 0.0f, 1e5f),
                  texture(film["iridescenceTexture"], Kind::numbers, {1, 1, 1}, Channel::red),
                  texture(thickness, Kind::numbers, {1, 1, 1}, Channel::green)};
}

/// What becomes of light that goes through.
void Materials::pass_on(const At& at, PrincipledMaterial& model, Material& material) {
    const At through = at["KHR_materials_transmission"], volume = at["KHR_materials_volume"];
    const At leaf = at["KHR_materials_diffuse_transmission"];
    model.eta = at["KHR_materials_ior"]["ior"].real(1.5f);
    if (model.eta < 1) model.eta = model.eta == 0 ? 1e3f : 1;  // 0: reflects all
    model.transmission = share(through["transmissionFactor"], 0);
    model.transmission_texture = texture(through["transmissionTexture"], Kind::numbers, {1, 1, 1}, Channel::red);
    model.thin = volume["thicknessFactor"].number(0) == 0;
    const float distance = volume["attenuationDistance"].real(0);
    if (!model.thin && distance > 0)
        material.absorption = inverse_of_attenuation(rgb(volume["attenuationColor"], {1, 1, 1}), distance);
    // half of the difference that Abbe's number, 20 over this, tells for the ends of the spectrum
    const float dispersion = at["KHR_materials_dispersion"]["dispersion"].real(0);
    model.dispersion = std::clamp((model.eta - 1) * 0.025f * std::max(dispersion, 0.0f), 0.0f, model.eta - 1);
    if (model.dispersion > 0 && model.transmission > 0 && !model.thin)
        at.warn(
            "KHR_materials_dispersion is approximated by three indices, for red, green and blue: rainbows have "
            "three colours");
    model.translucence = {share(leaf["diffuseTransmissionFactor"], 0),
                          rgb(leaf["diffuseTransmissionColorFactor"], {1, 1, 1}),
                          texture(leaf["diffuseTransmissionTexture"], Kind::numbers, {1, 1, 1}, Channel::alpha),
                          texture(leaf["diffuseTransmissionColorTexture"], Kind::colour, {1, 1, 1})};
}

void Materials::extensions(const At& at, PrincipledMaterial& model, Material& material) {
    pass_on(at, model, material);
    coat(at["KHR_materials_clearcoat"], model);
    shine(at, model);
}

void Materials::opacity(const At& at, const At& base, float factor, bool by_vertices, Material& material) {
    const std::string mode = at["alphaMode"].text("OPAQUE");
    if (mode == "OPAQUE") return;
    if (mode != "MASK" && mode != "BLEND") return at["alphaMode"].error("must be OPAQUE, MASK or BLEND");
    const auto map = texture(base, Kind::colour, {factor, factor, factor}, Channel::alpha);
    material.opacity = map ? *map : assets_.grey(factor);
    if (by_vertices) {
        const TextureId own = assets_.add({{1, 1, 1}, VertexAlpha{}, false});
        material.opacity = assets_.add({{1, 1, 1}, ProductTexture{*material.opacity, own}, false});
    }
    if (mode == "MASK") material.opacity_cutoff = std::max(at["alphaCutoff"].real(0.5f), 1e-6f);
}

void Materials::emission(const At& at, Surface& surface) {
    const bool two_sided = at["doubleSided"].boolean(false);
    const float strength = at["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].real(1);
    const Rgb radiance = rgb(at["emissiveFactor"], {0, 0, 0}) * std::max(strength, 0.0f);
    if (is_black(radiance)) return;
    surface.emission = AreaEmission{radiance, two_sided, texture(at["emissiveTexture"], Kind::colour, {1, 1, 1})};
}

Surface Materials::make(const At& at, Painted painted) {
    Surface surface;
    Material material;
    material.name = at["name"].text("");
    if (at["occlusionTexture"]) at.warn("occlusion maps are left out: light finds by itself where it is dark");
    const At more = at["extensions"];
    PrincipledMaterial model = this->model(at, painted.colours);
    const At gloss = more["KHR_materials_pbrSpecularGlossiness"];
    const At rough = at["pbrMetallicRoughness"];
    extensions(more, model, material);
    if (gloss) older(gloss, model, painted.colours);
    opacity(at, gloss ? gloss["diffuseTexture"] : rough["baseColorTexture"],
            float((gloss ? gloss["diffuseFactor"] : rough["baseColorFactor"]).numbers<4>({1, 1, 1, 1})[3]),
            painted.alphas, material);
    surface.fades = painted.alphas && material.opacity;
    emission(at, surface);
    if (more["KHR_materials_unlit"]) {
        at.warn("KHR_materials_unlit is approximated by a surface that shines in its colour");
        (void)at["normalTexture"]["index"], (void)at["normalTexture"]["scale"];  // it has no shades
        surface.emission = AreaEmission{{1, 1, 1}, true, model.base_colour};
        material.model = DiffuseMaterial{assets_.grey(0)};
    } else {
        material.model = model;
        material.normal_map = normal_map(at["normalTexture"]);
    }
    surface.material = assets_.add(std::move(material));
    return surface;
}

}  // namespace lightnet::gltf
