// pbrt's textures, made into those of a scene.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/pictures.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// All textures of one scene, by name. They go into the scene as they are made, so that each stands behind those
/// that it is made of.
class Textures {
public:
    Textures(const Sources& sources, SceneData& scene, Pictures& pictures)
        : sources_(sources), scene_(scene), pictures_(pictures) {}

    /// `Texture "name" "float|spectrum" "class" …`, where it stands in the world.
    void define(const std::string& name, const std::string& kind, const std::string& type, const Matrix& to_world,
                Parameters& parameters);

    /// What the parameter says, as a texture of the scene: rgb, spectrum or the name of a texture.
    TextureId colour(Parameters& parameters, std::string_view name, Rgb fallback, Use use = Use::surface);
    /// What the parameter says, as colour() gives it; none when the parameter isn't there.
    std::optional<TextureId> maybe_colour(Parameters& parameters, std::string_view name, Use use = Use::surface);
    /// A number or the name of a float texture; none when the parameter isn't there.
    std::optional<TextureId> maybe_number(Parameters& parameters, std::string_view name);
    TextureId add(Texture texture);
    TextureId constant(Rgb value) { return add({value, {}, false}); }
    /// An image whose numbers are taken as they are, repeated: normal maps. None: reported.
    std::optional<TextureId> linear_image(const std::string& file, const SourceLine& where);
    /// The value of a texture that is the same everywhere.
    std::optional<Rgb> constant_value(TextureId texture) const;
    /// The texture of `of` the numbers of another: exact where that is one number, a picture or squares of such.
    TextureId mapped(TextureId texture, float (*of)(float), const Parameters& parameters);
    /// The product of a texture and a number.
    TextureId scaled(TextureId texture, float factor);

    /// Once all images are there: pbrt takes a number from an image's alpha, if that is not 1 everywhere.
    void finish();
    Pictures& pictures() { return pictures_; }

private:
    using Named = std::map<std::string, TextureId, std::less<>>;

    std::optional<Texture> make(const std::string& type, Named& named, Parameters& parameters);
    Matrix from_world(const Parameters& parameters) const;
    Texture projected(Texture texture, Parameters& parameters);
    Texture imagemap(Parameters& parameters, ImageTexture::Channel channel);
    Texture scale(Named& named, Parameters& parameters);
    Texture mix(Named& named, Parameters& parameters);
    Texture direction_mix(Named& named, Parameters& parameters);
    Texture checkerboard(Named& named, Parameters& parameters);
    Texture dots(Named& named, Parameters& parameters);
    Texture noise(NoiseTexture::Kind kind, Parameters& parameters);
    Texture marble(Parameters& parameters);
    std::int32_t octaves(Parameters& parameters) const;
    Texture bilinear(Parameters& parameters);
    Texture unsupported(const std::string& type, Parameters& parameters, Rgb mean);
    Rgb corner(Parameters& parameters, std::string_view name, float fallback);
    TextureId input(Named& named, Parameters& parameters, std::string_view name, float fallback);
    TextureId number_or(Parameters& parameters, std::string_view name, float fallback);
    std::optional<TextureId> found_or_none(const Named& named, const Parameter& parameter);
    std::optional<TextureId> find(const Named& named, const Parameter& parameter);
    Encoding encoding_of(Parameters& parameters);

    const Sources& sources_;
    SceneData& scene_;
    Pictures& pictures_;
    Named floats_, spectra_;
    Matrix to_world_;                   // of the texture that is being made
    std::optional<Matrix> from_world_;  // none: that is singular
};

}  // namespace lightnet::pbrt
