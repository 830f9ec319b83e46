#include "core/readers/obj/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/readers/common/spectra.hpp"
#include "core/readers/images/image_facts.hpp"
#include "core/readers/obj/elsewhere.hpp"
#include "core/readers/obj/lines.hpp"
#include "core/readers/obj/maps.hpp"
#include "core/readers/obj/spectral.hpp"

namespace lightnet::obj {
namespace {

/// All that the statements say of one material.
struct Statements {
    std::string name;
    SourceLine where;
    std::map<std::string, Rgb, std::less<>> colours;
    std::map<std::string, float, std::less<>> numbers;
    std::map<std::string, Map, std::less<>> maps;

    Rgb colour(std::string_view key, Rgb fallback) const {
        const auto found = colours.find(key);
        return found == colours.end() ? fallback : found->second;
    }
    float number(std::string_view key, float fallback) const {
        const auto found = numbers.find(key);
        return found == numbers.end() ? fallback : found->second;
    }
    bool has(std::string_view key) const { return numbers.contains(key) || maps.contains(key); }
};

class MaterialReader {
public:
    MaterialReader(const std::string& path, std::span<const std::byte> bytes, Assets& assets)
        : lines_(bytes, path), assets_(assets), report_(assets.report()) {}

    std::vector<Statements> read() {
        while (!report_.full() && lines_.next()) {
            const std::string word(lines_.word());
            if (word == "newmtl")
                begin(std::string(lines_.rest()));
            else if (materials_.empty())
                report_.error(lines_.where(), fmt::format("'{}' stands before the first 'newmtl'", word.substr(0, 32)));
            else
                statement(word, materials_.back());
        }
        return std::move(materials_);
    }

private:
    void begin(std::string name) {
        if (!names_.insert(name).second)
            report_.warn(lines_.where(),
                         fmt::format("the material '{}' is there twice: the first one is taken", name.substr(0, 64)));
        materials_.push_back({std::move(name), lines_.where(), {}, {}, {}});
    }

    void statement(const std::string& word, Statements& material) {
        static const std::set<std::string, std::less<>> colours{"Ka", "Kd", "Ks", "Ke", "Tf"};
        static const std::set<std::string, std::less<>> numbers{"Ns", "Ni", "d",   "Tr",    "illum",  "Pr",       "Pm",
                                                                "Ps", "Pc", "Pcr", "aniso", "anisor", "sharpness"};
        static const std::map<std::string, std::string, std::less<>> maps{
            {"map_Kd", "Kd"},     {"map_Ks", "Ks"}, {"map_Ke", "Ke"},  {"map_d", "d"},
            {"map_Pr", "Pr"},     {"map_Pm", "Pm"}, {"norm", "norm"},  {"map_bump", "bump"},
            {"map_Bump", "bump"}, {"bump", "bump"}, {"map_Kn", "norm"}};
        static const std::set<std::string, std::less<>> ignored{"map_Ka", "map_Ns", "disp",   "refl",   "map_refl",
                                                                "decal",  "map_Ps", "map_Pc", "map_Pcr"};
        if (colours.contains(word)) {
            if (const auto value = colour(word)) material.colours[word] = *value;
        } else if (numbers.contains(word)) {
            if (const auto value = number(word)) material.numbers[word] = *value;
        } else if (const auto known = maps.find(word); known != maps.end()) {
            if (auto read = read_map(word, lines_, report_)) material.maps[known->second] = *read;
        } else {
            report_.warn(lines_.where(),
                         fmt::format("{} '{}' is left out: the picture shows nothing of it",
                                     ignored.contains(word) ? "statement" : "unknown statement", word.substr(0, 32)));
        }
    }

    std::optional<float> number(const std::string& word) {
        if (word == "d") {
            auto ahead = lines_;  // "d -halo 0.5"
            if (ahead.word() == "-halo") lines_ = ahead;
        }
        const auto value = lines_.number(report_);
        if (!value) report_.error(lines_.where(), fmt::format("'{}' needs a number", word));
        return value;
    }

    std::optional<Rgb> colour(const std::string& word) {
        auto ahead = lines_;
        const auto first = ahead.word();
        if (first == "spectral") {
            if (word == "Ka") return std::nullopt;  // of no effect
            lines_ = ahead;
            return spectral_colour(lines_, word == "Ke", assets_);
        }
        const bool is_xyz = first == "xyz";
        if (is_xyz) lines_ = ahead;
        const auto r = lines_.number(report_), g = r ? lines_.number(report_) : r, b = g ? lines_.number(report_) : g;
        if (!r || (g && !b)) {
            report_.error(lines_.where(), "a colour needs three numbers");
            return std::nullopt;
        }
        if (is_xyz) return from_xyz(*r, g.value_or(*r), b.value_or(*r));
        return Rgb{*r, g.value_or(*r), b.value_or(*r)};
    }

    Rgb from_xyz(float x, float y, float z) {
        const auto rgb = rgb_of_xyz(double{x}, double{y}, double{z});
        const auto channel = [&](std::size_t c) { return float(std::max(0.0, rgb[c])); };
        if (std::ranges::min(rgb) < -1e-3)
            report_.warn(lines_.where(), "a colour by 'xyz' is outside of what sRGB can show: its nearest is taken");
        return {channel(0), channel(1), channel(2)};
    }

