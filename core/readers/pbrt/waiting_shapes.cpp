#include "core/readers/pbrt/waiting_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/suggestion.hpp"

namespace lightnet::pbrt {
namespace {

/// One triangle of a mesh, alone.
Mesh single(const Mesh& mesh, std::size_t triangle) {
    Mesh result;
    result.flip_normals = mesh.flip_normals;
    for (const auto i : mesh.triangles[triangle]) {
        result.positions.push_back(mesh.positions[i]);
        if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[i]);
        if (!mesh.uvs.empty()) result.uvs.push_back(mesh.uvs[i]);
        if (!mesh.tangents.empty()) result.tangents.push_back(mesh.tangents[i]);
    }
    result.triangles.push_back({0, 1, 2});
    return result;
}

}  // namespace

std::vector<MadeShape*> WaitingShapes::displaced() const {
    std::vector<MadeShape*> displaced;
    for (const auto& waiting : waiting_)
        if (waiting.made->relief && waiting.made->geometry) displaced.push_back(waiting.made.get());
    return displaced;
}

void WaitingShapes::finish(const std::string& around, const SourceLine& where) {
    find_media(around, where);
    for (auto& waiting : waiting_) {
        if (sources_.report.full()) return;
        finish(waiting);
        waiting.made.reset();
    }
    waiting_.clear();
}

void WaitingShapes::finish(WaitingShape& waiting) {
    MadeShape& made = *waiting.made;
    if (!made.problem.empty()) sources_.report.error(waiting.where, waiting.owner + ": " + made.problem);
    const auto used = materials_.made(waiting.material);
    if (!made.geometry || !used) return;
    if (pieces_of(*made.geometry) == 0)
        return sources_.report.warn(waiting.where, "a shape without any triangle is left out");
    const MaterialId material = filled(*used, waiting);
    if (std::holds_alternative<NoMaterial>(scene_.materials[material].model)) {
        if (waiting.lamp)
            sources_.report.warn(waiting.where, "a lamp with the material 'interface' doesn't shine (as in pbrt)");
        if (!sides_of(waiting))
            return sources_.report.warn(waiting.where,
                                        "a shape of the material 'interface' only bounds media, and is left out");
        waiting.lamp.reset();
    }
    Shape shape;
    shape.media = sides_of(waiting);
    shape.geometry = std::move(*made.geometry);
    shape.material = waiting.alpha ? with_alpha(material, *waiting.alpha) : material;
    shape.where = waiting.where;
    shape.name = std::move(waiting.name);
    if (waiting.lamp)
        emit(std::move(shape), waiting);
    else
        add_shape(std::move(shape), waiting.object);
}

void WaitingShapes::check_medium(const std::string& name, const SourceLine& where) {
    if (!name.empty() && !media_.has(name))
        sources_.report.error(where,
                              fmt::format("there is no medium '{}'{}", name, did_you_mean(name, media_.names())));
}

/// Before shapes are finished: in which media somebody stands, and which are bounded by nothing but themselves.
void WaitingShapes::find_media(const std::string& around, const SourceLine& where) {
    check_medium(around, where);
    media_.be_space(around);
    scene_.around = media_.index(around);
    for (const WaitingShape& waiting : waiting_) {
        check_medium(waiting.inside, waiting.where);
        check_medium(waiting.outside, waiting.where);
        const auto material = materials_.made(waiting.material);
        if (!material || !std::holds_alternative<NoMaterial>(scene_.materials[*material].model)) continue;
        media_.be_space(waiting.inside);
        media_.be_space(waiting.outside);
    }
}

/// Of a mixture, that of the first part that has one.
std::uint16_t WaitingShapes::filling_of(MaterialId material) const {
    const auto found = fillings_.find(material);
    if (found != fillings_.end()) return found->second;
    const auto* mixture = std::get_if<MixtureMaterial>(&scene_.materials[material].model);
    if (!mixture) return Query::no_medium;
    const std::uint16_t first = filling_of(mixture->first);
    return first != Query::no_medium ? first : filling_of(mixture->second);
}

std::optional<MediumSides> WaitingShapes::sides_of(const WaitingShape& waiting) const {
    MediumSides sides{media_.index(waiting.inside), media_.index(waiting.outside)};
    const std::uint16_t filling = filling_of(*materials_.made(waiting.material));
    if (filling != Query::no_medium) sides.inside = filling;
    return sides.inside == sides.outside ? std::nullopt : std::optional(sides);
}

