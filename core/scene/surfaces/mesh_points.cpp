#include "core/scene/surfaces/mesh_points.hpp"

#include "core/scene/surfaces/shading.hpp"

namespace lightnet {

// As Shading::on_mesh().
struct MeshPoints::Places {
    MeshPoints& all;

    [[gnu::always_inline]] void work() {
        for (std::size_t i = 0; i < all.count_; ++i) {
            const Corners at{all.a_[i], all.b_[i], all.c_[i]};
            const Vec3 p = on_triangle(at, all.u_[i], all.v_[i]);
            const Vec3 n = geometric_normal(at, all.towards_[i], all.flip_[i] != 0);
            all.position_.set(i, p);
            all.normal_.set(i, n);
            all.offset_[i] = triangle_offset_at(all.turned_[i], p, n, all.least_offset_[i]);
            all.shading_.set(i, shading_normal(all.interpolated_[i], n));
        }
    }
};

void MeshPoints::find_places() {
    Places places{*this};
    work_in_lanes(places);
    if (apart_count_ > 0) find_apart();
}

// What is read of pictures is fetched for all before it is read for the first.
void MeshPoints::find_apart() {
    std::array<SurfacePoint, lanes> points;
    for (std::size_t k = 0; k < apart_count_; ++k) {
        const Hit& hit = hits_[apart_[k]];
        const Shading& shading = *shapes_[apart_[k]]->shading;
        shading.find(hit, points[k]);
        shading.expect_pictures(hit.geometry, points[k].uv);
    }
    for (std::size_t k = 0; k < apart_count_; ++k) {
        const std::uint32_t i = apart_[k];
        position_.set(i, points[k].position);
        normal_.set(i, points[k].normal);
        offset_[i] = points[k].offset;
        smooth_.set(i, points[k].shading.z);
        shading_.set(i, shapes_[i]->shading->bumpy_normal(points[k]));
    }
}

SurfacePoint MeshPoints::point(std::size_t i) const {
    SurfacePoint point;
    point.position = position_[i];
    point.normal = normal_[i];
    point.shading = Frame::around(shapes_[i]->bumpy ? smooth_[i] : shading_[i]);
    point.offset = offset_[i];
    point.geometry = hits_[i].geometry;
    point.primitive = hits_[i].primitive;
    point.u = u_[i];
    point.v = v_[i];
    point.time = hits_[i].time;
    return point;
}

}  // namespace lightnet