    Lines lines_;
    Assets& assets_;
    Report& report_;
    std::vector<Statements> materials_;
    std::set<std::string> names_;  // of these
};

/// Makes materials of statements.
class Maker {
public:
    Maker(Assets& assets, const std::string& path) : assets_(assets), path_(path) {}

    Surface make(const Statements& said) {
        Material material = model(said);
        material.name = said.name;
        name_unused(said, material);
        opacity(said, material);
        if (auto map = picture(said, "norm", {Encoding::Curve::linear, 1})) {
            map->scale = {1, 1, 1};
            material.normal_map = NormalMap{assets_.add(*map)};
        }
        if (auto map = number(said, "bump", false)) {
            map->scale *= said.maps.find("bump")->second.bump;
            material.bump_map = assets_.add(*map);
        }
        return {assets_.add(std::move(material)), emission(said)};
    }

private:
    /// What has no effect on a material of that kind, and would have one elsewhere.
    void name_unused(const Statements& said, const Material& material) {
        const auto name = [&](std::string_view word, std::string_view why) {
            assets_.report().warn(said.where, fmt::format("'{}' is left out: {}", word, why));
        };
        const bool glass = std::holds_alternative<DielectricMaterial>(material.model);
        const auto* principled = std::get_if<PrincipledMaterial>(&material.model);
        if (!glass && said.colour("Tf", {1, 1, 1}) != Rgb{1, 1, 1}) name("Tf", "the surface lets no light through");
        if (said.number("anisor", 0) != 0) name("anisor", "grooves lie along the texture coordinates");
        if ((glass || std::holds_alternative<ConductorMaterial>(material.model)) && said.maps.contains("Kd"))
            name("map_Kd", "glass and mirrors are even here");
        if (said.maps.contains("Ks") && !(principled && principled->specular_texture))
            name("map_Ks", "the surface reflects without it");
    }

    /// None: there is none that can be read, which is warned of.
    std::optional<Texture> picture(const Statements& said, std::string_view key, const Encoding& encoding = {}) {
        const auto map = said.maps.find(key);
        if (map == said.maps.end()) return std::nullopt;
        const auto& [file, where, scale, offset, clamp, bump, gain, channel] = map->second;
        ImageTexture pattern;
        const bool coloured = said.colours.contains(key) && !is_black(said.colour(key, {}));
        const std::string instead = coloured      ? fmt::format("{} alone is taken", key)
                                    : key == "Kd" ? "mid-grey is taken"
                                                  : "it is left out";
        pattern.image = find_picture(path_, file, encoding, where, instead, assets_);
        if (!pattern.image) return std::nullopt;
        pattern.wrap_u = pattern.wrap_v = clamp ? Wrap::clamp : Wrap::repeat;
        pattern.uv = {scale, offset, 0};
        return Texture{Rgb{1, 1, 1} * gain, pattern, false};
    }

    /// A picture of numbers: the channel that is named, else its luminance; what `alpha` it has first, where it is
    /// asked.
    std::optional<Texture> number(const Statements& said, std::string_view key, bool alpha) {
        auto texture = picture(said, key, {Encoding::Curve::linear, 1});
        if (!texture) return texture;
        auto& pattern = std::get<ImageTexture>(texture->pattern);
        pattern.channel = said.maps.find(key)->second.channel;
        if (pattern.channel != ImageTexture::Channel::colour) return texture;
        if (alpha && is_translucent(*pattern.image))
            pattern.channel = ImageTexture::Channel::alpha;
        else
            pattern.channel =
                is_coloured(*pattern.image) ? ImageTexture::Channel::luminance : ImageTexture::Channel::red;
        return texture;
    }

    TextureId coloured(const Statements& said, std::string_view key, Rgb fallback) {
        auto texture = picture(said, key);
        // exporters write 0 beside a map; the map is meant
        const Rgb factor = said.colour(key, {1, 1, 1});
        if (!texture && said.maps.contains(key) && (is_black(factor) || !said.colours.contains(key)))
            return assets_.grey(0.5f);
        if (!texture) {
            const Rgb colour = said.colour(key, fallback);
            if (max_component(colour) > 1)
                assets_.report().warn(said.where, fmt::format("'{}' is above 1: no surface reflects more light than it "
                                                              "gets, and 1 is taken",
                                                              key));
            return assets_.colour(colour);
        }
        if (!is_black(factor)) texture->scale *= factor;
        return assets_.add(*texture);
    }

    std::optional<TextureId> factor(const Statements& said, std::string_view key) {
        const auto texture = number(said, key, false);
        return texture ? std::optional(assets_.add(*texture)) : std::nullopt;
    }

    /// α of GGX whose lobe is as wide as Blinn and Phong's with that exponent.
    static Roughness from_exponent(float exponent) {
        const float alpha = std::sqrt(2 / (std::max(exponent, 0.0f) + 2));
        return {alpha < 0.02f ? 0 : alpha, alpha < 0.02f ? 0 : alpha, {}, Roughness::Means::alpha};
    }

