#include "tests/bench/scene_files.hpp"

#include "tests/support/references.hpp"

namespace lightnet::bench {
namespace {

namespace fs = std::filesystem;

/// One whose reference lies in a folder of `reference/scenes`, and the rest in one of `scenes`.
ReferenceScene real(const std::string& name, const std::string& folder, double noise, int samples) {
    const std::string stem = "scenes/" + folder + "/" + name;
    return {name, stem + ".pbrt", stem + ".exr", "scenes/" + folder + "-pbrt", noise, 1e-2, samples};
}

ReferenceScene strict(const std::string& name, const std::string& reference, double noise, int samples,
                      double share = 0.55) {
    return {name, name + ".pbrt", name + "." + reference + ".exr", "", noise, 1e-3, samples, share};
}

// Links instead of copies; what is there already stays.
void link_all(const fs::path& from, const fs::path& to) {
    for (const auto& entry : fs::directory_iterator(from))
        if (!fs::exists(to / entry.path().filename())) fs::create_symlink(entry.path(), to / entry.path().filename());
}

}  // namespace

// Noise as it is stated beside the references; 0 where it is far below the target.
const std::vector<ReferenceScene>& reference_scenes() {
    static const std::vector<ReferenceScene> all{
        strict("cornell_grey", "mits_path_2048", 0, 64, 0.65),
        strict("cornell_rgb", "mits_path_1024", 2e-4, 64),
        strict("caustic", "mits_bdpt_1280", 6e-4, 64),
        strict("indirect", "mits_path_2048", 6e-4, 64),
        strict("furnace05", "analytic", 0, 64),
        strict("furnace08", "analytic", 0, 64),
        strict("terrain", "combined", 2e-4, 64, 0.8),
        real("cornell-box", "cornell-box", 1.01e-3, 48),
        real("cornell-box-silver", "cornell-box", 1.59e-3, 48),
        real("cornell-box-specular", "cornell-box", 3.02e-3, 48),
        real("smallpt", "cornell-box", 1.57e-3, 48),
        real("bmw-m6", "bmw-m6", 7.78e-3, 32),
        real("living-room", "living-room", 4.4e-2, 32),
        real("staircase2", "staircase2", 1.78e-2, 16),
        real("veach-ajar", "veach-ajar", 4.43e-2, 32),
        real("veach-mis", "veach-mis", 3.41e-3, 48),
        real("veach-mis-colorized", "veach-mis", 2.95e-3, 48),
    };
    return all;
}

SceneFiles::SceneFiles(const ReferenceScene& scene) {
    const auto main = test::reference_file(scene.main), reference = test::reference_file(scene.reference);
    if (!main || !reference) {
        missing_ = test::is_not_here("reference/" + (main ? scene.reference : scene.main));
        return;
    }
    main_ = *main;
    reference_ = *reference;
    if (scene.rest.empty()) return;
    const auto rest = test::shared_file(scene.rest);
    if (!rest) {
        missing_ = test::is_not_here(scene.rest);
        return;
    }
    together_.emplace();
    link_all(main->parent_path(), together_->path());
    link_all(*rest, together_->path());
    main_ = together_->path() / main->filename();
}

}  // namespace lightnet::bench