/// A copy of solid glass between media of which one absorbs, or both. As in pbrt the outside is where the normal
/// points, which may be the hollow of the shape. Elsewhere there is no medium for light.
MaterialId WaitingShapes::filled(MaterialId material, const WaitingShape& waiting) {
    const Rgb inside = media_.absorbed_in(waiting.inside), outside = media_.absorbed_in(waiting.outside);
    const Transparency lets_through = transparency_of(scene_.materials[material]);
    if (lets_through == Transparency::opaque || (is_black(inside) && is_black(outside))) return material;
    const auto* glass = std::get_if<DielectricMaterial>(&scene_.materials[material].model);
    // pbrt's rays stay in the medium in which they are, unless it changes there
    if (!glass || glass->thin || waiting.inside == waiting.outside) {
        sources_.report.warn(
            waiting.where,
            "a medium that absorbs is left out where it isn't on one side of a 'dielectric': there it is clear");
        return material;
    }
    // who turns a shape and names what fills it as its outside means the shape that isn't turned
    const bool hollow = waiting.turned && is_black(inside);
    if (hollow && glass->eta != 1)
        sources_.report.warn(waiting.where,
                             "a 'dielectric' that is turned, with a medium outside of it only, bends light as if that "
                             "were inside of one that isn't turned (pbrt bends it the other way round)");
    const auto [place, fresh] = filled_.try_emplace({material, waiting.inside, waiting.outside, hollow});
    if (fresh) {
        place->second = static_cast<MaterialId>(scene_.materials.size());
        Material copy = scene_.materials[material];
        copy.absorption = inside;
        copy.absorption_in_front = outside;
        if (hollow) std::get<DielectricMaterial>(copy.model).eta = 1 / glass->eta;
        scene_.materials.push_back(std::move(copy));
    }
    return place->second;
}

/// A copy of the material that is only there as far as `alpha` says.
MaterialId WaitingShapes::with_alpha(MaterialId material, TextureId alpha) {
    const auto [place, fresh] = with_alpha_.try_emplace({material, alpha});
    if (fresh) {
        place->second = static_cast<MaterialId>(scene_.materials.size());
        Material copy = scene_.materials[material];
        copy.opacity = alpha;
        scene_.materials.push_back(std::move(copy));
    }
    return place->second;
}

/// For pbrt every triangle of a mesh may be a lamp of its own, with the power that was asked for.
void WaitingShapes::emit(Shape shape, const WaitingShape& waiting) {
    constexpr std::size_t most_lamps = 1 << 16;
    AreaLight lamp = *waiting.lamp;
    lamp.emission.unseen = waiting.nowhere;
    const bool each_triangle = waiting.lamp_per_triangle;
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    const double area = area_of(shape.geometry);
    if (!lamp.power || !each_triangle || !mesh) {
        shape.emission = lamp.on(area);
        return add_shape(std::move(shape), std::nullopt);
    }
    if (mesh->triangles.size() > most_lamps) {
        sources_.report.warn(shape.where, "the power of so many triangles is spread evenly over all of them");
        shape.emission = lamp.on(area / double(mesh->triangles.size()));
        return add_shape(std::move(shape), std::nullopt);
    }
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
        Shape one{single(*mesh, i), shape.material, std::nullopt, shape.where, shape.name, shape.media};
        one.emission = lamp.on(area_of(one.geometry));
        add_shape(std::move(one), std::nullopt);
    }
}

void WaitingShapes::add_shape(Shape shape, const std::optional<std::uint32_t>& object) {
    if (joined_ == object && add_to_curves(shape)) return;
    joined_ = object;
    if (object) scene_.objects[*object].shapes.push_back(static_cast<std::uint32_t>(scene_.shapes.size()));
    scene_.shapes.push_back(std::move(shape));
}

/// Files have a statement for each hair. Those that follow each other and are alike become one shape.
bool WaitingShapes::add_to_curves(const Shape& shape) {
    const auto* more = std::get_if<Curves>(&shape.geometry);
    if (!more || shape.emission || scene_.shapes.empty()) return false;
    Shape& last = scene_.shapes.back();
    auto* curves = std::get_if<Curves>(&last.geometry);
    const auto sides = [](const Shape& of) { return of.media.value_or(MediumSides{}); };
    const bool alike = curves && !last.emission && last.material == shape.material &&
                       sides(last).inside == sides(shape).inside && sides(last).outside == sides(shape).outside;
    if (alike) curves->append(*more);
    return alike;
}

}  // namespace lightnet::pbrt
