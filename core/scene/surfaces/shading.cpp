#include "core/scene/surfaces/shading.hpp"

#include "core/base/math/octahedral.hpp"
#include "core/base/math/random.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/shapes/ball.hpp"
#include "core/scene/surfaces/bumps.hpp"
#include "core/scene/surfaces/fetch_ahead.hpp"
#include "core/scene/surfaces/triangle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lightnet {
namespace {

// A ray that leaves one triangle may pass close above all others of the mesh.
float longest_edge(const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& positions) {
    float square = 0;
    for (const auto& [a, b, c] : triangles) {
        const Corners at{positions[a], positions[b], positions[c]};
        const Vec3 ab = at.b - at.a, bc = at.c - at.b, ca = at.a - at.c;
        square = std::max({square, length_squared(ab), length_squared(bc), length_squared(ca)});
    }
    return std::sqrt(square);
}

// What a shape's size rounds, wherever it stands.
float least_offset(const Mesh* mesh) { return triangle_offset(longest_edge(mesh->triangles, mesh->positions)); }
float least_offset(const Sphere* sphere) { return ball_offset(sphere->radius); }
float least_offset(const PlacedQuadric&) { return 0; }  // it has one for each point
float least_offset(const Curves*) { return 0; }         // the same

float least_offset(const PlacedShape& shape) {
    return std::visit([](const auto& one) { return least_offset(one); }, shape);
}

/// By triangle: its turned_offset(). None: no more than `least`, all of them.
std::vector<float> turned_offsets(const Shape& shape, float least) {
    const auto* mesh = std::get_if<Mesh>(&shape.geometry);
    if (!mesh) return {};
    std::vector<float> turned(mesh->triangles.size());
    bool more = false;
    for (std::uint32_t t = 0; t < turned.size(); ++t) {
        turned[t] = turned_offset(corners(*mesh, t));
        more |= !(turned[t] <= least);
    }
    return more ? turned : std::vector<float>{};
}

struct Along {
    Vec3 u, v;  // ∂position/∂u and ∂position/∂v
};

// Without texture coordinates they are those that pbrt assumes.
Along along_triangle(const Corners& t, Vec2 a, Vec2 b, Vec2 c) {
    const float du1 = a.x - c.x, du2 = b.x - c.x, dv1 = a.y - c.y, dv2 = b.y - c.y;
    const float determinant = du1 * dv2 - dv1 * du2;
    if (std::fabs(determinant) < 1e-12f) return {};
    const Vec3 p1 = t.a - t.c, p2 = t.b - t.c;
    return {(p1 * dv2 - p2 * dv1) / determinant, (p2 * du1 - p1 * du2) / determinant};
}

// Texture coordinates of a triangle's corners.
std::array<Vec2, 3> uvs_of(const Mesh& mesh, std::uint32_t triangle) {
    if (mesh.uvs.empty()) return {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}};
    const auto [i, j, k] = mesh.triangles[triangle];
    return {mesh.uvs[i], mesh.uvs[j], mesh.uvs[k]};
}

Vec3 axis_of(const Sphere& sphere, std::size_t i) {
    const auto& m = sphere.to_world.m;  // the columns of the rotation are the sphere's own axes
    return normalize({float(m[0][i]), float(m[1][i]), float(m[2][i])});
}

// By the mesh's own tangents; z: the shading normal.
Along along_tangents(const Mesh& mesh, std::uint32_t triangle, Vec2 at, Vec3 z) {
    const auto [i, j, k] = mesh.triangles[triangle];
    const auto &a = mesh.tangents[i], &b = mesh.tangents[j], &c = mesh.tangents[k];
    const Vec3 u = between_corners({a.along, b.along, c.along}, at.x, at.y);
    return {u, cross(z, u) * a.hand};
}

// By longitude and latitude, from pole to pole.
struct OnSphere {
    Vec2 uv;
    Along along;
};
OnSphere laid_on(const Sphere& sphere, Vec3 outwards) {
    const Vec3 x = axis_of(sphere, 0), y = axis_of(sphere, 1), z = axis_of(sphere, 2);
    const Vec3 own{dot(x, outwards), dot(y, outwards), dot(z, outwards)};
    float turn = std::atan2(own.y, own.x);
    if (turn < 0) turn += 2 * pi;
    const Vec3 around = (y * own.x - x * own.y) * (2 * pi * sphere.radius);
    const float width = std::sqrt(own.x * own.x + own.y * own.y);
    const Vec3 outside = width > 0 ? (x * own.x + y * own.y) / width : x;
    return {{turn / (2 * pi), 1 - std::acos(std::clamp(own.z, -1.0f, 1.0f)) / pi},
            {around, (z * width - outside * own.z) * (pi * sphere.radius)}};
}

