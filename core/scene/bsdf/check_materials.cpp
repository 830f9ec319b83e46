#include "core/scene/bsdf/check_materials.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t deepest = 64, most_parts = 1024;

[[noreturn]] void wrong(const Material& material, const std::string& what) {
    throw Error("scene", "material '" + material.name + "' " + what);
}

void check_names(std::span<const Material> materials, std::size_t textures) {
    for (const Material& material : materials) {
        visit_each<TextureId>(material, [&](TextureId id) {
            if (id >= textures) wrong(material, "names a texture that isn't there");
        });
        visit_each<MaterialId>(material, [&](MaterialId id) {
            if (id >= materials.size()) wrong(material, "names a material that isn't there");
        });
    }
}

/// Depth first, each material once; one that is met while it is open contains itself.
class Mixtures {
public:
    explicit Mixtures(std::span<const Material> materials) : materials_(materials), sizes_(materials.size()) {}

    struct Size {
        std::uint32_t levels = 0, parts = 0;  // no parts: not known yet
        bool open = false;
    };
    /// Of a material that lies that deep in another.
    Size size_of(MaterialId id, std::uint32_t depth) {
        Size& size = sizes_[id];
        if (size.open) wrong(materials_[id], "is mixed from itself");
        if (depth > deepest) too_deep(id);
        if (size.parts > 0) return size;
        size.open = true;
        Size whole;
        visit_each<MaterialId>(materials_[id], [&](MaterialId part) {
            const Size of_part = size_of(part, depth + 1);
            whole.levels = std::max(whole.levels, of_part.levels + 1);
            whole.parts += of_part.parts;
        });
        whole.parts = std::max(whole.parts, 1u);
        if (whole.levels > deepest) too_deep(id);
        if (whole.parts > most_parts)
            wrong(materials_[id], "is mixed from more than " + std::to_string(most_parts) + " materials");
        return size = whole;
    }

private:
    [[noreturn]] void too_deep(MaterialId id) const {
        wrong(materials_[id],
              "belongs to mixtures of mixtures that are more than " + std::to_string(deepest) + " deep");
    }

    std::span<const Material> materials_;
    std::vector<Size> sizes_;
};

}  // namespace

void check_materials(std::span<const Material> materials, std::size_t textures) {
    check_names(materials, textures);
    Mixtures mixtures(materials);
    for (std::uint32_t id = 0; id < materials.size(); ++id) mixtures.size_of(id, 0);
}

}  // namespace lightnet
