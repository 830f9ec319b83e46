// Many points of surfaces at once. Those of meshes are put into columns, and go through the formulas of one alone in
// loops without a branch.
#include "core/math/columns.hpp"
#include "core/scene/shading.hpp"
#include "core/scene/triangle.hpp"

#include <algorithm>
#include <cassert>

namespace lightnet {
namespace {

struct TriangleLanes {
    std::size_t count = 0;
    std::array<std::uint32_t, lanes> who;  // of the hits
    Columns3 a, b, c;                      // corners
    Column u, v, least_offset;
    Columns3 interpolated, towards;  // shading normals: there, and their sum over the corners; nothing: it has none
    Flags flip;

    Columns3 position, normal, shading_x, shading_y, shading_z;
    Column offset;

    void add(std::uint32_t hit, const Mesh& mesh, const SurfacePoint& point, float least) {
        const std::size_t to = count++;
        const auto [i, j, k] = mesh.triangles[point.primitive];
        who[to] = hit;
        a.set(to, mesh.positions[i]);
        b.set(to, mesh.positions[j]);
        c.set(to, mesh.positions[k]);
        u[to] = point.u;
        v[to] = point.v;
        least_offset[to] = least;
        if (mesh.normals.empty()) {
            interpolated.set(to, {});
            towards.set(to, {});
            flip[to] = mesh.flip_normals;
            return;
        }
        const Corners normals{mesh.normals[i], mesh.normals[j], mesh.normals[k]};
        interpolated.set(to, on_triangle(normals, point.u, point.v));
        towards.set(to, normals.a + normals.b + normals.c);
        flip[to] = 0;
    }

    // As Shading::on_mesh().
    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < count; ++i) {
            const Corners at{a[i], b[i], c[i]};
            const Vec3 p = on_triangle(at, u[i], v[i]), n = geometric_normal(at, towards[i], flip[i] != 0);
            const Frame frame = Frame::around(shading_normal(interpolated[i], n));
            position.set(i, p);
            normal.set(i, n);
            offset[i] = offset_at(p, least_offset[i]);
            shading_x.set(i, frame.x);
            shading_y.set(i, frame.y);
            shading_z.set(i, frame.z);
        }
    }
};

}  // namespace

void Shading::find(std::span<const Hit> hits, std::span<SurfacePoint> points) const {
    assert(hits.size() == points.size() && "each hit has its point");
    TriangleLanes many;
    for (std::size_t first = 0; first < hits.size(); first += lanes) {
        const std::size_t last = std::min(hits.size(), first + lanes);
        many.count = 0;
        for (std::size_t i = first; i < last; ++i) {
            const Hit& hit = hits[i];
            const auto* mesh = std::get_if<Mesh>(&data_.shapes[hit.geometry].geometry);
            if (!mesh) {
                find(hit.geometry, hit.primitive, hit.u, hit.v, points[i]);
                continue;
            }
            SurfacePoint& point = points[i];
            point.geometry = hit.geometry;
            point.primitive = hit.primitive;
            point.u = hit.u;
            point.v = hit.v;
            many.add(static_cast<std::uint32_t>(i), *mesh, point, needs_[hit.geometry].offset);
        }
        work_side_by_side(many);
        for (std::size_t lane = 0; lane < many.count; ++lane) {
            SurfacePoint& point = points[many.who[lane]];
            point.position = many.position[lane];
            point.normal = many.normal[lane];
            point.offset = many.offset[lane];
            point.shading = {many.shading_x[lane], many.shading_y[lane], many.shading_z[lane]};
            const Needs& needs = needs_[point.geometry];
            if (needs.material.texture || needs.material.tangent)
                dress(std::get<Mesh>(data_.shapes[point.geometry].geometry), needs, point);
        }
    }
}

}  // namespace lightnet