TexturePlace coordinates_on(const Mesh* mesh, std::uint32_t primitive, Vec2 at) {
    const auto [a, b, c] = uvs_of(*mesh, primitive);
    const float u = at.x, v = at.y, w = 1 - u - v;
    TexturePlace place{a * w + b * u + c * v, {1, 1, 1}};
    if (!mesh->values.empty()) place.vertices = between_vertices(*mesh, primitive, u, v);
    if (mesh->colours.empty()) return place;
    const auto [i, j, k] = mesh->triangles[primitive];
    place.vertex_colour = mesh->colours[i] * w + mesh->colours[j] * u + mesh->colours[k] * v;
    return place;
}
TexturePlace coordinates_on(const Sphere* sphere, std::uint32_t, Vec2 at) {
    return {laid_on(*sphere, from_octahedral(at)).uv, {1, 1, 1}};
}
TexturePlace coordinates_on(const PlacedQuadric& quadric, std::uint32_t, Vec2 at) {
    return {quadric.uv(quadric.own_point(at)), {1, 1, 1}};
}

Vec2 uv_on(const Curves& curves, std::uint32_t segment, Vec2 at) {
    const auto [start, size] = curves.share(segment);
    return {start + at.x * size, (at.y + 2) / 4};
}
TexturePlace coordinates_on(const Curves* curves, std::uint32_t primitive, Vec2 at) {
    return {uv_on(*curves, primitive, at), {1, 1, 1}};
}

}  // namespace

BetweenVertices between_vertices(const Mesh& mesh, std::uint32_t triangle, float u, float v) {
    return {&mesh.values, mesh.triangles[triangle], u, v};
}

Shading::Shading(const SceneData& data, const Shading* before) : data_(data), materials_(data) {
    for (const auto& instance : data.instances) placements_.emplace_back(instance.to_world);
    placed_.reserve(data.shapes.size());
    for (const auto& shape : data.shapes) {
        placed_.push_back(lightnet::placed(shape.geometry));
        const Needs* known = before ? &before->needs_[needs_.size()] : nullptr;
        needs_.push_back({materials_.needs(shape.material), known ? known->offset : least_offset(placed_.back()),
                          std::get_if<Mesh>(&shape.geometry), materials_.lobes(shape.material)});
        needs_.back().turned = known ? known->turned : turned_offsets(shape, needs_.back().offset);
        needs_.back().material.texture |= shape.emission && shape.emission->texture;
        const auto by_place = [&](const std::optional<TextureId>& texture) {
            return texture && depends_on_place(data.textures, *texture);
        };
        needs_.back().place =
            by_place(data.materials[shape.material].opacity) || (shape.emission && by_place(shape.emission->texture));
        column_shapes_.push_back(column_shape(shape, needs_.back()));
        column_shapes_.back().pane = is_pane(data.materials[shape.material]);
    }
    take_motion();
}

// What moves is worked out point by point.
void Shading::take_motion() {
    for (const auto& [which, later] : data_.motion.shapes) {
        const MovingShape& moving = moving_.emplace_back(data_.shapes[which].geometry, later);
        Needs& needs = needs_[which];
        needs.moving = std::uint32_t(moving_.size() - 1);
        column_shapes_[which].kind = ColumnShape::Kind::none;
        for (std::size_t step = 0; needs.mesh && step < moving.steps(); ++step) {
            const auto& positions = std::get<Mesh>(moving.at_step(step)).positions;
            needs.offset = std::max(needs.offset, triangle_offset(longest_edge(needs.mesh->triangles, positions)));
        }
        for (const auto& state : later)
            if (const auto* ball = std::get_if<Sphere>(&state))
                needs.offset = std::max(needs.offset, ball_offset(ball->radius));
        needs.offset += moving.rounding();
    }
    if (data_.motion.instances.empty()) return;
    moved_instances_.resize(placements_.size(), none);
    for (const auto& [which, later] : data_.motion.instances) {
        moved_instances_[which] = std::uint32_t(moved_placements_.size());
        auto& places = moved_placements_.emplace_back();
        for (const Matrix& to_world : later) places.emplace_back(to_world);
    }
}

std::span<const Placement> Shading::later_placements(std::uint32_t instance) const {
    if (moved_instances_.empty() || moved_instances_[instance] == none) return {};
    return moved_placements_[moved_instances_[instance]];
}

Placement Shading::placement(const Hit& hit) const {
    const auto later = later_placements(hit.instance);
    const Placement& first = placements_[hit.instance];
    if (later.empty()) return first;
    const StepPlace place(later.size() + 1, hit.time);
    return {place.step == 0 ? first : later[place.step - 1], later[place.step], place.part};
}

