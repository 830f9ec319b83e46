#include "core/readers/pbrt/version.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <set>
#include <string_view>

#include "core/readers/pbrt/tokenizer.hpp"

namespace lightnet::pbrt {
namespace {

using Names = std::set<std::string_view>;

/// Names behind a directive that only one of the versions knows.
struct Vocabulary {
    Names v3, v4;
};

const Vocabulary& materials_of_versions() {
    static const Vocabulary names{{"disney", "fourier", "glass", "kdsubsurface", "matte", "metal", "mirror", "plastic",
                                   "shinymetal", "substrate", "translucent", "uber"},
                                  {"coatedconductor", "coateddiffuse", "conductor", "dielectric", "diffuse",
                                   "diffusetransmission", "interface", "thindielectric"}};
    return names;
}

const std::map<std::string_view, Vocabulary>& vocabularies() {
    static const std::map<std::string_view, Vocabulary> table{
        {"AreaLightSource", {{"area"}, {}}},
        {"Camera", {{"environment"}, {"spherical"}}},
        {"Film", {{"image"}, {"gbuffer", "rgb", "spectral"}}},
        {"Integrator", {{"directlighting", "whitted"}, {"function", "lightpath", "randomwalk", "simplepath"}}},
        {"LightSource", {{"exinfinite"}, {}}},
        {"Material", materials_of_versions()},
        {"Sampler",
         {{"02sequence", "adaptive", "bestcandidate", "lowdiscrepancy", "maxmindist", "random"},
          {"independent", "paddedsobol", "pmj02bn", "zsobol"}}},
        {"Shape", {{"cone", "heightfield", "hyperboloid", "nurbs", "paraboloid"}, {"bilinearmesh"}}}};
    return table;
}

const Vocabulary& directives_of_versions() {
    static const Vocabulary names{{"Renderer", "SurfaceIntegrator", "Volume", "VolumeIntegrator", "WorldEnd"},
                                  {"Attribute", "ColorSpace", "Import", "Option"}};
    return names;
}

const Vocabulary& parameters_of_versions() {
    static const Vocabulary names{{"Kd", "Kr", "Ks", "Kt", "bumpmap", "mapname", "namedmaterial1"}, {"materials"}};
    return names;
}

/// Goes through the tokens of one file.
class Search {
public:
    Search(const std::string& file, const Bytes& bytes, std::vector<std::string>& included)
        : tokens_(file, {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, unheard_), included_(included) {}

    std::optional<VersionSign> run() {
        while (const auto token = tokens_.next()) {
            if (token->kind == Token::Kind::word) word(token->raw);
            if (token->kind == Token::Kind::text) text(token->raw);
            if (found_) return found_;
        }
        return std::nullopt;
    }

private:
    void word(std::string_view raw) {
        if (raw.empty() || raw[0] < 'A' || raw[0] > 'Z') return;  // a number, true, false
        directive_ = raw;
        texts_ = 0;
        look_up(directives_of_versions(), raw, std::string(raw));
    }

    void text(std::string_view raw) {
        const std::size_t place = texts_++;
        if (directive_ == "Include") return included_.push_back(path_in(raw));
        if (place == 0) {
            if (const auto known = vocabularies().find(directive_); known != vocabularies().end())
                look_up(known->second, raw, fmt::format("{} '{}'", directive_, raw));
        } else if (directive_ == "Texture" && place == 1) {
            if (raw == "color") found(Version::v3, "a Texture of kind 'color'");
        } else if (directive_ == "MakeNamedMaterial" && latest_ == "string type") {
            look_up(materials_of_versions(), raw, fmt::format("a material of type '{}'", raw));
        } else if (const auto blank = raw.rfind(' '); blank != std::string_view::npos) {
            const std::string_view type = raw.substr(0, blank), name = raw.substr(blank + 1);
            if (type == "xyz") found(Version::v3, "a parameter of type 'xyz'");
            look_up(parameters_of_versions(), name, fmt::format("the parameter '{}'", name));
        }
        latest_ = raw;
    }

    void look_up(const Vocabulary& words, std::string_view word, const std::string& text) {
        if (words.v3.contains(word)) found(Version::v3, text);
        if (words.v4.contains(word)) found(Version::v4, text);
    }

    void found(Version version, const std::string& text) {
        if (!found_) found_ = VersionSign{version, tokens_.here(), text};
    }

    Report unheard_;  // what is broken is told by who reads it
    Tokenizer tokens_;
    std::vector<std::string>& included_;
    std::string_view directive_, latest_;
    std::size_t texts_ = 0;  // behind the directive
    std::optional<VersionSign> found_;
};

}  // namespace

std::optional<VersionSign> version_sign(const std::string& file, const Bytes& bytes,
                                        std::vector<std::string>& included) {
    return Search(file, bytes, included).run();
}

}  // namespace lightnet::pbrt
