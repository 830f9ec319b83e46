#include "core/prepare/kept.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "core/graph/graph_film.hpp"
#include "core/prepare/prepared.hpp"

namespace lightnet {
namespace {

constexpr std::string_view first_line = "lightnet kept 1";
constexpr std::size_t longest_head = 1024;

/// Texts and numbers of a scene, one after the other.
class Sum {
public:
    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void add_all(const std::vector<T>& values) {
        add(values.size());
        if (!values.empty())
            add(content_hash(
                std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T))));
    }
    Hash hash() const { return content_hash(text_); }

private:
    std::string text_;
};

void add_shape(Sum& sum, const Shape& shape) {
    if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
        sum.add_all(mesh->positions);
        sum.add_all(mesh->triangles);
    } else {
        const auto& ball = std::get<Sphere>(shape.geometry);
        sum.add(ball.center);
        sum.add(ball.radius);
    }
    sum.add(shape.material);
    if (shape.emission) sum.add(shape.emission->radiance);
}

void add_picture(Sum& sum, const Image& image) {
    sum.add(image.width);
    sum.add(image.height);
    if (image.empty()) return;
    constexpr std::uint32_t looks = 16;  // along a side
    for (std::uint32_t y = 0; y < looks; ++y)
        for (std::uint32_t x = 0; x < looks; ++x)
            sum.add(image.colour(std::uint32_t(std::uint64_t{image.width} * x / looks),
                                 std::uint32_t(std::uint64_t{image.height} * y / looks)));
}

void add_texture(Sum& sum, const Texture& texture) {
    sum.add(texture.scale);
    sum.add(texture.pattern.index());
    if (const auto* picture = std::get_if<ImageTexture>(&texture.pattern); picture && picture->image)
        add_picture(sum, *picture->image);
}

template <class T>
const T* param_of(const Node& node, const char* name) {
    const auto found = node.params.find(name);
    return found == node.params.end() ? nullptr : std::get_if<T>(&found->second.data);
}

std::string text_of(const Node& node, const char* name) {
    const auto* text = param_of<std::string>(node, name);
    return text ? *text : "";
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The rest of the line that begins with `word`.
std::string after(const std::string& head, const std::string& word) {
    const auto at = head.find("\n" + word + " ");
    if (at == std::string::npos) return "";
    const auto begin = at + word.size() + 2;
    return head.substr(begin, head.find('\n', begin) - begin);
}

}  // namespace

Hash identity_of(const SceneData& scene) {
    Sum sum;
    for (const auto& shape : scene.shapes) add_shape(sum, shape);
    for (const auto& instance : scene.instances) {
        sum.add(instance.object);
        sum.add(instance.to_world.m);
    }
    for (const auto& material : scene.materials) {
        sum.add(material.model.index());
        sum.add(material.absorption);
    }
    for (const auto& texture : scene.textures) add_texture(sum, texture);
    for (const auto& light : scene.lights) std::visit([&](const auto& one) { sum.add(one); }, light);
    for (const auto& sky : scene.environments) {
        sum.add(sky.radiance);
        sum.add(sky.to_world.m);
        if (sky.image) add_picture(sum, *sky.image);
    }
    return sum.hash();
}

std::string kept_text(const Kind& kind, const Hash& scene, std::span<const std::byte> results) {
    return std::string(first_line) + "\nwhat " + kind.freezes + "\nscene " + to_hex(scene) + "\nsum " +
           to_hex(content_hash(results)) + "\n\n" + std::string(as_text(results));
}

Bytes kept_results(const Kind& kind, const Hash& scene, std::span<const std::byte> file) {
    const auto text = as_text(file);
    const auto end = text.substr(0, longest_head).find("\n\n");
    if (!text.starts_with(first_line) || end == std::string_view::npos) throw Error("is no file that a run has kept");
    const std::string head(text.substr(0, end + 1));
    if (const auto what = after(head, "what"); what != kind.freezes)
        throw Error("keeps " + what + ", but " + kind.freezes + " are wanted");
    if (after(head, "scene") != to_hex(scene))
        throw Error("belongs to another scene: its surfaces, materials or lights differ from those here");
    const auto results = file.subspan(end + 2);
    if (after(head, "sum") != to_hex(content_hash(results))) throw Error("is damaged");
    return std::make_shared<const std::vector<std::byte>>(results.begin(), results.end());
}

void take_up_kept(const Graph& graph, const Registry& registry, Files& files, SceneData& scene,
                  std::vector<Problem>& problems) {
    std::optional<Hash> identity;
    for (const auto& node : graph.nodes) {
        const Kind* kind = registry.find(node.kind);
        const auto name = text_of(node, "extend");
        if (!kind || !kind->keeps || name.empty()) continue;
        const auto path = beside_graph(graph, name);
        try {
            if (!identity) identity = identity_of(scene);
            scene.kept[node.name] = kept_results(*kind, *identity, *files.read(path));
        } catch (const std::exception& error) {
            const std::string what = error.what();
            const bool says_path = what.find(path) != std::string::npos;
            problems.push_back({node.where, node.kind + " '" + node.name +
                                                "': 'extend': " + (says_path ? "" : "'" + path + "' ") + what});
        }
    }
}

std::vector<std::pair<std::size_t, std::string>> files_to_keep(const Graph& graph, const Registry& registry) {
    std::vector<std::pair<std::size_t, std::string>> files;
    for (const auto node : preparing_nodes(graph, registry))
        if (const auto name = text_of(graph.nodes[node], "keep");
            registry.find(graph.nodes[node].kind)->keeps && !name.empty())
            files.emplace_back(node, beside_graph(graph, name));
    return files;
}

}  // namespace lightnet
