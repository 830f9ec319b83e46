#include "core/scene/lamps/lamp_sources.hpp"

#include "core/base/math/box.hpp"
#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/lamps/lamp_kinds.hpp"
#include "core/scene/surfaces/fetch_ahead.hpp"
#include "core/scene/surfaces/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightnet {
namespace {

constexpr std::uint32_t few_facets = 4;  // that are chosen by area alone where they lie in one plane

inline Facet facet(const Corners& at, Vec3 normal) { return {at.a, at.b - at.a, at.c - at.a, normal}; }
inline Facet facet(const Mesh& mesh, std::uint32_t triangle) {
    const Corners at = corners(mesh, triangle);
    return facet(at, geometric_normal(mesh, triangle, at));
}
Facet facet(const MovingShape& moving, const Mesh& mesh, std::uint32_t triangle, ShutterTime time) {
    const Corners at = moving.corners(triangle, time), normals = moving.normals(triangle, time);
    return facet(at,
                 geometric_normal(at, normals.a + normals.b + normals.c, mesh.normals.empty() && mesh.flip_normals));
}
float area_of(const Facet& facet) { return area_of(Corners{{}, facet.first_edge, facet.second_edge}); }

bool is_lamp(const SceneData& data, const Shape& shape, GroupSet groups) {
    return shape.emission && (groups >> shape.emission->label.group & 1) && !is_black(shape.emission->radiance) &&
           !std::holds_alternative<NoMaterial>(data.materials[shape.material].model);
}

// Of two triangles that are its halves.
std::optional<Facet> parallelogram(const Facet& first, const Facet& second) {
    const auto corners_of = [](const Facet& f) {
        return std::array{f.corner, f.corner + f.first_edge, f.corner + f.second_edge};
    };
    const auto a = corners_of(first), b = corners_of(second);
    const float tolerance = 1e-5f * (length(first.first_edge) + length(first.second_edge));
    const auto near = [&](Vec3 p, Vec3 q) { return length(p - q) <= tolerance; };
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 p = a[(i + 1) % 3], q = a[(i + 2) % 3], r = b[(j + 1) % 3], s = b[(j + 2) % 3];
            const bool share_a_side = (near(p, r) && near(q, s)) || (near(p, s) && near(q, r));
            if (share_a_side && near(a[i] + b[j], p + q)) return Facet{a[i], p - a[i], q - a[i], first.normal};
        }
    return {};
}

}  // namespace

struct LampSources::Collecting {
    LampSources& to;
    const SceneData& data;
    bool apart;

    void add(std::uint32_t shape, const MovingShape& moving);
    void add(std::uint32_t shape, const Mesh* placed);
    template <class Placed>
    void add(std::uint32_t shape, const Placed& placed) {
        const auto [center, radius] = ball_around(placed);
        to.balls_.add(center, radius);
        add_source(shape, 1, 0);
    }
    void add_source(std::uint32_t shape, std::uint32_t lamps, std::uint32_t facets);
    float area(const LampSource& source) const;
};

LampSources::LampSources(const SceneData& data, const Shading& shading, GroupSet groups, bool apart)
    : shading_(shading), of_shapes_(data.shapes.size(), LampSource::none) {
    Collecting collecting{*this, data, apart};
    for (std::uint32_t s = 0; s < data.shapes.size(); ++s) {
        const Shape& shape = data.shapes[s];
        if (!is_lamp(data, shape, groups)) continue;
        if (const MovingShape* moving = shading.moving(s)) {
            collecting.add(s, *moving);
            continue;
        }
        std::visit([&](const auto& placed) { collecting.add(s, placed); }, shading.placed(s));
    }
}

// Of a mesh that moves each triangle is a lamp, as they may not stay in one plane.
void LampSources::Collecting::add(std::uint32_t shape, const MovingShape& moving) {
    const Box box = moving.bounds();
    to.balls_.add(box.center(), length(box.size()) / 2);
    const auto* mesh = std::get_if<Mesh>(&moving.at_step(0));
    add_source(shape, mesh ? std::uint32_t(mesh->triangles.size()) : 1, 0);
}

void LampSources::Collecting::add(std::uint32_t shape, const Mesh* placed) {
    const Mesh& mesh = *placed;
    const auto count = std::uint32_t(mesh.triangles.size());
    bool flat = true;
    Box box;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        flat = flat && count <= few_facets &&
               dot(geometric_normal(mesh, t, at), geometric_normal(mesh, 0, corners(mesh, 0))) > 0.9999f;
        for (const Vec3 p : {at.a, at.b, at.c}) box.add(p);
    }
    const Vec3 center = count ? box.center() : Vec3{};
    float radius2 = 0;
    for (std::uint32_t t = 0; t < count; ++t) {
        const Corners at = corners(mesh, t);
        for (const Vec3 p : {at.a, at.b, at.c}) radius2 = std::max(radius2, length_squared(p - center));
    }
    to.balls_.add(center, std::sqrt(radius2));
    if (!flat) return add_source(shape, count, 0);

    std::vector<double> areas;
    const std::size_t first = to.facets_.size();
    for (std::uint32_t t = 0; t < count; ++t) {
        to.facets_.push_back(facet(mesh, t));
        areas.push_back(double{area_of(to.facets_.back())});
    }
    to.ends_.resize(to.facets_.size(), 1);
    prefix_cdf(std::span<const double>(areas), std::span(to.ends_).subspan(first));
    if (count > 0) add_source(shape, 1, count);
}

