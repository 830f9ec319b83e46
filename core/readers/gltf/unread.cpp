#include "core/readers/gltf/unread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace lightnet::gltf {
namespace {

/// Of any object: words about it.
constexpr std::array<std::string_view, 4> words{"name", "extras", "KHR_xmp", "KHR_xmp_json_ld"};

/// What no picture shows, or none of a scene that does not use it; and what is said elsewhere.
constexpr std::array harmless =
    std::to_array<std::string_view>({"accessors",
                                     "animations",
                                     "animations.channels",
                                     "animations.samplers",
                                     "animations.samplers.interpolation",
                                     "animations.samplers.output",
                                     "buffers",
                                     "bufferViews",
                                     "cameras",
                                     "images",
                                     "materials",
                                     "meshes",
                                     "nodes",
                                     "samplers",
                                     "scene",
                                     "scenes",
                                     "skins",
                                     "textures",
                                     "extensionsUsed",
                                     "extensionsRequired",
                                     "accessors.min",
                                     "accessors.normalized",
                                     "accessors.sparse",
                                     "accessors.type",
                                     "accessors.bufferView",
                                     "accessors.byteOffset",
                                     "accessors.componentType",
                                     "accessors.count",
                                     "accessors.max",
                                     "asset.copyright",
                                     "asset.extensions",
                                     "asset.generator",
                                     "asset.minVersion",
                                     "bufferViews.byteStride",
                                     "bufferViews.target",
                                     "buffers.extensions",
                                     "extensions.EXT_lights_ies",
                                     "extensions.KHR_lights_punctual",
                                     "images.mimeType",
                                     "materials.alphaCutoff",
                                     "materials.emissiveTexture",
                                     "materials.extensions.KHR_materials_volume.thicknessTexture",
                                     "materials.occlusionTexture.extensions",
                                     "materials.occlusionTexture.index",
                                     "materials.occlusionTexture.strength",
                                     "materials.occlusionTexture.texCoord",
                                     "meshes.primitives.indices",
                                     "nodes.extensions.EXT_mesh_gpu_instancing",
                                     "nodes.skin",
                                     "nodes.weights",
                                     "samplers.minFilter",
                                     "skins.skeleton"});

/// Lists of numbers by names of one's own.
constexpr std::array<std::string_view, 3> own_names{
    "meshes.primitives.attributes", "meshes.primitives.targets",
    "meshes.primitives.extensions.KHR_draco_mesh_compression.attributes"};

template <std::size_t n>
bool has(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::ranges::find(list, word) != list.end();
}

class Unread {
public:
    Unread(const Json& document, const Seen& seen, const SourceLine& where, Report& report)
        : seen_(seen), where_(where), report_(report) {
        if (!document.has("extensionsUsed")) return;
        if (const auto* used = std::get_if<Json::List>(&document.at("extensionsUsed").data))
            for (const Json& one : *used)
                if (const auto* name = std::get_if<std::string>(&one.data)) used_.insert(*name);
    }

    void look_at(const Json& value, const std::string& path) const {
        if (has(own_names, path)) return;
        if (const auto* list = std::get_if<Json::List>(&value.data)) {
            for (const Json& item : *list)
                if (seen_.contains(&item)) look_at(item, path);
        } else if (const auto* object = std::get_if<Json::Object>(&value.data)) {
            for (const auto& [name, member] : *object)
                if (!has(words, name)) member_of(path, name, member);
        }
    }

private:
    void member_of(const std::string& path, const std::string& name, const Json& member) const {
        const std::string own = path.empty() ? name : fmt::format("{}.{}", path, name);
        if (seen_.contains(&member)) return look_at(member, own);
        if (has(harmless, own)) return;
        // an extension that the file names is named already
        if ((own.ends_with("extensions." + name) && used_.contains(name)) || empty(member)) return;
        if (name == "extensions" && all_used(member)) return;
        report_.warn(where_, fmt::format("'{}' is left out: the picture shows nothing of it", own.substr(0, 256)));
    }
    /// Are these extensions that the file names, all of them?
    bool all_used(const Json& extensions) const {
        const auto* object = std::get_if<Json::Object>(&extensions.data);
        return object && std::ranges::all_of(*object, [&](const auto& member) { return used_.contains(member.first); });
    }
    /// Says nothing: {} or [].
    static bool empty(const Json& value) {
        const auto* list = std::get_if<Json::List>(&value.data);
        const auto* object = std::get_if<Json::Object>(&value.data);
        return (list && list->empty()) || (object && object->empty());
    }

    const Seen& seen_;
    const SourceLine& where_;
    Report& report_;
    std::set<std::string, std::less<>> used_;
};

}  // namespace

void warn_of_unread(const Json& document, const Seen& seen, const SourceLine& where, Report& report) {
    Unread(document, seen, where, report).look_at(document, "");
}

}  // namespace lightnet::gltf
