#include "core/scene/data/identity.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

/// Of which equal values have equal bytes, as nothing lies between their numbers. (0 and -0 are told apart, which does
/// no harm.)
template <class T>
constexpr bool as_bytes = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
constexpr bool as_bytes<Vec2> = sizeof(Vec2) == 2 * sizeof(float);
template <>
constexpr bool as_bytes<Vec3> = sizeof(Vec3) == 3 * sizeof(float);
template <>
constexpr bool as_bytes<Rgb> = sizeof(Rgb) == 3 * sizeof(float);
template <>
constexpr bool as_bytes<Matrix> = sizeof(Matrix) == 16 * sizeof(double);
template <class T, std::size_t n>
constexpr bool as_bytes<std::array<T, n>> = as_bytes<T>;

/// Contents of pictures that were asked for: they are large, and textures share them.
using Pictures = std::map<const Image*, std::optional<Hash>>;

/// Everything that it is shown, one after the other; whoever shows less than before must say so, or two scenes could
/// look alike.
class Sum {
public:
    explicit Sum(Pictures& pictures) : pictures_(pictures) {}

    Hash finish() {
        flush();
        return hasher_.finish();
    }

    template <class T>
    void add(const T& value) {
        if constexpr (as_bytes<T>)
            add_bytes(std::as_bytes(std::span(&value, 1)));
        else if constexpr (!std::is_empty_v<T>)
            visit_members(value, [&](const auto&... members) { (add(members), ...); });
    }
    template <class T>
    void add(const std::optional<T>& value) {
        add(value.has_value());
        if (value) add(*value);
    }
    template <class... T>
    void add(const std::variant<T...>& value) {
        add(value.index());
        std::visit([&](const auto& one) { add(one); }, value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        if constexpr (as_bytes<T>)
            add_bytes(std::as_bytes(std::span(values)));
        else
            for (const T& value : values) add(value);
    }
    void add(const std::monostate&) {}
    void add(const Hash& hash) { add(hash.bytes); }
    void add(const CameraData& camera) {
        const auto& [to_world, projection, fov, screen, screen_given, lens_radius, focus_distance, where, nearest,
                     farthest, later, next] = camera;
        add(to_world), add(projection), add(fov), add(screen), add(screen_given), add(lens_radius);
        add(focus_distance), add(nearest), add(farthest), add(later), add(next);
    }
    void add(const std::string& text) {
        add(text.size());
        add_bytes(std::as_bytes(std::span(text)));
    }
    void add(const std::shared_ptr<const Image>& image) {
        auto& hash = pictures_[image.get()];
        if (!hash) hash = image ? image->content() : Hash{};
        add(hash->bytes);
    }

    void add(const std::shared_ptr<const VolumeGrid>& grid) { add(grid ? grid->content().bytes : Hash{}.bytes); }
    void add(const std::shared_ptr<const Measurement>& measured) {
        add(measured ? measured->content().bytes : Hash{}.bytes);
    }

private:
    void add_bytes(std::span<const std::byte> bytes) {
        constexpr std::size_t enough = 1 << 16;  // many small numbers go to the hash together
        if (bytes.size() >= enough || buffer_.size() >= enough) flush();
        if (bytes.size() >= enough) return hasher_.add(bytes);
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
    void flush() {
        hasher_.add(buffer_);
        buffer_.clear();
    }

    Hasher hasher_;
    std::vector<std::byte> buffer_;
    Pictures& pictures_;
};

template <class... T>
Hash hash_of(Pictures& pictures, const T&... values) {
    Sum sum(pictures);
    (sum.add(values), ...);
    return sum.finish();
}
template <class T>
std::vector<Hash> hashes_of(Pictures& pictures, const std::vector<T>& values) {
    std::vector<Hash> hashes;
    for (const T& value : values) hashes.push_back(hash_of(pictures, value));
    return hashes;
}

/// Materials and textures that some shape has: no light meets any other, whatever it is.
class Used {
public:
    explicit Used(const SceneData& scene)
        : scene_(scene), materials_(scene.materials.size()), textures_(scene.textures.size()) {
        for (const Shape& shape : scene.shapes) add(shape.material), add(shape.emission);
    }

    std::vector<Hash> materials(std::vector<Hash> hashes) const { return of(materials_, std::move(hashes)); }
    std::vector<Hash> textures(std::vector<Hash> hashes) const { return of(textures_, std::move(hashes)); }

private:
    static std::vector<Hash> of(const std::vector<bool>& used, std::vector<Hash> hashes) {
        for (std::size_t i = 0; i < hashes.size(); ++i)
            if (!used[i]) hashes[i] = {};
        return hashes;
    }
    template <class T>
    void add(const T& value) {
        if constexpr (!as_bytes<T> && !std::is_empty_v<T>)
            visit_members(value, [&](const auto&... members) { (add(members), ...); });
    }
    template <class T>
    void add(const std::optional<T>& value) {
        if (value) add(*value);
    }
    template <class... T>
    void add(const std::variant<T...>& value) {
        std::visit([&](const auto& one) { add(one); }, value);
    }
    template <class T>
    void add(const std::vector<T>& values) {
        for (const T& value : values) add(value);
    }
    template <class T>
    void add(const std::shared_ptr<T>&) {}
    void add(const std::monostate&) {}
    void add(const std::string&) {}
    void add(MaterialId material) {
        if (material >= materials_.size() || materials_[material]) return;
        materials_[material] = true;
        add(scene_.materials[material]);
    }
    void add(TextureId texture) {
        if (texture >= textures_.size() || textures_[texture]) return;
        textures_[texture] = true;
        add(scene_.textures[texture]);
    }

    const SceneData& scene_;
    std::vector<bool> materials_, textures_;
};

// Without what shines of it, which belongs to lamps.
Hash hash_of_shape(Pictures& pictures, const Shape& shape) {
    const bool shines = shape.emission.has_value();
    return hash_of(pictures, shape.geometry, shape.material, shape.media, shines, shines && shape.emission->unseen);
}

std::vector<Hash> hashes_of_lamps(Pictures& pictures, const SceneData& scene) {
    std::vector<Sum> sums;
    for (std::size_t group = 0; group < std::max<std::size_t>(1, scene.groups.size()); ++group)
        sums.emplace_back(pictures);
    const auto of = [&](std::size_t group) -> Sum& { return sums[std::min(group, sums.size() - 1)]; };
    for (std::size_t i = 0; i < scene.shapes.size(); ++i)
        if (const auto& emission = scene.shapes[i].emission) {
            of(emission->label.group).add(i);
            of(emission->label.group).add(*emission);
        }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const auto later = SceneMotion::steps_after(scene.motion.lights, i);
        const auto group = std::visit([](const auto& light) { return light.label.group; }, scene.lights[i]);
        of(group).add(i);
        of(group).add(scene.lights[i]);
        of(group).add(std::vector<BareLight>(later.begin(), later.end()));
    }
    of(scene.environment_group).add(scene.environments);
    std::vector<Hash> hashes;
    for (Sum& sum : sums) hashes.push_back(sum.finish());
    return hashes;
}

// Those of some groups, and where all stand.
Hash hash_of_lamps(const SceneTree& tree, GroupSet groups) {
    if (groups == all_groups) return tree.parts.at(ScenePart::lamps);
    std::string text = to_hex(tree.parts.at(ScenePart::geometry));
    for (std::size_t group = 0; group < std::min(tree.lamps.size(), most_groups); ++group)
        if (groups >> group & 1) text += ' ' + std::to_string(group) + ' ' + to_hex(tree.lamps[group]);
    return content_hash(text);
}

Hash hash_of_names(Pictures& pictures, const SceneData& scene) {
    Sum sum(pictures);
    for (const auto& shape : scene.shapes) {
        sum.add(shape.name), sum.add(shape.node_name);
        sum.add(shape.emission ? shape.emission->label.name : std::string());
    }
    for (const auto& object : scene.objects) sum.add(object.name);
    for (const auto& instance : scene.instances) sum.add(instance.node_name);
    for (const auto& material : scene.materials) sum.add(material.name);
    for (const auto& light : scene.lights) std::visit([&](const auto& one) { sum.add(one.label.name); }, light);
    sum.add(scene.groups);
    return sum.finish();
}

}  // namespace

