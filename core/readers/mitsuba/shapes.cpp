#include "core/readers/mitsuba/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/suggestion.hpp"
#include "core/base/unwanted.hpp"
#include "core/readers/common/mesh_tools.hpp"
#include "core/readers/files/files.hpp"
#include "core/readers/mitsuba/attributes.hpp"
#include "core/readers/mitsuba/colours.hpp"
#include "core/readers/mitsuba/curves.hpp"
#include "core/readers/mitsuba/grids.hpp"
#include "core/readers/mitsuba/primitives.hpp"
#include "core/readers/mitsuba/serialized.hpp"
#include "core/readers/mitsuba/transforms.hpp"
#include "core/readers/obj/model.hpp"
#include "core/readers/ply/mesh.hpp"
#include "core/scene/shapes/placed_quadric.hpp"
#include "core/scene/surfaces/placement.hpp"

namespace lightnet::mitsuba {
namespace {

constexpr std::uint64_t most_triangles = std::uint64_t{1} << 30;

const std::vector<std::string> known_shapes{"obj",          "ply",         "serialized", "rectangle",   "cube",
                                            "disk",         "sphere",      "cylinder",   "instance",    "shapegroup",
                                            "bsplinecurve", "linearcurve", "merge",      "heightfield", "sdfgrid"};

void turn_uvs(Mesh& mesh) {
    for (auto& uv : mesh.uvs) uv.y = 1 - uv.y;
}

}  // namespace

void Shapes::add(const Node& node) {
    if (node.type == "shapegroup") return;  // made when an instance asks for it
    if (node.type == "instance") {
        Properties properties(node, context_);
        return instance(properties);
    }
    for (const Node* part : merged(node, 0)) shape(*part, false);
}

/// What a shape of type 'merge' consists of, or the shape itself.
std::vector<const Node*> Shapes::merged(const Node& shape, int depth) const {
    constexpr int deepest = 16;
    if (shape.type != "merge") return {&shape};
    if (depth == deepest) {
        context_.error(shape, "shapes are merged too deeply");
        return {};
    }
    std::vector<const Node*> all;
    Properties properties(shape, context_);
    for (const Node* part : properties.objects("shape")) {
        const auto parts = merged(*part, depth + 1);
        all.insert(all.end(), parts.begin(), parts.end());
    }
    return all;
}

std::optional<std::uint32_t> Shapes::shape(const Node& node, bool in_group) {
    end_if_unwanted();
    Properties properties(node, context_);
    auto geometry = this->geometry(properties);
    auto emission = this->emission(properties);
    MaterialId material = this->material(properties, emission.has_value());
    const auto media = absorb(properties, material) ? std::nullopt : media_.sides(properties);
    if (emission && in_group) {
        context_.warn(node, "lamps inside of a shapegroup are left out: they are dark");
        emission.reset();
    }
    if (emission && !shine_alone(node, media.has_value(), material, *emission)) emission.reset();
    if (!geometry) return std::nullopt;
    size_ += pieces_of(*geometry);
    if (size_ > most_triangles) {
        context_.error(node, "the scene has too many triangles");
        return std::nullopt;
    }
    auto& scene = context_.assets.scene();
    scene.shapes.push_back({std::move(*geometry), material, emission, node.where,
                            node.id.empty() ? stem_of(properties.text("filename", "")) : node.id, media});
    return static_cast<std::uint32_t>(scene.shapes.size() - 1);
}

std::optional<ShapeGeometry> Shapes::geometry(Properties& properties) {
    const auto& type = properties.node().type;
    std::optional<Mesh> mesh;
    if (type == "sphere") return round(properties);
    if (type == "obj" || type == "ply" || type == "serialized") {
        mesh = file(properties);
    } else if (type == "rectangle") {
        mesh = placed(properties, rectangle());
    } else if (type == "cube") {
        mesh = placed(properties, cube());
    } else if (type == "disk") {
        Quadric disk;
        disk.to_uv = {{{0, -1, 1}, {-1, 0, 1}}};  // by the radius, and by the turn
        return stood(properties, disk, Matrix{});
    } else if (type == "cylinder") {
        return cylinder(properties);
    } else if (type == "heightfield") {
        mesh = height_field(properties, textures_);
    } else if (type == "sdfgrid") {
        mesh = sdf_grid(properties, context_);
    } else if (type == "bsplinecurve" || type == "linearcurve") {
        return curves(properties);
    } else {
        properties.ignore_all();
        context_.warn(properties.node(), fmt::format("shape '{}' is not supported{} and left out", type,
                                                     did_you_mean(type, known_shapes)));
    }
    if (mesh) return *std::move(mesh);
    return std::nullopt;
}

std::optional<ShapeGeometry> Shapes::curves(Properties& properties) {
    const Node* name = properties.find("filename");
    const Matrix to_world = transform_of(properties);
    properties.ignore({"silhouette_sampling_weight"});
    if (!name) {
        context_.error(properties.node(), fmt::format("{} needs a 'filename'", properties.owner()));
        return std::nullopt;
    }
    const std::string path = context_.path(std::string(name->attribute("value")), *name);
    const auto bytes = context_.assets.read(path, name->where);
    if (!bytes) return std::nullopt;
    try {
        const std::string_view text(reinterpret_cast<const char*>((*bytes)->data()), (*bytes)->size());
        return read_curves(text, properties.node().type == "linearcurve", to_world);
    } catch (const Error& problem) {
        context_.report().error({path, 0}, problem.what());
        return std::nullopt;
    }
}

/// Moves a mesh that has normals into the world; they decide on its sides.
std::optional<Mesh> Shapes::placed(Properties& properties, Mesh mesh) {
    const bool turned = properties.boolean("flip_normals", false);
    if (!transform(mesh, transform_of(properties))) {
        context_.error(properties.node(), "a vertex is not finite after the transforms");
        return std::nullopt;
    }
    order_by_normals(mesh);
    if (turned) flip(mesh);
    mesh.normals.clear();  // it is flat
    return mesh;
}

/// Moves a quadric into the world.
std::optional<ShapeGeometry> Shapes::stood(Properties& properties, Quadric quadric, const Matrix& own) {
    quadric.flip_normals = properties.boolean("flip_normals", false);
    quadric.to_world = transform_of(properties) * own;
    if (PlacedQuadric(quadric).usable()) return quadric;
    context_.error(properties.node(), "its transforms are not finite, or leave it no extent");
    return std::nullopt;
}

std::optional<ShapeGeometry> Shapes::cylinder(Properties& properties) {
    const Vec3 from = properties.point("p0", {0, 0, 0}), to = properties.point("p1", {0, 0, 1});
    const float radius = properties.number("radius", 1);
    const Vec3 axis = to - from;
    if (!(length(axis) > 0)) {
        context_.error(properties.node(), "a cylinder needs a length");
        return std::nullopt;
    }
    const Vec3 z = normalize(axis), other = std::fabs(z.x) < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 x = normalize(cross(other, z)), y = cross(z, x);
    Matrix frame;
    for (std::size_t i = 0; i < 3; ++i) {
        frame.m[i][0] = x[i] * radius, frame.m[i][1] = y[i] * radius;
        frame.m[i][2] = axis[i], frame.m[i][3] = from[i];
    }
    Quadric cylinder;
    cylinder.round = Quadric::Round::cylinder;
    cylinder.to_uv[1] = {0, -1, 1};
    return stood(properties, cylinder, frame);
}

std::optional<ShapeGeometry> Shapes::round(Properties& properties) {
    Sphere sphere;
    const Vec3 center = properties.point("center", {0, 0, 0});
    const float radius = properties.number("radius", 1);
    const Matrix to_world = transform_of(properties);
    const auto scale = uniform_scale(to_world);
    if (!(radius > 0) || (scale && !(*scale > 0))) {
        context_.error(properties.node(), "a sphere needs a radius above 0");
        return std::nullopt;
    }
    Matrix local;
    for (std::size_t i = 0; i < 3; ++i) local.m[i][i] = radius, local.m[i][3] = center[i];
    if (!scale) {
        Quadric ellipsoid;
        ellipsoid.round = Quadric::Round::sphere;
        return stood(properties, ellipsoid, local);
    }
    sphere.center = transform_point(to_world, center);
    sphere.radius = radius * *scale;
    sphere.flip_normals = properties.boolean("flip_normals", false);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sphere.to_world.m[i][j] = to_world.m[i][j] / double(*scale);
    if (finite(sphere.center) && std::isfinite(sphere.radius)) return sphere;
    context_.error(properties.node(), "a sphere is not finite after the transforms");
    return std::nullopt;
}

/// The attribute that the shape's textures ask for; "": none. There is room for one.
std::string Shapes::attribute_of(const Node& shape) const {
    const auto names = attributes_in(shape, context_);
    for (std::size_t i = 1; i < names.size(); ++i)
        context_.warn(shape,
                      fmt::format("the mesh attribute '{}' is left out, as there is '{}': its textures take that",
                                  names[i].substr(0, 32), names[0].substr(0, 32)));
    return names.empty() ? "" : names[0];
}

std::optional<Mesh> Shapes::decoded(Properties& properties, const Node& name, bool& face_normals,
                                    std::vector<Rgb>& of_triangles) {
    const std::string path = context_.path(std::string(name.attribute("value")), name);
    const auto& type = properties.node().type;
    const int index = std::max(properties.integer("shape_index", 0), 0);
    const bool turned = properties.boolean("flip_tex_coords", type == "obj");
    const auto bytes = context_.assets.read(path, name.where);
    if (!bytes) return std::nullopt;
    const std::string attribute = attribute_of(properties.node());
    try {
        Mesh mesh;
        if (type == "obj") {
            auto model = obj::read_model(**bytes, path, obj::Cut::nowhere, context_.report());
            const bool own_materials = properties.boolean("load_materials", true) && context_.document.version == 0;
            if (own_materials && !model.libraries.empty() && properties.objects("bsdf").empty())
                context_.warn(properties.node(), fmt::format("the materials that '{}' names are left out: it is grey, "
                                                             "as its shape has no bsdf",
                                                             path));
            if (!model.parts.empty()) mesh = std::move(model.parts[0].mesh);
        } else if (type == "ply") {
            auto read = attribute.empty() ? AttributedMesh{read_ply(**bytes), {}, true} : read_ply(**bytes, attribute);
            mesh = std::move(read.mesh);
            of_triangles = std::move(read.of_triangles);
        } else {
            bool flat = false;
            mesh = read_serialized(**bytes, static_cast<std::size_t>(index), flat);
            face_normals = face_normals || flat;
        }
        if (!attribute.empty() && mesh.colours.empty() && of_triangles.empty())
            context_.warn(properties.node(), fmt::format("there is no mesh attribute '{}' in '{}': white is taken",
                                                         attribute.substr(0, 32), path));
        if (!turned) turn_uvs(mesh);  // Mitsuba's v goes down
        return mesh;
    } catch (const Error& problem) {
        context_.report().error({path, 0}, problem.what());
        return std::nullopt;
    }
}

std::optional<Mesh> Shapes::file(Properties& properties) {
    const Node* name = properties.find("filename");
    bool face_normals = properties.boolean("face_normals", false);
    const bool turned = properties.boolean("flip_normals", false);
    properties.ignore({"collapse", "merge"});
    if (!name) {
        context_.error(properties.node(), fmt::format("{} needs a 'filename'", properties.owner()));
        return std::nullopt;
    }
    std::vector<Rgb> of_triangles;
    auto mesh = decoded(properties, *name, face_normals, of_triangles);
    const Matrix to_world = transform_of(properties);
    if (!mesh) return std::nullopt;
    if (face_normals) mesh->normals.clear();
    if (!transform(*mesh, to_world)) {
        context_.error(properties.node(), "a vertex is not finite after the transforms");
        return std::nullopt;
    }
    if (!face_normals) mesh->normals.empty() ? smooth_normals(*mesh) : order_by_normals(*mesh);
    if (turned) flip(*mesh);
    if (!of_triangles.empty()) paint(*mesh, of_triangles);
    return mesh;
}

MaterialId Shapes::material(Properties& properties, bool lamp) {
    const auto given = properties.objects("bsdf");
    if (given.empty()) return bsdfs_.unnamed(lamp);
    if (given.size() > 1) context_.warn(properties.node(), "further bsdfs of a shape are left out");
    return bsdfs_.of(*given[0]);
}

std::optional<AreaEmission> Shapes::emission(Properties& properties) {
    const auto given = properties.objects("emitter");
    if (given.empty()) return std::nullopt;
    Properties lamp(*given[0], context_);
    lamp.ignore({"sampling_weight"});
    if (given[0]->type != "area") {
        lamp.ignore_all();
        context_.warn(*given[0], fmt::format("emitter '{}' inside of a shape is left out: it is dark", given[0]->type));
        return std::nullopt;
    }
    AreaEmission emission{{1, 1, 1}, lamp.boolean("two_sided", false), {}, {given[0]->id}};
    emission.unseen = lamp.boolean("unseen", false);
    const Node* radiance = lamp.find("radiance");
    if (radiance && !is_colour(*radiance))
        emission.texture = textures_.of_light(*radiance);
    else
        emission.radiance = radiance ? light_of(*radiance, context_).value_or(LightColour{}).rgb : Rgb{1, 1, 1};
    return emission;
}

/// In Mitsuba a lamp shines where its surface is not there, too; here as far as it is there. False: it can't.
bool Shapes::shine_alone(const Node& shape, bool fills, MaterialId& id, AreaEmission& emission) const {
    Assets& assets = context_.assets;
    const Material& material = assets.scene().materials[id];
    const Texture* opacity = material.opacity ? &assets.scene().textures[*material.opacity] : nullptr;
    const bool even = !opacity || std::holds_alternative<std::monostate>(opacity->pattern);
    const float there = std::holds_alternative<NoMaterial>(material.model) ? 0 : opacity ? opacity->scale.r : 1;
    if (!even && !emission.unseen) {
        context_.warn(shape, "the lamp is left out where 'mask' leaves nothing of its surface: it is dark there");
        return true;
    }
    if (there > 0 && !emission.unseen) {
        emission.radiance *= 1 / std::min(there, 1.0f);
        return true;
    }
    if (fills) {
        context_.warn(shape, "the lamp of a surface that only bounds a medium is left out: it is dark");
        return false;
    }
    if (!emission.unseen)
        context_.warn(shape, "a lamp without a surface shines, but the picture does not show the lamp itself");
    emission.unseen = true;
    if (even && opacity && there <= 0) return true;
    Material nothing{"", DiffuseMaterial{assets.grey(0)}};
    nothing.opacity = assets.grey(0);
    id = assets.add(std::move(nothing));
    return true;
}

/// A medium that only absorbs colours the light inside of its glass. Is it one? Others are media in space.
bool Shapes::absorb(Properties& properties, MaterialId& id) {
    for (const auto& child : properties.node().children) {
        const Node* medium = child->tag == "medium" || child->tag == "ref" ? context_.resolved(*child) : nullptr;
        if (!medium || medium->tag != "medium" || child->name != "interior" || medium->type != "homogeneous") continue;
        Properties inside(*medium, context_);
        inside.ignore_all();
        for (const char* name : {"sigma_t", "albedo", "sigma_a", "sigma_s", "scale"})
            if (const Node* given = inside.find(name); given && !is_colour(*given)) return false;
        const bool by_parts = inside.has("sigma_a");
        const Rgb scattered =
            surface_of(inside, by_parts ? "sigma_s" : "albedo", by_parts ? Rgb{1, 1, 1} : Rgb{0.75f, 0.75f, 0.75f}).rgb;
        if (!is_black(scattered)) return false;
        const Rgb absorbed =
            surface_of(inside, by_parts ? "sigma_a" : "sigma_t", {1, 1, 1}).rgb * inside.number("scale", 1);
        Material copy = context_.assets.scene().materials[id];
        if (!std::holds_alternative<DielectricMaterial>(copy.model)) return false;
        properties.find("interior");
        copy.absorption = absorbed;
        id = context_.assets.add(std::move(copy));
        return true;
    }
    return false;
}

void Shapes::instance(Properties& properties) {
    const auto groups = properties.objects("shape");
    const Matrix to_world = transform_of(properties);
    if (groups.size() != 1 || groups[0]->type != "shapegroup")
        return context_.error(properties.node(), "an instance needs a reference to one shapegroup");
    const auto object = group(*groups[0]);
    if (!object) return;
    if (const std::string fault = lightnet::Placement::fault(to_world); !fault.empty())
        return context_.error(properties.node(), fault);
    context_.assets.scene().instances.push_back({*object, to_world});
}

std::optional<std::uint32_t> Shapes::group(const Node& node) {
    if (const auto known = groups_.find(&node); known != groups_.end()) return known->second;
    Properties properties(node, context_);
    Object object;
    object.name = node.id;
    for (const Node* given : properties.objects("shape"))
        for (const Node* part : merged(*given, 0))
            if (part->type == "instance" || part->type == "shapegroup")
                context_.error(*part, "there can be no instances inside of a shapegroup");
            else if (const auto made = shape(*part, true))
                object.shapes.push_back(*made);
    auto& objects = context_.assets.scene().objects;
    objects.push_back(std::move(object));
    return groups_[&node] = static_cast<std::uint32_t>(objects.size() - 1);
}

}  // namespace lightnet::mitsuba