// The last of the facets are its own.
void LampSources::Collecting::add_source(std::uint32_t shape, std::uint32_t lamps, std::uint32_t facets) {
    const AreaEmission& emission = *data.shapes[shape].emission;
    LampSource source;
    source.shape = shape;
    source.first_lamp = std::uint32_t(to.source_of_.size());
    source.by_triangle = facets == 0 && std::holds_alternative<const Mesh*>(to.shading_.placed(shape));
    source.first = std::uint32_t(to.facets_.size()) - facets;
    source.facets = facets;
    source.radiance = emission.radiance;
    source.two_sided = emission.two_sided;
    source.group = apart ? emission.label.group : 0;
    source.unseen = emission.unseen;
    source.uniform = !emission.texture && !to.shading_.has_holes(shape) && !emission.unseen;
    source.area = area(source);
    if (!std::isfinite(source.area)) source.area = 0;  // never chosen
    if (source.uniform && facets == 2)
        if (const auto whole = parallelogram(to.facets_[source.first], to.facets_[source.first + 1])) {
            source.whole = std::uint32_t(to.wholes_.size());
            to.wholes_.push_back(*whole);
        }
    to.of_shapes_[shape] = std::uint32_t(to.sources_.size());
    to.source_of_.resize(to.source_of_.size() + lamps, std::uint32_t(to.sources_.size()));
    to.sources_.push_back(source);
}

float LampSources::Collecting::area(const LampSource& source) const {
    return to.on_shape(AreaLamp{to, source, 0, 0, 0}, [&](const auto& placed) {
        if constexpr (std::is_same_v<std::decay_t<decltype(placed)>, const Mesh*>) {
            float area = 0;
            for (const Facet& facet : to.facets_of(source)) area += area_of(facet);
            return area;
        } else {
            return area_of(placed);
        }
    });
}

AreaLamp LampSources::lamp(std::size_t index, ShutterTime time) const {
    const LampSource& source = sources_[source_of_[index]];
    const MovingShape* moving = shading_.moving(source.shape);
    if (!source.by_triangle) {
        if (!moving || !std::holds_alternative<Sphere>(moving->at_step(0)))
            return {*this, source, 0, source.area, time};
        const Sphere ball = moving->sphere(part_of_shutter(time));
        return {*this, source, 0, area_of(&ball), time};
    }
    const auto triangle = std::uint32_t(index - source.first_lamp);
    const Corners at = moving ? moving->corners(triangle, time) : corners(mesh_of(source), triangle);
    const float area = area_of(at);
    return {*this, source, triangle, std::isfinite(area) ? area : 0, time};
}

std::optional<std::size_t> LampSources::lamp_at(const SurfacePoint& point) const {
    if (point.geometry >= of_shapes_.size() || of_shapes_[point.geometry] == LampSource::none) return {};
    const LampSource& source = sources_[of_shapes_[point.geometry]];
    return source.first_lamp + (source.by_triangle ? point.primitive : 0);
}

Facet LampSources::facet_of(const AreaLamp& lamp, std::uint32_t& primitive, float& u) const {
    const LampSource& source = lamp.source;
    primitive = lamp.triangle;
    if (const MovingShape* moving = source.by_triangle ? shading_.moving(source.shape) : nullptr)
        return facet(*moving, mesh_of(source), primitive, lamp.time);
    if (source.by_triangle) return facet(mesh_of(source), primitive);
    if (source.facets > 1) primitive = std::uint32_t(pick(std::span(ends_).subspan(source.first, source.facets), u));
    return facets_[source.first + primitive];
}

void LampSources::expect(std::span<const LightChoice> chosen) const {
    const auto each = [&](const auto& fetch) {
        for (const auto& [lamp, chance] : chosen)
            if (chance > 0 && lamp < size()) fetch(lamp);
    };
    const auto each_triangle = [&](const auto& fetch) {
        each([&](std::uint32_t lamp) {
            const LampSource& source = sources_[source_of_[lamp]];
            if (source.by_triangle) fetch(mesh_of(source), lamp - source.first_lamp);
        });
    };
    each([&](std::uint32_t lamp) { __builtin_prefetch(&source_of_[lamp]); });
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_triangle(mesh, triangle); });
    each_triangle([](const Mesh& mesh, std::uint32_t triangle) { fetch_corners(mesh, triangle); });
}

std::size_t LampSources::memory() const {
    return sources_.size() * sizeof(LampSource) + source_of_.size() * sizeof(std::uint32_t) +
           facets_.size() * sizeof(Facet) + ends_.size() * sizeof(float) + wholes_.size() * sizeof(Facet) +
           of_shapes_.size() * sizeof(std::uint32_t);
}

}  // namespace lightnet
