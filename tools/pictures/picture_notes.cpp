#include "tools/pictures/picture_notes.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <system_error>

#include "core/base/build_info.hpp"
#include "core/base/joined.hpp"
#include "core/base/json_tree.hpp"
#include "core/base/name_id.hpp"
#include "core/base/printable.hpp"
#include "core/network/graph/lamp_groups.hpp"
#include "core/scene/camera/camera_matrices.hpp"

namespace lightnet {
namespace {

std::array<float, 16> for_rows(const Matrix& matrix) {
    std::array<float, 16> entries{};
    for (std::size_t i = 0; i < 16; ++i) entries[i] = static_cast<float>(matrix.m[i % 4][i / 4]);
    return entries;
}

}  // namespace

std::string manifest_of(const SceneData& scene, NamedBy by) {
    std::map<std::string, std::string> manifest;
    const SurfaceNames names = surface_names(scene, by);
    for (const auto* all : {&names.of_shape, &names.of_instance})
        for (const auto& name : *all) {
            if (name.empty()) continue;
            const auto id = fmt::format("{:08x}", std::bit_cast<std::uint32_t>(name_id(name)));
            // what is no UTF-8 is told by what stands for its bytes, which may be somebody's own name
            if (const auto told = in_utf8(name); told == name)
                manifest[told] = id;
            else
                manifest.try_emplace(told, id);
        }
    return to_text(manifest, {.ascii = true});
}

PictureWords words_of(const Graph& graph, const Registry& registry, const FilmFormat& format,
                      const std::map<std::string, std::string>& recipe, const SceneData& scene,
                      const CameraData& seen_from) {
    PictureWords words;
    auto& texts = words.notes.texts;
    texts["software"] = "lightnet " + version();
    texts["seed"] = recipe.at("seed");
    texts["graph"] = recipe.at("graph");
    if (const auto groups = lamp_groups(graph, registry); !groups.empty()) texts["groups"] = joined(groups);
    const auto camera = matrices_of(seen_from, format.width, format.height);
    words.notes.matrices["worldToCamera"] = for_rows(camera.to_camera);
    if (camera.to_ndc) words.notes.matrices["worldToNDC"] = for_rows(*camera.to_ndc);
    for (const auto& [name, count] : format.ids) {
        const Node& node = graph.nodes.at(graph.find(name).value());
        words.manifests[name] = manifest_of(scene, named_by(std::get<std::string>(node.params.at("of").data)));
    }
    return words;
}

void add_words(const PictureWords& words, Picture& picture) {
    picture.notes = words.notes;
    for (auto& matte : picture.mattes)
        if (const auto found = words.manifests.find(matte.name); found != words.manifests.end())
            matte.manifest = found->second;
}

std::optional<std::uint32_t> noted_samples(const Picture& picture) {
    const auto said = picture.notes.texts.find(samples_note);
    if (said == picture.notes.texts.end()) return std::nullopt;
    std::uint32_t samples = 0;
    const auto& text = said->second;
    if (std::from_chars(text.data(), text.data() + text.size(), samples).ec != std::errc()) return std::nullopt;
    return samples;
}

}  // namespace lightnet
