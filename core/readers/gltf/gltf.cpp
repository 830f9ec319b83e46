#include "core/readers/gltf/gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string_view>

#include "core/readers/common/assets.hpp"
#include "core/readers/gltf/animations.hpp"
#include "core/readers/gltf/nodes.hpp"

namespace lightnet::gltf {
namespace {

const std::set<std::string, std::less<>> known_extensions{"KHR_materials_transmission",
                                                          "KHR_materials_volume",
                                                          "KHR_materials_ior",
                                                          "KHR_materials_clearcoat",
                                                          "KHR_materials_sheen",
                                                          "KHR_materials_specular",
                                                          "KHR_materials_unlit",
                                                          "KHR_lights_punctual",
                                                          "EXT_lights_ies",
                                                          "KHR_texture_transform",
                                                          "KHR_mesh_quantization",
                                                          "EXT_mesh_gpu_instancing",
                                                          "KHR_node_visibility",
                                                          "KHR_animation_pointer",
                                                          "KHR_materials_anisotropy",
                                                          "KHR_materials_iridescence",
                                                          "KHR_materials_dispersion",
                                                          "KHR_materials_diffuse_transmission",
                                                          "KHR_materials_variants",
                                                          "KHR_draco_mesh_compression",
                                                          "EXT_meshopt_compression",
                                                          "EXT_texture_webp",
                                                          "KHR_texture_basisu",
                                                          "KHR_materials_emissive_strength",
                                                          "KHR_materials_pbrSpecularGlossiness"};

/// Which say what no picture shows: of metadata, and of what a mouse may do.
const std::set<std::string, std::less<>> without_pictures{
    "KHR_xmp",           "KHR_xmp_json_ld",         "KHR_node_selectability", "KHR_node_hoverability",
    "KHR_interactivity", "EXT_structural_metadata", "EXT_mesh_features",      "EXT_instance_features"};

bool known(const std::string& extension) {
    return known_extensions.contains(extension) || without_pictures.contains(extension);
}

void check_extensions(const At& root) {
    std::set<std::string> required;
    const At list = root["extensionsRequired"], used = root["extensionsUsed"];
    for (std::size_t i = 0; i < list.size(); ++i) required.insert(list[i].text(""));
    for (const auto& name : required)
        if (!known(name))
            root.report().error(
                {root.file(), 0},
                fmt::format("the file needs the extension '{}', which is not supported", name.substr(0, 64)));
    for (std::size_t i = 0; i < used.size(); ++i)
        if (const auto name = used[i].text(""); !known(name) && !required.contains(name))
            root.warn(fmt::format("extension '{}' is left out: the picture shows nothing of it", name.substr(0, 64)));
}

bool has_points_or_lines(const At& meshes) {
    constexpr std::uint64_t triangles = 4;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const At primitives = meshes[i]["primitives"];
        for (std::size_t j = 0; j < primitives.size(); ++j)
            if (primitives[j]["mode"].whole(triangles) < triangles) return true;
    }
    return false;
}

/// All may be hidden, or have gone where no camera looks: a file that has one means that.
void nothing_stands(const SceneData& scene, const Document& document, Report& report) {
    const SourceLine where{document.path(), 0};
    if (scene.camera_given)
        report.warn(where, "there are no triangles: nothing is seen but what is around the scene");
    else if (has_points_or_lines(document.root()["meshes"]))
        report.error(where, "there are no triangles: its points and lines have no surface, so nothing of them is seen");
    else
        report.error(where, "there are no triangles");
}

/// What is wanted of a file.
struct Wanted {
    std::string variant;
    Moment moment;
};

/// The one variable of a file is which of its variants is shown.
Wanted wanted_in(const SceneConstants& constants, const std::string& path) {
    Wanted wanted;
    for (const auto& [name, value] : constants)
        if (name == "variant")
            wanted.variant = value;
        else if (name == animation_constant)
            wanted.moment.animation = value;
        else if (name == time_constant)
            wanted.moment.seconds = std::strtod(value.c_str(), nullptr);  // a number, as a graph has it
        else
            throw UserError({path, 0}, "glTF has no variables but 'variant': there is no '" + name + "' to define");
    return wanted;
}

SceneData read(Files& files, const std::string& path, const SceneConstants& constants) {
    const auto [variant, moment] = wanted_in(constants, path);
    return read_by_assets(files, path, [&, &variant = variant, &moment = moment](Assets& assets) {
        Report& report = assets.report();
        SceneData& scene = assets.scene();
        scene.up = Vec3{0, 1, 0};
        Document document(assets, path);
        check_extensions(document.root());
        report.check();  // what is packed in unknown ways would only give more errors
        scene.animations = animations_of(document);
        if (!scene.animations.empty() && !moment.seconds && !moment.animation)
            report.warn({path, 0},
                        "its animations stand still: all is as the file has it (--frames, or the scene's 'time', "
                        "chooses another moment)");
        // DECISIONS: still-until-asked
        const auto morphing = move_to(moment, document);
        add_nodes(document, assets, {variant, morphing, moment.seconds.has_value()});
        document.warn_of_unread();
        if (scene.shapes.empty() && report.good()) nothing_stands(scene, document, report);
        if (std::ranges::any_of(scene.shapes, [](const Shape& shape) { return shape.emission.has_value(); }) &&
            scene.environments.empty() && scene.lights.empty())
            report.warn({path, 0}, "only its own glowing surfaces light the scene, where viewers show a sky, too " +
                                       std::string(choose_around));
    });
}

}  // namespace

SceneFormat format() { return {.endings = {".gltf", ".glb"}, .has_variables = true, .moves = true, .read = read}; }

}  // namespace lightnet::gltf