    /// There are the models 0 to 10; others count as the usual one.
    static int illumination(const Statements& said) {
        const float value = said.number("illum", 2);
        return value >= 0 && value <= 10 ? static_cast<int>(value) : 2;
    }

    Material model(const Statements& said) {
        const int illum = illumination(said);
        const Rgb specular = said.colour("Ks", {});
        const float eta = std::clamp(said.number("Ni", 1.5f), 1.0f, 4.0f);
        if (said.has("Pr") || said.has("Pm") || said.has("Pc") || said.has("Ps")) return principled(said, eta);
        if (illum == 4 || illum == 6 || illum == 7 || illum == 9) {
            DielectricMaterial glass;
            glass.eta = said.numbers.contains("Ni") ? eta : 1.5f;
            if (said.colours.contains("Tf")) glass.transmitted = assets_.colour(said.colour("Tf", {1, 1, 1}));
            return {said.name, glass};
        }
        if ((illum == 3 || illum == 5 || illum == 8) && is_black(said.colour("Kd", {})) && !is_black(specular)) {
            ConductorMaterial mirror;
            mirror.metal.reflectance = assets_.colour(specular);
            if (said.has("Ns")) mirror.roughness = from_exponent(said.number("Ns", 1e6f));
            return {said.name, mirror};
        }
        const auto gloss = illum < 2 ? std::nullopt : picture(said, "Ks");
        if ((is_black(specular) && !gloss) || illum < 2)
            return {said.name, DiffuseMaterial{coloured(said, "Kd", {0.8f, 0.8f, 0.8f})}};
        PrincipledMaterial shiny;
        shiny.base_colour = coloured(said, "Kd", {0.8f, 0.8f, 0.8f});
        shiny.specular = is_black(specular) ? 1 : std::clamp(luminance(specular), 0.0f, 1.0f);
        const float bright = luminance(specular);
        const bool grey = specular.r == specular.g && specular.g == specular.b;
        if (bright > 0 && !grey) shiny.specular_colour = specular / bright;
        if (gloss) shiny.specular_texture = assets_.add(*gloss);
        shiny.eta = eta > 1 ? eta : 1.5f;
        shiny.roughness = from_exponent(said.number("Ns", 10));
        return {said.name, shiny};
    }

    Material principled(const Statements& said, float eta) {
        PrincipledMaterial model;
        model.base_colour = coloured(said, "Kd", {0.8f, 0.8f, 0.8f});
        model.metallic_texture = factor(said, "Pm");
        model.metallic = said.number("Pm", model.metallic_texture ? 1.0f : 0.0f);
        model.roughness.texture = factor(said, "Pr");
        const float rough = said.number("Pr", model.roughness.texture ? 1.0f : 0.5f);
        const float aspect = std::sqrt(1 - 0.9f * std::clamp(said.number("aniso", 0), 0.0f, 1.0f));
        model.roughness.u = std::clamp(rough / std::sqrt(aspect), 0.0f, 1.0f);
        model.roughness.v = std::clamp(rough * std::sqrt(aspect), 0.0f, 1.0f);
        model.sheen = std::clamp(said.number("Ps", 0), 0.0f, 1.0f);
        model.clearcoat = std::clamp(said.number("Pc", 0), 0.0f, 1.0f);
        model.clearcoat_roughness.u = model.clearcoat_roughness.v = std::clamp(said.number("Pcr", 0), 0.0f, 1.0f);
        model.eta = eta > 1 ? eta : 1.5f;
        const int illum = illumination(said);
        if (illum == 4 || illum == 6 || illum == 7 || illum == 9) model.transmission = 1, model.thin = false;
        return {said.name, model};
    }

    void opacity(const Statements& said, Material& material) {
        const bool glass = std::holds_alternative<DielectricMaterial>(material.model);
        const float opaque = said.numbers.contains("d") ? said.number("d", 1) : 1 - said.number("Tr", 0);
        auto map = number(said, "d", true);
        if (map) {
            if (opaque > 0) map->scale *= opaque;
            material.opacity = assets_.add(*map);
        } else if (opaque < 1 && !glass) {
            material.opacity = assets_.grey(std::max(opaque, 0.0f));
        }
    }

    std::optional<AreaEmission> emission(const Statements& said) {
        const auto map = picture(said, "Ke");
        const Rgb radiance = said.colour("Ke", {});
        if (is_black(radiance) && !map) return std::nullopt;
        AreaEmission emission{is_black(radiance) ? Rgb{1, 1, 1} : radiance, true, {}};
        if (map) emission.texture = assets_.add(*map);
        return emission;
    }

    Assets& assets_;
    const std::string& path_;
};

}  // namespace

void read_materials(const std::string& path, const SourceLine& where, Assets& assets,
                    std::map<std::string, Surface>& materials) {
    const auto bytes = assets.read(path, where);
    if (!bytes) return;
    Maker maker(assets, path);
    for (const auto& said : MaterialReader(path, **bytes, assets).read())
        if (!materials.contains(said.name)) materials.emplace(said.name, maker.make(said));
}

}  // namespace lightnet::obj