// DECISIONS: identity-of-a-scene
Hash identity_of(const SceneData& scene) {
    Pictures pictures;
    return hash_of(pictures, scene);
}

// DECISIONS: recipes-by-part
SceneTree tree_of(const SceneData& scene) {
    Pictures pictures;
    SceneTree tree;
    tree.textures = hashes_of(pictures, scene.textures);
    tree.materials = hashes_of(pictures, scene.materials);
    tree.instances = hashes_of(pictures, scene.instances);
    for (const Shape& shape : scene.shapes) tree.shapes.push_back(hash_of_shape(pictures, shape));
    tree.lamps = hashes_of_lamps(pictures, scene);
    const auto& motion = scene.motion;
    const SceneMotion next = scene.next ? scene.next->motion : SceneMotion{};
    const Used used(scene);
    const auto materials = used.materials(tree.materials), textures = used.textures(tree.textures);
    // Rays go through holes, surfaces have bumps, and a point knows what its material asks for.
    const Hash geometry = hash_of(pictures, tree.shapes, scene.objects, tree.instances, motion.shapes, motion.instances,
                                  scene.next.has_value(), next.shapes, next.instances, materials, textures);
    tree.parts[ScenePart::geometry] = geometry;
    tree.parts[ScenePart::materials] = hash_of(pictures, materials, textures);
    tree.parts[ScenePart::lamps] = hash_of(pictures, geometry, tree.lamps, scene.environment_group, motion.lights);
    tree.parts[ScenePart::media] = hash_of(pictures, geometry, scene.media, scene.around);
    tree.parts[ScenePart::names] = hash_of_names(pictures, scene);
    return tree;
}

void SceneTree::look_by(const CameraData& camera, const FilmData& film) {
    Pictures none;
    parts[ScenePart::camera] = hash_of(none, camera, film.width, film.height);
    parts[ScenePart::film] = hash_of(none, film.width, film.height, film.scale, film.crop);
}

Hash SceneTree::of(SceneParts some, GroupSet groups) const {
    std::string text;
    for (const ScenePart part : all_scene_parts)
        if (some.contain(part)) {
            const auto found = parts.find(part);
            if (found == parts.end()) throw Error("scene", "nobody has looked into its " + to_string(part));
            const Hash hash = part == ScenePart::lamps ? hash_of_lamps(*this, groups) : found->second;
            text += to_string(part) + ' ' + to_hex(hash) + '\n';
        }
    return content_hash(text);
}

}  // namespace lightnet
