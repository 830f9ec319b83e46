#include "core/readers/obj/obj.hpp"

#include <fmt/format.h>

#include "core/base/suggestion.hpp"
#include "core/readers/assets.hpp"
#include "core/readers/mesh_tools.hpp"
#include "core/readers/obj/materials.hpp"
#include "core/readers/obj/model.hpp"

namespace lightnet::obj {
namespace {

/// Finds materials by name; those that are missing are reported once, and grey.
class Palette {
public:
    explicit Palette(Assets& assets) : assets_(assets) {}

    std::map<std::string, Surface>& all() { return materials_; }

    const Surface& of(const Part& part) {
        if (const auto known = materials_.find(part.material); known != materials_.end()) return known->second;
        if (!part.material.empty()) {
            std::vector<std::string> names;
            for (const auto& [name, surface] : materials_) names.push_back(name);
            assets_.report().warn(part.where, fmt::format("there is no material '{}'{}: grey is taken", part.material,
                                                          did_you_mean(part.material, names)));
        }
        Surface grey;
        const bool painted = !part.mesh.colours.empty();
        grey.material = assets_.add(Material{
            part.material,
            DiffuseMaterial{painted ? assets_.add(Texture{{1, 1, 1}, VertexColour{}, false}) : assets_.grey(0.5f)}});
        return painted ? (painted_ = grey) : materials_.emplace(part.material, grey).first->second;
    }

private:
    Assets& assets_;
    std::map<std::string, Surface> materials_;
    Surface painted_;
};

void libraries(const Model& model, const std::string& path, Assets& assets, Palette& palette) {
    for (const auto& [name, where] : model.libraries) {
        if (assets.exists(beside(path, name)))
            read_materials(beside(path, name), where, assets, palette.all());
        else  // shapes without their colours are better than none
            assets.report().warn(where, fmt::format("there is no material library '{}': grey is taken", name));
    }
}

SceneData read(Files& files, const std::string& path, const SceneConstants&) {
    return read_by_assets(files, path, [&](Assets& assets) {
        Report& report = assets.report();
        SceneData& scene = assets.scene();
        const auto bytes = assets.read(path, {path, 0});
        report.check();
        Model model = read_model(**bytes, path, Cut::by_material, report);
        Palette palette(assets);
        libraries(model, path, assets, palette);
        for (auto& part : model.parts) {
            const Surface surface = palette.of(part);
            if (part.mesh.normals.empty() && part.smooth)
                smooth_normals(part.mesh);
            else if (!part.mesh.normals.empty())
                order_by_normals(part.mesh);
            scene.shapes.push_back({std::move(part.mesh), surface.material, surface.emission, part.where, part.object});
        }
        if (scene.shapes.empty() && report.good()) report.error({path, 0}, "there are no faces");
    });
}

}  // namespace

SceneFormat format() { return {.endings = {".obj"}, .read = read}; }

}  // namespace lightnet::obj