ColumnShape Shading::column_shape(const Shape& shape, const Needs& needs) const {
    const auto kind = needs.mesh ? materials_.column_kind(shape.material) : ColumnShape::Kind::none;
    if (kind == ColumnShape::Kind::none) return {};
    const Bsdf::Model* model = materials_.constant_model(shape.material);
    const auto* diffuse = model ? std::get_if<DiffuseBsdf>(model) : nullptr;
    const auto lobes = static_cast<std::uint8_t>((needs.lobes ? needs.lobes : lobe::all) & lobe::rough);
    ColumnShape made{kind,
                     needs.mesh,
                     diffuse ? diffuse->albedo : Rgb{},
                     model,
                     this,
                     needs.offset,
                     needs.turned.empty() ? nullptr : needs.turned.data(),
                     lobes};
    made.one_sided = data_.materials[shape.material].one_sided;
    made.bumpy = materials_.bumpy(shape.material);
    made.shines = shape.emission.has_value();
    return made;
}

void Shading::find(std::uint32_t geometry, std::uint32_t primitive, float u, float v, SurfacePoint& point) const {
    point.geometry = geometry;
    point.primitive = primitive;
    point.u = u;
    point.v = v;
    point.mesh = nullptr;
    const Needs& needs = needs_[geometry];
    if (needs.moving != none) return find_moving(moving_[needs.moving], needs, point);
    if (needs.mesh) return find_on(needs.mesh, needs, point);  // first, as nearly all are
    std::visit([&](const auto& shape) { find_on(shape, needs, point); }, placed_[geometry]);
}

void Shading::find(const Hit& hit, SurfacePoint& point) const {
    point.time = hit.time;
    find(hit.geometry, hit.primitive, hit.u, hit.v, point);
    if (hit.instance == Query::no_instance) return;
    const bool moves = !later_placements(hit.instance).empty();
    point = moves ? placement(hit).place(point) : placements_[hit.instance].place(point);
    if (needs_[hit.geometry].material.grooves) point.shading = frame_along(point.shading.z, point.along_u);
}

Vec3 Shading::bumpy_normal(const SurfacePoint& point) const {
    const MaterialId material = data_.shapes[point.geometry].material;
    return materials_.bumpy(material) ? materials_.bumpy_normal(material, point) : point.shading.z;
}

void Shading::expect(std::span<const std::optional<Hit>> hits) const {
    const auto each_triangle = [&](const auto& fetch) {
        for (const auto& hit : hits)
            if (hit)
                if (const Mesh* mesh = needs_[hit->geometry].mesh) fetch(*mesh, hit->primitive);
    };
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_triangle(mesh, triangle); });
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_corners(mesh, triangle); });
}

void Shading::find_on(const Mesh* on, const Needs& needs, SurfacePoint& point) const {
    const Mesh& mesh = *on;
    Standing triangle{corners(mesh, point.primitive), {}, needs.turned.empty() ? 0 : needs.turned[point.primitive]};
    if (!mesh.normals.empty()) {
        const auto [i, j, k] = mesh.triangles[point.primitive];
        triangle.normals = {mesh.normals[i], mesh.normals[j], mesh.normals[k]};
    }
    find_on(mesh, triangle, needs, point);
}

void Shading::find_moving(const MovingShape& shape, const Needs& needs, SurfacePoint& point) const {
    if (needs.mesh) {
        const Corners at = shape.corners(point.primitive, point.time);
        const Standing triangle{at, shape.normals(point.primitive, point.time), turned_offset(at)};
        return find_on(*needs.mesh, triangle, needs, point);
    }
    shape.placed(part_of_shutter(point.time), [&](const auto& placed) { find_on(placed, needs, point); });
    if (std::holds_alternative<Quadric>(shape.at_step(0))) point.offset += needs.offset;
}

void Shading::find_on(const Mesh& mesh, const Standing& triangle, const Needs& needs, SurfacePoint& point) const {
    const auto& [at, normals, turned] = triangle;
    point.position = on_triangle(at, point.u, point.v);
    point.normal = mesh.normals.empty() ? geometric_normal(at, {}, mesh.flip_normals)
                                        : geometric_normal(at, normals.a + normals.b + normals.c, false);
    point.offset = triangle_offset_at(turned, point.position, point.normal, needs.offset);
    const Vec3 interpolated = mesh.normals.empty() ? Vec3{} : between_corners(normals, point.u, point.v);
    point.shading = Frame::around(shading_normal(interpolated, point.normal));
    dress(mesh, at, needs, point);
}

