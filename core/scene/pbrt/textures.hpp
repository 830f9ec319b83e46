// pbrt's textures, made into the two kinds that a scene has: a constant, or a picture.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/scene/image_file.hpp"
#include "core/scene/pbrt/parameters.hpp"
#include "core/scene/pbrt/sources.hpp"
#include "core/scene/scene_data.hpp"

namespace lightnet::pbrt {

/// The value of a texture at texture coordinates, as a scene looks it up.
Rgb look_up(const Texture& texture, Vec2 uv);
/// Mean colour of a picture or constant.
Rgb mean_of(const Texture& texture);

/// All textures of one scene, by name. What materials need of them goes into the scene.
class Textures {
public:
    Textures(const Sources& sources, SceneData& scene) : sources_(sources), scene_(scene) {}

    /// `Texture "name" "float|spectrum" "class" …`
    void define(const std::string& name, const std::string& kind, const std::string& type, Parameters& parameters);

    /// What the parameter says, as a texture of the scene: rgb, spectrum or the name of a texture.
    TextureId colour(Parameters& parameters, std::string_view name, Rgb fallback, Use use = Use::surface);
    /// The same; none when the parameter isn't there.
    std::optional<TextureId> maybe_colour(Parameters& parameters, std::string_view name, Use use = Use::surface);
    /// A number; of a texture its mean, with a warning.
    std::optional<float> number(Parameters& parameters, std::string_view name);
    TextureId add(const Texture& texture);
    /// A decoded picture, each file and encoding once. None: reported.
    std::shared_ptr<const Image> image(const std::string& name, const Encoding& encoding, const SourceLine& where);

private:
    using Named = std::map<std::string, Texture, std::less<>>;

    Texture make(const std::string& type, Named& named, Parameters& parameters);
    Texture imagemap(Parameters& parameters);
    Texture scale(Named& named, Parameters& parameters);
    Texture mix(Named& named, Parameters& parameters);
    Texture checkerboard(Named& named, Parameters& parameters);
    Texture input(Named& named, Parameters& parameters, std::string_view name, float fallback);
    const Texture* find(const Named& named, const Parameter& parameter);
    bool room_for(const Image& image, const SourceLine& where);
    Encoding encoding_of(Parameters& parameters);

    const Sources& sources_;
    SceneData& scene_;
    Named floats_, spectra_;
    std::map<std::pair<std::string, std::string>, std::shared_ptr<const Image>> images_;  // by path and encoding
    std::uint64_t pixels_ = 0;                                                            // of all pictures
};

}  // namespace lightnet::pbrt
