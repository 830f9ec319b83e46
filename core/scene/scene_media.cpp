#include "core/scene/scene_media.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/math/box.hpp"
#include "core/base/math/sampling.hpp"
#include "core/scene/geometry/geometry.hpp"
#include "core/scene/media/stretches.hpp"
#include "core/scene/surfaces/shading.hpp"

namespace lightnet {
namespace {

bool parts_media(const Shape& shape) { return shape.media && shape.media->inside != shape.media->outside; }

// The shapes that part media, as if they were of paper: without the holes through which rays go else.
SceneData borders_of(const SceneData& data) {
    SceneData borders;
    std::vector<std::uint32_t> number(data.shapes.size());
    borders.textures.push_back({});
    borders.materials.push_back({"", DiffuseMaterial{0, 0, std::nullopt}});
    for (std::size_t s = 0; s < data.shapes.size(); ++s) {
        const Shape& shape = data.shapes[s];
        if (!parts_media(shape)) continue;
        number[s] = static_cast<std::uint32_t>(borders.shapes.size());
        borders.shapes.push_back({shape.geometry, 0, std::nullopt, shape.where, shape.name, shape.media});
    }
    for (const Object& object : data.objects) {
        Object& part = borders.objects.emplace_back(Object{object.name, {}});
        for (const auto shape : object.shapes)
            if (parts_media(data.shapes[shape])) part.shapes.push_back(number[shape]);
    }
    borders.instances = data.instances;
    borders.motion.instances = data.motion.instances;
    for (const auto& [which, later] : data.motion.shapes)
        if (parts_media(data.shapes[which])) borders.motion.shapes.push_back({number[which], later});
    return borders;
}

Error unusable(const SourceLine& where, const std::string& what) { return Error("scene", to_string({where, what})); }

void check_media(const SceneData& data) {
    const auto is_there = [&](std::uint16_t medium) {
        return medium == Query::no_medium || medium < data.media.size();
    };
    if (data.media.size() >= Query::no_medium) throw Error("scene", "there are more than 65,534 media");
    for (const Medium& medium : data.media)
        if (const auto fault = medium.fault(); !fault.empty()) throw unusable(medium.where, fault);
    if (!is_there(data.around)) throw Error("scene", "it lies in a medium that isn't there");
    for (const Shape& shape : data.shapes)
        if (shape.media && (!is_there(shape.media->inside) || !is_there(shape.media->outside)))
            throw unusable(shape.where, "names a medium that isn't there");
}

// Around what each medium fills.
std::vector<Box> boxes_of_media(const SceneData& data) {
    constexpr float far_around = 3;
    std::vector<Box> boxes(data.media.size());
    const auto shines = [&](std::uint16_t medium) {
        return medium != Query::no_medium && !is_black(data.media[medium].emission.value);
    };
    if (!std::ranges::any_of(data.media, [](const Medium& one) { return !is_black(one.emission.value); })) return boxes;
    Box all;
    const auto add = [&](const Shape& shape, const Matrix& to_world) {
        if (shines(data.around)) add_to(all, shape.geometry, to_world);
        if (!parts_media(shape)) return;
        for (const auto side : {shape.media->inside, shape.media->outside})
            if (shines(side)) add_to(boxes[side], shape.geometry, to_world);
    };
    for (const Shape& shape : data.shapes) add(shape, Matrix{});
    for (const Instance& instance : data.instances)
        for (const auto shape : data.objects[instance.object].shapes) add(data.shapes[shape], instance.to_world);
    if (shines(data.around) && !all.empty()) {
        const float radius = far_around * length(all.size()) / 2;
        const Vec3 reach{radius, radius, radius};
        boxes[data.around] = {all.center() - reach, all.center() + reach};
    }
    return boxes;
}

}  // namespace

struct Media::Borders {
    Borders(const SceneData& whole, const std::string& isa, std::uint32_t threads)
        : data(borders_of(whole)), shading(data), geometry(data, shading, {isa, threads}) {}

