#include "core/scene/lamps/environment.hpp"

#include "core/base/math/sampling.hpp"
#include "core/base/math/sky_layout.hpp"
#include "core/scene/lamps/prefix_cdf.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

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

// The frame whose axes are the columns of a rotation; of a reflection, too. What is neither turns nothing.
Frame axes_of(const Matrix& to_world) {
    const auto axis = [&](Vec3 v) { return normalize(transform_direction(to_world, v)); };
    const Frame axes{axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})};
    const bool usable = finite(axes.x) && finite(axes.y) && finite(axes.z);
    return usable ? axes : Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

std::uint32_t cell(float at, std::uint32_t count) {
    return std::uint32_t(std::clamp(at * float(count), 0.0f, float(count) - 1));
}

}  // namespace

Environment::Environment(const EnvironmentData& data)
    : portal_(data.portal), scale_(data.radiance), layout_(data.layout), axes_(axes_of(data.to_world)) {
    total_ = scale_ * (4 * pi);
    if (!data.image || data.image->empty()) return;
    image_ = data.image;
    width_ = image_->width;
    height_ = image_->height;
    weigh();
}

double Environment::row_solid_angle(std::uint32_t y) const {
    if (layout_ == EnvironmentData::Layout::equal_area) return 4 * std::numbers::pi / height_;
    // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2): nothing cancels near the poles
    const double step = std::numbers::pi / height_;
    return 4 * std::numbers::pi * std::sin((y + 0.5) * step) * std::sin(step / 2);
}

Rgb Environment::pixel(std::int64_t x, std::int64_t y) const {
    wrap(x, y, width_, height_, layout_);
    const Rgb c = image_->colour(std::uint32_t(x), std::uint32_t(y));
    return {usable(c.r), usable(c.g), usable(c.b)};
}

// The mean of a bilinear function over the pixel's square: (1 6 1)/8 of the neighbours along each axis. It is 0 only
// where the function is, so that no light is out of reach of sample_all().
// DECISIONS: sky-by-pixels
void Environment::weigh() {
    const std::size_t w = width_, h = height_;
    std::vector<float> light(w * h);
    double r = 0, g = 0, b = 0;
    for (std::uint32_t y = 0; y < h; ++y) {
        const double angle = row_solid_angle(y) / double(w);
        for (std::uint32_t x = 0; x < w; ++x) {
            const Rgb raw = image_->colour(x, y), c = pixel(x, y) * scale_;
            all_usable_ &= raw.r == usable(raw.r) && raw.g == usable(raw.g) && raw.b == usable(raw.b);
            light[y * w + x] = luminance(c);
            r += c.r * angle;
            g += c.g * angle;
            b += c.b * angle;
        }
    }
    total_ = {float(r), float(g), float(b)};

    const auto at = [&](std::int64_t x, std::int64_t y) {
        wrap(x, y, width_, height_, layout_);
        return light[std::size_t(y) * w + std::size_t(x)];
    };
    columns_.resize(w * h);
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
        rows[y] = prefix_cdf(std::span<const double>(row), std::span(columns_).subspan(y * w, w)) * angle;
        all += in_row * angle;
        bright += rows[y];
    }
    bright_share_ = all > 0 ? float(bright / all) : 0;
    prefix_cdf(rows, rows_);
    mark_all();
}

// A mark for 16 cells: those are a line or two of the cache, and all marks may stay in it.
void Environment::mark_all() {
    const auto marks_for = [](std::size_t cells) { return std::bit_ceil(std::max<std::size_t>(1, cells / 16)) + 1; };
    row_marks_.resize(marks_for(height_));
    mark(rows_, row_marks_);
    marks_per_row_ = marks_for(width_);
    marks_.resize(marks_per_row_ * height_);
    for (std::size_t y = 0; y < height_; ++y)
        mark(columns_of(y), std::span(marks_).subspan(y * marks_per_row_, marks_per_row_));
    for (std::uint32_t y = 0; y < height_; ++y) density_.push_back(float(double(width_) / row_solid_angle(y)));
    for (std::size_t y = 0; y <= height_; ++y) {
        const float half = std::sin(pi / 2 * float(y) / float(height_));
        drops_.push_back(2 * half * half);
    }
}

Vec2 Environment::to_square(Vec3 direction) const {
    const Vec3 d = axes_.to_local(direction);
    const Vec2 p = layout_ == EnvironmentData::Layout::equal_area ? to_equal_area(d) : to_latitude_longitude(d);
    const auto within = [](float t) { return t >= 0 && t <= 1 ? t : t > 1 ? 1.0f : 0.0f; };  // no number: 0
    return {within(p.x), within(p.y)};
}

Rgb Environment::radiance_at(Vec2 p) const {
    const float x = p.x * float(width_) - 0.5f, y = p.y * float(height_) - 0.5f;
    const float left = std::floor(x), top = std::floor(y), dx = x - left, dy = y - top;
    const auto i = std::int64_t(left), j = std::int64_t(top);
    const bool inside = i >= 0 && j >= 0 && i + 1 < width_ && j + 1 < height_;
    if (inside && all_usable_) {
        const auto column = std::uint32_t(i), row = std::uint32_t(j);
        return scale_ * image_->square(column, column + 1, row, row + 1).bilinear(dx, dy);
    }
    return scale_ * Image::Square{pixel(i, j), pixel(i + 1, j), pixel(i, j + 1), pixel(i + 1, j + 1)}.bilinear(dx, dy);
}

float Environment::pdf_of(std::size_t x, std::size_t y) const {
    return share_of(rows_, y) * share_of(columns_of(y), x) * density_[y];
}

