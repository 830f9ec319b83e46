#include "core/scene/bare_lights/environment_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/math/sampling.hpp"
#include "core/base/shared_work.hpp"

namespace lightnet {
namespace {

constexpr float greatest_half = 65504;  // what an infinite number in a picture stands for

float usable(float c) {
    if (!(c > 0)) return 0;  // not a number either
    return std::isinf(c) ? greatest_half : c;
}

// The picture's neighbours beyond its borders.
void wrap(std::int64_t& x, std::int64_t& y, std::int64_t width, std::int64_t height, EnvironmentData::Layout layout) {
    if (layout == EnvironmentData::Layout::latitude_longitude) {
        x = (x % width + width) % width;
        y = std::clamp<std::int64_t>(y, 0, height - 1);
        return;
    }
    // Beyond an edge of the square lies the same edge, the other way round.
    if (x < 0 || x >= width) {
        x = x < 0 ? -1 - x : 2 * width - 1 - x;
        y = height - 1 - y;
    }
    if (y < 0 || y >= height) {
        y = y < 0 ? -1 - y : 2 * height - 1 - y;
        x = width - 1 - x;
    }
    x = std::clamp<std::int64_t>(x, 0, width - 1);
    y = std::clamp<std::int64_t>(y, 0, height - 1);
}

}  // namespace

EnvironmentMap::EnvironmentMap(std::shared_ptr<const Image> image, Layout layout)
    : image_(std::move(image)), layout_(layout), width_(image_->width), height_(image_->height) {
    weigh();
}

std::shared_ptr<const EnvironmentMap> environment_map(const std::shared_ptr<const Image>& image,
                                                      EnvironmentData::Layout layout) {
    static SharedWork<std::pair<const Image*, EnvironmentData::Layout>, EnvironmentMap> all;  // they keep their images
    return all.get({image.get(), layout}, [&] { return std::make_shared<const EnvironmentMap>(image, layout); });
}

double EnvironmentMap::row_solid_angle(std::uint32_t y) const {
    if (layout_ == Layout::equal_area) return 4 * std::numbers::pi / height_;
    // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2): nothing cancels near the poles
    const double step = std::numbers::pi / height_;
    return 4 * std::numbers::pi * std::sin((y + 0.5) * step) * std::sin(step / 2);
}

Rgb EnvironmentMap::pixel(std::int64_t x, std::int64_t y) const {
    wrap(x, y, width_, height_, layout_);
    const Rgb c = image_->colour(std::uint32_t(x), std::uint32_t(y));
    return {usable(c.r), usable(c.g), usable(c.b)};
}

// The mean of a bilinear function over the pixel's square: (1 6 1)/8 of the neighbours along each axis. It is 0 only
// where the function is, so that no light is out of reach of sample_all().
// DECISIONS: sky-by-pixels
void EnvironmentMap::weigh() {
    const std::size_t w = width_, h = height_;
    std::vector<float> light(w * h);
    bool all_usable = true;
    double r = 0, g = 0, b = 0;
    for (std::uint32_t y = 0; y < h; ++y) {
        const double angle = row_solid_angle(y) / double(w);
        for (std::uint32_t x = 0; x < w; ++x) {
            const Rgb raw = image_->colour(x, y), c = pixel(x, y);
            all_usable &= raw.r == usable(raw.r) && raw.g == usable(raw.g) && raw.b == usable(raw.b);
            light[y * w + x] = luminance(c);
            r += c.r * angle;
            g += c.g * angle;
            b += c.b * angle;
        }
    }
    total_ = {float(r), float(g), float(b)};
    if (all_usable) numbers_ = image_->linear_rgb();

    const auto at = [&](std::int64_t x, std::int64_t y) {
        wrap(x, y, width_, height_, layout_);
        return light[std::size_t(y) * w + std::size_t(x)];
    };
    cells_ = SkyCells(width_, height_);
    std::vector<double> row(w), rows(h);
    const double mean = 64 * luminance(total_) / (4 * std::numbers::pi);
    double all = 0, bright = 0;
    for (std::size_t y = 0; y < h; ++y) {
        const auto weight = [&](std::int64_t x, std::int64_t j) { return at(x - 1, j) + 6 * at(x, j) + at(x + 1, j); };
        const auto inner = [&](std::size_t i) { return light[i - 1] + 6 * light[i] + light[i + 1]; };
        double in_row = 0;
        for (std::size_t x = 0; x < w; ++x) {
            const std::size_t i = y * w + x;
            const auto sx = std::int64_t(x), sy = std::int64_t(y);
            const bool inside = x > 0 && y > 0 && x + 1 < w && y + 1 < h;
            row[x] = inside ? inner(i - w) + 6 * inner(i) + inner(i + w)
                            : weight(sx, sy - 1) + 6 * weight(sx, sy) + weight(sx, sy + 1);
            in_row += row[x];
            row[x] = std::max(0.0, row[x] - mean);
        }
        const double angle = row_solid_angle(std::uint32_t(y));
        rows[y] = cells_.set_row(std::uint32_t(y), row) * angle;
        all += in_row * angle;
        bright += rows[y];
    }
    bright_share_ = all > 0 ? float(bright / all) : 0;
    cells_.finish(rows);
    list_rows();
}

void EnvironmentMap::list_rows() {
    for (std::uint32_t y = 0; y < height_; ++y)
        density_.push_back(cells_.share_of_row(y) * float(double(width_) / row_solid_angle(y)));
    for (std::size_t y = 0; y <= height_; ++y) {
        const float half = std::sin(pi / 2 * float(y) / float(height_));
        drops_.push_back(2 * half * half);
    }
}

Rgb EnvironmentMap::at_the_rim(const Spot& spot) const {
    const auto [x, y, dx, dy] = spot;
    return Image::Square{pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)}.bilinear(dx, dy);
}

}  // namespace lightnet
