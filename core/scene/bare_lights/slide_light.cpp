#include "core/scene/bare_lights/slide_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/base/math/sampling.hpp"
#include "core/base/shared_work.hpp"

namespace lightnet {
namespace {

Vec3 column_of(const Matrix& matrix, int j) {
    return normalize(Vec3{float(matrix.m[0][j]), float(matrix.m[1][j]), float(matrix.m[2][j])});
}

/// What a direction through that place of the plane at distance 1 makes with the axis.
float cosine_at(Vec2 plane) { return 1 / std::sqrt(1 + plane.x * plane.x + plane.y * plane.y); }

/// The first of running shares that `u` is below, and where in its share it lies.
std::pair<std::size_t, float> piece_of(const float* running, std::size_t count, float u) {
    const std::size_t at = std::min<std::size_t>(std::upper_bound(running, running + count, u) - running, count - 1);
    const float start = at > 0 ? running[at - 1] : 0, share = running[at] - start;
    return {at, share > 0 ? std::clamp((u - start) / share, 0.0f, 1.0f) : 0.5f};
}

}  // namespace

SlideLight::SlideLight(const SpotLight& spot)
    : position(spot.position),
      label(spot.label),
      spot_(spot),
      slide_(*spot.slide),
      x_(column_of(slide_.to_world, 0)),
      y_(column_of(slide_.to_world, 1)),
      z_(column_of(slide_.to_world, 2)) {
    if (!slide_.image || slide_.image->empty()) return;
    using Picture = std::tuple<const Image*, float, float, bool, float, float, SpotLight::Falloff>;
    static SharedWork<Picture, Weights> all;
    weights_ = all.get({slide_.image.get(), slide_.half_width, slide_.half_height, slide_.even_on_planes, spot.inner,
                        spot.outer, spot.falloff},
                       [&] { return std::make_shared<const Weights>(weigh()); });
}

Vec3 SlideLight::local(Vec3 direction) const { return {dot(direction, x_), dot(direction, y_), dot(direction, z_)}; }

Vec2 SlideLight::plane_of(double column, double row) const {
    return {float((2 * column / slide_.image->width - 1) * slide_.half_width),
            float((2 * row / slide_.image->height - 1) * slide_.half_height)};
}

Rgb SlideLight::passed(Vec2 plane) const {
    const Image& image = *slide_.image;
    const float u = 0.5f + plane.x / (2 * slide_.half_width), v = 0.5f + plane.y / (2 * slide_.half_height);
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return {};
    const float cosine = cosine_at(plane);
    float strength = spot_.share_at(cosine);
    if (strength == 0) return {};
    if (slide_.even_on_planes) strength /= cosine * cosine * cosine;
    const auto along = [](float at, std::uint32_t size) {
        const float pixel = std::clamp(at * float(size) - 0.5f, 0.0f, float(size - 1));
        const auto first = std::uint32_t(pixel);
        return std::tuple(first, std::min(first + 1, size - 1), pixel - float(first));
    };
    const auto [left, right, dx] = along(u, image.width);
    const auto [above, below, dy] = along(v, image.height);
    return image.square(left, right, above, below).bilinear(dx, dy) * strength;
}

Rgb SlideLight::towards(Vec3 direction) const {
    const Vec3 d = local(direction);
    if (!(d.z > 0) || !weights_ || weights_->rows.empty()) return {};
    return spot_.intensity * passed({d.x / d.z, d.y / d.z});
}

std::optional<LightSample> SlideLight::from(Vec3 at) const {
    const Vec3 way = at - position;
    if (!(length_squared(way) > 0)) return {};
    return from_point(position, towards(normalize(way)), at);
}

/// Each pixel by how bright it and those around it are, as the slide is looked up bilinearly.
SlideLight::Weights SlideLight::weigh() const {
    Weights weights{slide_.image, {}, {}, {}};
    const Image& image = *slide_.image;
    const std::size_t wide = image.width, high = image.height;
    const double area = 4.0 * slide_.half_width * slide_.half_height / double(wide) / double(high);
    std::vector<float> own(wide * high);
    double red = 0, green = 0, blue = 0;
    for (std::size_t y = 0; y < high; ++y)
        for (std::size_t x = 0; x < wide; ++x) {
            const Vec2 plane = plane_of(double(x) + 0.5, double(y) + 0.5);
            const float cosine = cosine_at(plane);
            const double solid_angle = area * double{cosine} * double{cosine} * double{cosine};
            const Rgb sent = passed(plane);
            red += sent.r * solid_angle, green += sent.g * solid_angle, blue += sent.b * solid_angle;
            const float evened = slide_.even_on_planes ? 1 : cosine * cosine * cosine;
            own[y * wide + x] = luminance(image.colour(std::uint32_t(x), std::uint32_t(y))) * evened;
        }
    weights.power = {float(red), float(green), float(blue)};
    auto &rows = weights.rows, &columns = weights.columns;
    rows.assign(high, 0), columns.assign(wide * high, 0);
    double all = 0;
    for (std::size_t y = 0; y < high; ++y) {
        double row = 0;
        for (std::size_t x = 0; x < wide; ++x) {
            for (std::size_t j = y > 0 ? y - 1 : 0; j < std::min(y + 2, high); ++j)
                for (std::size_t i = x > 0 ? x - 1 : 0; i < std::min(x + 2, wide); ++i)
                    row += double(std::max(0.0f, own[j * wide + i])) / 9;
            columns[y * wide + x] = float(row);
        }
        if (row > 0)
            for (std::size_t x = 0; x < wide; ++x) columns[y * wide + x] /= float(row);
        all += row;
        rows[y] = float(all);
    }
    if (all > 0)
        for (float& row : rows) row /= float(all);
    else
        rows.clear();
    return weights;
}

Emission SlideLight::emission(Vec2 u) const {
    if (!weights_ || weights_->rows.empty()) return {position, z_, {}};
    const auto& rows = weights_->rows;
    const std::size_t wide = slide_.image->width, high = slide_.image->height;
    const auto [row, down] = piece_of(rows.data(), high, u.y);
    const float* columns = &weights_->columns[row * wide];
    const auto [column, right] = piece_of(columns, wide, u.x);
    const Vec2 plane = plane_of(double(column) + double{right}, double(row) + double{down});
    const float cosine = cosine_at(plane);
    const float chance =
        (rows[row] - (row > 0 ? rows[row - 1] : 0)) * (columns[column] - (column > 0 ? columns[column - 1] : 0));
    const float area = 4 * slide_.half_width * slide_.half_height / (float(wide) * float(high));
    const Vec3 direction = normalize(x_ * plane.x + y_ * plane.y + z_);
    return {position, direction,
            chance > 0 ? spot_.intensity * passed(plane) * (area * cosine * cosine * cosine / chance) : Rgb{}};
}

LightBounds SlideLight::bounds() const {
    const float corner = std::atan(std::hypot(slide_.half_width, slide_.half_height));
    const float widest = std::min(corner, std::max(spot_.inner, spot_.outer));
    const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(double{widest}));
    return {position, position, z_, std::cos(widest), std::cos(1e-3f), luminance(power()) / float(solid_angle), false};
}

}  // namespace lightnet
