#include "core/readers/mitsuba/grids.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/readers/common/grid_mesh.hpp"
#include "core/readers/common/iso_surface.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/common/volume_file.hpp"
#include "core/readers/mitsuba/transforms.hpp"
#include "core/scene/textures/look_up.hpp"

namespace lightnet::mitsuba {
namespace {

/// Numbers row by row, the first one on top of a picture.
struct Heights {
    std::uint32_t columns = 0, rows = 0;
    std::vector<float> values{};
};

Heights heights_of(const Image& image, float scale) {
    Heights heights{image.width, image.height};
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) heights.values.push_back(scale * luminance(image.colour(x, y)));
    return heights;
}

/// Of a texture at the middles of pixels. None: reported.
std::optional<Heights> rasterised(const Node& node, Properties& properties, Textures& textures, float scale) {
    const int width = properties.integer("width", -1), height = properties.integer("height", -1);
    const TextureId id = textures.of(node);
    const auto& all = textures.context().assets.scene().textures;
    const auto* picture = std::get_if<ImageTexture>(&all[id].pattern);
    Heights heights;
    if (picture && picture->image) heights.columns = picture->image->width, heights.rows = picture->image->height;
    constexpr int most = 1 << 14;
    if (!picture && (width < 2 || height < 2 || width > most || height > most)) {
        properties.context().error(properties.node(), "its texture needs a 'width' and a 'height', from 2 to 16384");
        return std::nullopt;
    }
    if (!picture) heights.columns = std::uint32_t(width), heights.rows = std::uint32_t(height);
    for (std::uint32_t y = 0; y < heights.rows; ++y)
        for (std::uint32_t x = 0; x < heights.columns; ++x) {
            const Vec2 uv{(float(x) + 0.5f) / float(heights.columns), 1 - (float(y) + 0.5f) / float(heights.rows)};
            heights.values.push_back(scale * luminance(value_at(all, id, {uv})));
        }
    return heights;
}

std::optional<Heights> heights_in(Properties& properties, Textures& textures) {
    const Context& context = properties.context();
    const float scale = properties.number("scale", 1);
    const Node* file = properties.find("filename");
    const auto nested = properties.objects("texture");
    if (!file && nested.size() == 1) return rasterised(*nested[0], properties, textures, scale);
    properties.ignore({"width", "height"});
    if (!file || !nested.empty()) {
        context.error(properties.node(), fmt::format("{} needs a 'filename' or one texture", properties.owner()));
        return std::nullopt;
    }
    const std::string path = context.path(std::string(file->attribute("value")), *file);
    return heights_of(*context.assets.picture(path, {}, file->where), scale);
}

/// Moves a mesh that has normals into the world; they decide on its sides. None: reported.
std::optional<Mesh> moved(Mesh mesh, Properties& properties, bool turned, bool smooth) {
    const Matrix to_world = transform_of(properties);
    if (!transform(mesh, to_world)) {
        properties.context().error(properties.node(), "a vertex is not finite after the transforms");
        return std::nullopt;
    }
    order_by_normals(mesh);
    if (turned) flip(mesh);
    if (!smooth) mesh.normals.clear();
    return mesh;
}

}  // namespace

std::optional<Mesh> height_field(Properties& properties, Textures& textures) {
    const Context& context = properties.context();
    const bool smooth = properties.boolean("shading_normals", true), turned = properties.boolean("flip_normals", false);
    const auto heights = heights_in(properties, textures);
    if (!heights) return std::nullopt;
    if (heights->columns < 2 || heights->rows < 2) {
        context.error(properties.node(), "a height field needs 2 × 2 pixels or more");
        return std::nullopt;
    }
    context.warn(properties.node(), "its patches are cut into triangles, two for each four pixels");
    Mesh mesh = mesh_of_heights(heights->columns, heights->rows, heights->values);
    for (Vec3& p : mesh.positions) p = {2 * p.x - 1, 2 * p.y - 1, p.z};
    for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;  // Mitsuba's v goes down
    smooth_normals(mesh);
    return moved(std::move(mesh), properties, turned, smooth);
}

std::optional<Mesh> sdf_grid(Properties& properties, const Context& context) {
    constexpr std::uint64_t most = std::uint64_t{1} << 24;
    const Node* name = properties.find("filename");
    const bool smooth = properties.text("normals", "smooth") != "analytic";
    const bool turned = properties.boolean("flip_normals", false);
    if (!name) {
        context.error(properties.node(), fmt::format("{} needs a 'filename'", properties.owner()));
        return std::nullopt;
    }
    const std::string path = context.path(std::string(name->attribute("value")), *name);
    const auto bytes = context.assets.read(path, name->where);
    if (!bytes) return std::nullopt;
    const auto refused = [&](const std::string& why) {
        context.report().error({path, 0}, why);
        return std::nullopt;
    };
    try {
        const auto grid = read_volume_file(**bytes, {}, VolumeNumbers::any).grid;
        if (grid->channels != 1) return refused("an 'sdfgrid' has one number a point, not 3");
        for (const auto points : grid->size)
            if (points < 2) return refused("an 'sdfgrid' needs 2 × 2 × 2 points or more");
        auto mesh = iso_surface(*grid, most);
        if (!mesh) return refused("its surface would have more than 2^24 triangles");
        if (mesh->triangles.empty()) return refused("nowhere are its numbers 0: it has no surface");
        context.warn(properties.node(), "its surface is cut into triangles, flat between the edges of cells");
        return moved(*std::move(mesh), properties, turned, smooth);
    } catch (const Error& problem) {
        return refused(problem.what());
    }
}

}  // namespace lightnet::mitsuba
