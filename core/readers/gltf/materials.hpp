// glTF's materials and textures.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/readers/gltf/document.hpp"

namespace lightnet::gltf {

struct Surface {
    MaterialId material = 0;
    std::optional<AreaEmission> emission;
    bool turned = false;                 // it is not alike all around its normal
    bool fades = false;                  // it is there as far as the mesh's colours say
    std::vector<std::size_t> uv_sets{};  // the texture coordinates that its images lie on, the main ones first
};

/// What a mesh's colours say.
struct Painted {
    bool colours = false, alphas = false;
    friend auto operator<=>(const Painted&, const Painted&) = default;
};

/// Makes the materials of one document, each when a primitive first asks for it.
class Materials {
public:
    /// `variant`: which one of the file's; "": it stands as it is.
    Materials(Document& document, Assets& assets, const std::string& variant);

    /// Of a primitive; where it names none, the default. `painted`: by what colours of its own.
    const Surface& of(const At& primitive, Painted painted);

private:
    enum class Kind { colour, numbers };

    At index_of(const At& primitive) const;
    Surface make(const At& at, Painted painted);
    void lay(const At& material);
    PrincipledMaterial model(const At& at, bool painted);
    void extensions(const At& at, PrincipledMaterial& model, Material& material);
    void shine(const At& extensions, PrincipledMaterial& model);
    void coat(const At& clear, PrincipledMaterial& model);
    void pass_on(const At& extensions, PrincipledMaterial& model, Material& material);
    void older(const At& at, PrincipledMaterial& model, bool painted);
    void opacity(const At& at, const At& base, float factor, bool by_vertices, Material& material);
    void emission(const At& at, Surface& surface);

    std::optional<TextureId> texture(const At& info, Kind kind, Rgb scale,
                                     ImageTexture::Channel channel = ImageTexture::Channel::colour);
    std::optional<NormalMap> normal_map(const At& info);
    std::optional<ImageTexture> picture(const At& info, Kind kind);
    std::size_t place_of_set(const At& info);
    std::shared_ptr<const Image> image(const At& index, Kind kind);
    TextureId base(const At& info, Rgb factor, bool painted);

    Document& document_;
    Assets& assets_;
    std::map<std::pair<std::size_t, Painted>, Surface> made_;
    std::optional<std::size_t> variant_;
    bool turned_ = false;
    std::vector<std::size_t> uv_sets_;  // of the material that is being made
};

}  // namespace lightnet::gltf