// Who finds light there often asks for its density next, which is fetched meanwhile.
Rgb Environment::radiance(Vec3 direction) const {
    if (!image_) return scale_;
    const Vec2 p = to_square(direction);
    __builtin_prefetch(&columns_of(cell(p.y, height_))[cell(p.x, width_)]);
    return radiance_at(p);
}

float Environment::pdf(Vec3 direction) const {
    if (!image_) return inverse_pi / 4;
    const Vec2 p = to_square(direction);
    return pdf_of(cell(p.x, width_), cell(p.y, height_));
}

SkyRadiance Environment::look(Vec3 direction) const {
    if (!image_) return {direction, scale_, inverse_pi / 4};
    const Vec2 p = to_square(direction);
    return {direction, radiance_at(p), pdf_of(cell(p.x, width_), cell(p.y, height_))};
}

void Environment::expect(Vec2 p) const {
    const auto before = [](float at, std::uint32_t count) {
        return std::uint32_t(
            std::clamp(std::int64_t(std::floor(at * float(count) - 0.5f)), std::int64_t{0}, std::int64_t{count} - 1));
    };
    const std::uint32_t x = before(p.x, width_), y = before(p.y, height_);
    image_->expect(x, y);
    image_->expect(x, std::min(y + 1, height_ - 1));
}

void Environment::look(std::span<const Vec3> directions, std::span<SkyRadiance> seen) const {
    if (!image_) {
        for (std::size_t i = 0; i < directions.size(); ++i) seen[i] = look(directions[i]);
        return;
    }
    std::array<Vec2, lanes> squares;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        squares[i] = to_square(directions[i]);
        __builtin_prefetch(&columns_of(cell(squares[i].y, height_))[cell(squares[i].x, width_)]);
        expect(squares[i]);
    }
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec2 p = squares[i];
        seen[i] = {directions[i], radiance_at(p), pdf_of(cell(p.x, width_), cell(p.y, height_))};
    }
}

void Environment::find_row(float u, Cell& cell) const {
    cell.y = pick(rows_, row_marks_, u);
    cell.within.y = u;
}

void Environment::find_column(float u, Cell& cell) const {
    cell.x = pick(columns_of(cell.y), marks_of(cell.y), u);
    cell.within.x = u;
}

// Uniform by solid angle: in rows of longitudes in the cosine, counted from the nearer pole.
SkyRadiance Environment::seen_in(const Cell& cell) const {
    const auto [x, y, within] = cell;
    const float across = (float(x) + within.x) / float(width_), pdf = pdf_of(x, y);
    if (layout_ == EnvironmentData::Layout::equal_area) {
        const Vec2 p{across, (float(y) + within.y) / float(height_)};
        return {axes_.to_world(from_equal_area(p)), radiance_at(p), pdf};
    }
    const bool below = 2 * y >= height_;
    const std::size_t from_pole = below ? height_ - 1 - y : y;
    const float first = drops_[from_pole], last = drops_[from_pole + 1];
    const float away = first + (last - first) * (below ? 1 - within.y : within.y), sine = std::sqrt(away * (2 - away));
    const float height = below ? away - 1 : 1 - away, phi = 2 * pi * (across - 0.5f);
    const Vec2 p{std::min(across, 1.0f), std::min(std::atan2(sine, height) / pi, 1.0f)};
    return {axes_.to_world({sine * std::sin(phi), height, -sine * std::cos(phi)}), radiance_at(p), pdf};
}

SkyRadiance Environment::sample(Vec2 u) const {
    if (!image_) return {sphere(u), scale_, inverse_pi / 4};
    Cell cell;
    find_row(u.y, cell);
    find_column(u.x, cell);
    return seen_in(cell);
}

// What sample() leaves out is even, or nearly so, and taken as if it were.
SkyRadiance Environment::sample_all(Vec2 u) const {
    if (!image_) return sample(u);
    const bool bright = u.x < bright_share_;
    const float start = bright ? 0 : bright_share_, share = bright ? bright_share_ : 1 - bright_share_;
    u.x = std::clamp((u.x - start) / share, 0.0f, 0x1.fffffep-1f);
    SkyRadiance seen = bright ? sample(u) : look(sphere(u));
    seen.pdf = bright_share_ * seen.pdf + (1 - bright_share_) * inverse_pi / 4;
    return seen;
}

void Environment::sample(std::span<const Vec2> u, std::span<SkyRadiance> seen) const {
    std::array<Cell, lanes> cells;
    for (std::size_t i = 0; i < u.size(); ++i) {
        find_row(u[i].y, cells[i]);
        const auto marks = marks_of(cells[i].y);
        const auto piece = std::size_t(u[i].x * float(marks_per_row_ - 1));
        __builtin_prefetch(&marks[piece]);
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
        const auto marks = marks_of(cells[i].y);
        const auto piece = std::size_t(u[i].x * float(marks_per_row_ - 1));
        __builtin_prefetch(&columns_of(cells[i].y)[(marks[piece] + marks[piece + 1]) / 2]);
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
        auto& [x, y, within] = cells[i];
        find_column(u[i].x, cells[i]);
        const std::size_t left = within.x < 0.5f && x > 0 ? x - 1 : x, above = within.y < 0.5f && y > 0 ? y - 1 : y;
        image_->expect(std::uint32_t(left), std::uint32_t(above));
        image_->expect(std::uint32_t(left), std::uint32_t(std::min<std::size_t>(above + 1, height_ - 1)));
    }
    for (std::size_t i = 0; i < u.size(); ++i) seen[i] = seen_in(cells[i]);
}

}  // namespace lightnet