void Shading::dress(const Mesh& mesh, const Corners& at, const Needs& needs, SurfacePoint& point) const {
    const auto& [texture, tangent, grooves, holes] = needs.material;
    if (!texture && !tangent) return;
    const auto [a, b, c] = uvs_of(mesh, point.primitive);
    const float u = point.u, v = point.v, w = 1 - u - v;
    point.uv = a * w + b * u + c * v;
    if (!mesh.values.empty()) point.mesh = &mesh;
    point.vertex_colour = {1, 1, 1};
    if (!mesh.colours.empty()) {
        const auto [i, j, k] = mesh.triangles[point.primitive];
        point.vertex_colour = mesh.colours[i] * w + mesh.colours[j] * u + mesh.colours[k] * v;
    }
    if (!tangent) return;
    const auto along = mesh.tangents.empty() ? along_triangle(at, a, b, c)
                                             : along_tangents(mesh, point.primitive, {u, v}, point.shading.z);
    point.along_u = along.u;
    point.along_v = along.v;
    if (grooves) point.shading = frame_along(point.shading.z, along.u);
}

void Shading::find_on(const Sphere* on, const Needs& needs, SurfacePoint& point) const {
    const Sphere& sphere = *on;
    const Vec3 outwards = from_octahedral({point.u, point.v});
    point.position = on_ball(sphere.center, sphere.radius, outwards);
    point.normal = sphere.flip_normals ? -outwards : outwards;
    point.offset = offset_at(point.position, outwards, needs.offset);
    point.shading = Frame::around(point.normal);
    if (!needs.material.texture && !needs.material.tangent) return;
    const auto [uv, along] = laid_on(sphere, outwards);
    point.uv = uv;
    point.vertex_colour = {1, 1, 1};
    if (!needs.material.tangent) return;
    point.along_u = along.u;
    point.along_v = along.v;
    if (needs.material.grooves) point.shading = frame_along(point.normal, along.u);
}

void Shading::find_on(const PlacedQuadric& quadric, const Needs& needs, SurfacePoint& point) const {
    const Vec3 own = quadric.own_point({point.u, point.v});
    point.position = quadric.position(own);
    point.normal = quadric.normal(own);
    point.offset = offset_at(point.position, point.normal, quadric.own_offset(own, point.normal));
    point.shading = Frame::around(point.normal);
    if (!needs.material.texture && !needs.material.tangent) return;
    point.uv = quadric.uv(own);
    point.vertex_colour = {1, 1, 1};
    if (!needs.material.tangent) return;
    const auto [along_u, along_v] = quadric.along(own);
    point.along_u = along_u;
    point.along_v = along_v;
    if (needs.material.grooves) point.shading = frame_along(point.normal, along_u);
}

// Embree's points lie on the circle nearly: how nearly goes with the radius.
void Shading::find_on(const Curves* curves, const Needs& needs, SurfacePoint& point) const {
    constexpr float nearly = 0x1p-10f;
    const OnCurve middle = curves->at(point.primitive, point.u);
    const CurveSurface at = surface_of(middle, point.v);
    point.position = at.position;
    point.normal = at.normal;
    point.offset = offset_at(point.position, point.normal, nearly * middle.radius);
    point.shading = Frame::around(point.normal);
    if (!needs.material.texture && !needs.material.tangent) return;
    point.uv = uv_on(*curves, point.primitive, {point.u, point.v});
    point.vertex_colour = {1, 1, 1};
    if (!needs.material.tangent) return;
    point.along_u = at.along / curves->share(point.primitive).size;
    point.along_v = at.around;
    if (needs.material.grooves) point.shading = frame_along(point.normal, point.along_u);
}

TexturePlace Shading::place(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    if (needs_[geometry].place) return place_of(point(geometry, primitive, u, v));
    return coordinates(geometry, primitive, u, v);
}

TexturePlace Shading::coordinates(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    return std::visit([&](const auto& shape) { return coordinates_on(shape, primitive, {u, v}); }, placed_[geometry]);
}

float Shading::opacity_at(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    return materials_.opacity(data_.shapes[geometry].material, place(geometry, primitive, u, v));
}

// DECISIONS: masks-by-hash
bool Shading::is_there(std::uint32_t geometry, std::uint32_t primitive, float u, float v) const {
    const float opacity = opacity_at(geometry, primitive, u, v);
    if (opacity >= 1) return true;
    if (opacity <= 0) return false;
    const Key surface = child(child(0, geometry), primitive);
    const Key here =
        child(surface, std::uint64_t{std::bit_cast<std::uint32_t>(u)} << 32 | std::bit_cast<std::uint32_t>(v));
    return float(here >> 40) * 0x1p-24f < opacity;
}

void Shading::add_bsdfs(std::span<const SurfacePoint> points, std::vector<Bsdf>& to) const {
    for (const SurfacePoint& point : points) expect_pictures(point.geometry, point.uv);
    for (const SurfacePoint& point : points) materials_.add_bsdf(data_.shapes[point.geometry].material, point, to);
}

Bsdf Shading::bsdf(const SurfacePoint& point) const {
    return materials_.bsdf(data_.shapes[point.geometry].material, point);
}

}  // namespace lightnet