    SceneData data;
    Shading shading;
    Geometry geometry;
};

Media::Media(const SceneData& data, const std::string& isa, std::uint32_t build_threads) : data_(data) {
    check_media(data);
    const bool parted = std::any_of(data.shapes.begin(), data.shapes.end(), parts_media);
    if (parted) borders_ = std::make_unique<const Borders>(data, isa, build_threads);
    any_ = parted || data.around != Query::no_medium;
    for (const Medium& medium : data.media)
        bounds_.push_back(medium.extinction.grid ? CollisionBounds(medium.extinction) : CollisionBounds());
    glow_ = Glow(data.media, boxes_of_media(data));
}

Media::~Media() = default;

// DECISIONS: media-by-next-border
// take(stretch) of each that lies in a medium, in order, until it says false.
template <class Take>
void Media::each_stretch(const Ray& ray, Take&& take) const {
    constexpr int most_borders = 1 << 16;
    std::uint16_t beyond = data_.around;
    Vec3 origin = ray.origin;
    float begin = 0;
    for (int i = 0; i < most_borders; ++i) {
        const auto hit =
            borders_ ? borders_->geometry.intersect({origin, ray.direction, Ray().far, ray.time}) : std::nullopt;
        std::uint16_t here = beyond;
        float end = ray.far;
        if (hit) {
            const SurfacePoint point = [&] {
                SurfacePoint found;
                borders_->shading.find(*hit, found);
                return found;
            }();
            const MediumSides& sides = *borders_->data.shapes[hit->geometry].media;
            const bool enters = dot(ray.direction, point.normal) < 0;
            here = enters ? sides.outside : sides.inside;
            beyond = enters ? sides.inside : sides.outside;
            end = begin + hit->distance;
            origin = point.origin_towards(ray.direction);
        }
        const Stretch way{begin, std::min(end, ray.far), here};
        if (here != Query::no_medium && way.end > way.begin && !take(way)) return;
        if (!hit || end >= ray.far) return;
        begin = std::max(end, dot(origin - ray.origin, ray.direction));
    }
}

Flight Media::fly(const Ray& ray, Rgb carried, Vec2 first) const {
    Flight flight;
    FlightNumbers numbers(ray, first);
    each_stretch(ray, [&](const Stretch& way) {
        const Medium& medium = data_.media[way.medium];
        if (medium.extinction.grid) return fly_uneven(medium, bounds_[way.medium], ray, way, carried, numbers, flight);
        return fly_even(medium, way, carried, numbers, flight);
    });
    return flight;
}

Rgb Media::transmittance(const Ray& ray, Vec2 first) const {
    Rgb light{1, 1, 1};
    FlightNumbers numbers(ray, first);
    each_stretch(ray, [&](const Stretch& way) {
        const Medium& medium = data_.media[way.medium];
        if (medium.extinction.grid) return let_through(medium, bounds_[way.medium], ray, way, numbers, light);
        light *= left_along(medium, way.end - way.begin);
        return !is_black(light);
    });
    return light;
}

// One place in each cell tells of its extinction: an error that has no direction, which that of an estimate of what is
// left of light would have.
void Media::cut_uneven(const Ray& ray, const Stretch& way, float longest, FlightNumbers& numbers,
                       std::vector<MediumPiece>& pieces) const {
    const Medium& medium = data_.media[way.medium];
    Stretch piece{};
    Rgb collisions;
    const auto finish = [&] {
        const bool scatters = !is_black(medium.albedo.value) && !is_black(collisions);
        if (piece.end > piece.begin)
            pieces.push_back({piece.begin, piece.end, collisions * (1 / (piece.end - piece.begin)), scatters});
        piece.begin = piece.end, collisions = {};
    };
    bounds_[way.medium].each_cell(ray, way.begin, way.end, [&](float begin, float end, float most) {
        if (piece.end == 0) piece.begin = begin;
        piece.end = end;
        const Vec3 place = ray.origin + ray.direction * (begin + (end - begin) * numbers.next());
        if (most > 0) collisions += medium.extinction.at(place) * (end - begin);
        if (piece.end - piece.begin >= longest) finish();
        return true;
    });
    finish();
}

void Media::cut(const Ray& ray, float longest, Vec2 first, std::vector<MediumPiece>& pieces) const {
    constexpr float most_pieces = 4096;
    FlightNumbers numbers(ray, first);
    each_stretch(ray, [&](const Stretch& way) {
        const Medium& medium = data_.media[way.medium];
        if (medium.extinction.grid) return cut_uneven(ray, way, longest, numbers, pieces), true;
        const float length = way.end - way.begin, count = std::clamp(std::ceil(length / longest), 1.0f, most_pieces);
        const bool scatters = !is_black(medium.albedo.value) && !is_black(medium.extinction.value);
        for (float i = 0; i < count; ++i)
            pieces.push_back({way.begin + length * (i / count), way.begin + length * ((i + 1) / count),
                              medium.extinction.value, scatters});
        return true;
    });
}

std::optional<Emission> Media::emit(float choice, Vec2 position_sample, Vec2 direction_sample, ShutterTime time) const {
    const auto spark = glow_.spark(choice, position_sample);
    if (!spark) return std::nullopt;
    const Vec3 direction = sphere(direction_sample);
    std::uint16_t here = Query::no_medium;
    each_stretch({spark->position, direction, Ray().far, time}, [&](const Stretch& way) {
        if (way.begin == 0) here = way.medium;
        return false;
    });
    if (here != spark->medium) return std::nullopt;
    // paths see no light where nothing could collide
    if (data_.media[here].extinction.grid && !(bounds_[here].most_at(spark->position) > 0)) return std::nullopt;
    return Emission{spark->position, direction, spark->flux};
}

SurfacePoint Media::point(Vec3 position, std::uint16_t medium) const {
    if (medium >= data_.media.size()) throw Error("scene", "a question names a medium that isn't there");
    SurfacePoint point;
    point.position = position;
    point.geometry = Query::in_space;
    point.primitive = medium;
    return point;
}

Bsdf Media::bsdf(const SurfacePoint& point) const {
    const Medium& medium = data_.media[point.primitive];
    return Bsdf(PhaseBsdf{&medium.phase, medium.albedo_at(point.position)});
}

std::size_t Media::memory() const {
    std::set<const VolumeGrid*> grids;
    for (const Medium& medium : data_.media)
        for (const auto* field : {&medium.extinction, &medium.albedo, &medium.emission})
            if (field->grid) grids.insert(field->grid.get());
    std::size_t bytes = borders_ ? borders_->geometry.memory() : 0;
    for (const VolumeGrid* grid : grids) bytes += grid->memory();
    return bytes;
}

}  // namespace lightnet
