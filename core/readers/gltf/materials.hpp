// glTF's materials and textures.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

struct Surface {
    MaterialId material = 0;
    std::optional<AreaEmission> emission;
    std::size_t uv_set = 0;  // the texture coordinates that its images lie on
};

/// Makes the materials of one document, each when a primitive first asks for it.
class Materials {
public:
    Materials(Document& document, Assets& assets) : document_(document), assets_(assets) {}

    /// Of a primitive's "material"; where it is not there, the default. `painted`: the mesh has colours of its own.
    const Surface& of(const At& index, bool painted);

private:
    enum class Kind { colour, numbers };

    Surface make(const At& at, bool painted);
    PrincipledMaterial model(const At& at, bool painted);
    void extensions(const At& at, PrincipledMaterial& model, Material& material);
    void older(const At& at, PrincipledMaterial& model, bool painted);
    void opacity(const At& at, const At& base, float factor, Material& material);
    void emission(const At& at, Surface& surface);

    std::optional<TextureId> texture(const At& info, Kind kind, Rgb scale,
                                     ImageTexture::Channel channel = ImageTexture::Channel::colour);
    std::optional<ImageTexture> picture(const At& info, Kind kind);
    std::shared_ptr<const Image> image(const At& index, Kind kind);
    TextureId base(const At& info, Rgb factor, bool painted);

    Document& document_;
    Assets& assets_;
    std::map<std::pair<std::size_t, bool>, Surface> made_;
    std::optional<std::size_t> uv_set_;  // of the material that is being made
};

}  // namespace lightnet::gltf
