#include "core/scene/bare_lights/environment.hpp"

#include "core/base/math/columns.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/sky_layout.hpp"
#include "core/base/math/turns.hpp"
#include "core/base/shared_work.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <tuple>

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

std::shared_ptr<const Environment> environment_of(const EnvironmentData& data) {
    // By its image, which it keeps, and the bytes of its numbers.
    static SharedWork<std::tuple<const Image*, EnvironmentData::Layout, std::string>, Environment> all;
    const auto make = [&] { return std::make_shared<const Environment>(data); };
    if (!data.image) return make();
    std::string numbers;
    const auto add = [&](const auto& number) { numbers.append(reinterpret_cast<const char*>(&number), sizeof number); };
    add(data.radiance), add(data.to_world.m);
    if (data.portal) add(data.portal->corner), add(data.portal->side), add(data.portal->other);
    return all.get({data.image.get(), data.layout, numbers}, make);
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
    bool all_usable = true;
    double r = 0, g = 0, b = 0;
    for (std::uint32_t y = 0; y < h; ++y) {
        const double angle = row_solid_angle(y) / double(w);
        for (std::uint32_t x = 0; x < w; ++x) {
            const Rgb raw = image_->colour(x, y), c = pixel(x, y) * scale_;
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

void Environment::list_rows() {
    for (std::uint32_t y = 0; y < height_; ++y)
        density_.push_back(cells_.share_of_row(y) * float(double(width_) / row_solid_angle(y)));
    for (std::size_t y = 0; y <= height_; ++y) {
        const float half = std::sin(pi / 2 * float(y) / float(height_));
        drops_.push_back(2 * half * half);
    }
}

struct Environment::Spot {
    std::int32_t x, y;
    float dx, dy;
};

/// What turns directions into places of the map, for one layout of it: a value, which loops keep in registers.
template <EnvironmentData::Layout layout>
struct Environment::Placing {
    explicit Placing(const Environment& sky) : axes(sky.axes_), width(float(sky.width_)), height(float(sky.height_)) {}

    [[gnu::always_inline]] Vec2 square(Vec3 direction) const {
        const Vec3 d = axes.to_local(direction);
        const Vec2 p = layout == Layout::equal_area ? to_equal_area(d) : to_latitude_longitude(d);
        const auto within = [](float t) { return t >= 0 ? (t <= 1 ? t : 1.0f) : 0.0f; };  // no number: 0
        return {within(p.x), within(p.y)};
    }
    [[gnu::always_inline]] Spot spot(Vec2 p) const {
        const float x = p.x * width - 0.5f, y = p.y * height - 0.5f;
        const float left = std::floor(x), top = std::floor(y);
        return {std::int32_t(left), std::int32_t(top), x - left, y - top};
    }
    /// Uniform by solid angle: in rows of longitudes in the cosine, counted from the nearer pole, between whose edges
    /// `drops` is 1 - cos of the angle.
    [[gnu::always_inline]] Vec3 direction(Vec2 cell, Vec2 within, Vec2 drops, Vec2& square) const {
        const float across = (cell.x + within.x) / width;
        if constexpr (layout == Layout::equal_area) {
            square = {across, (cell.y + within.y) / height};
            return axes.to_world(from_equal_area(square));
        }
        const bool below = 2 * cell.y >= height;
        const float away = drops.x + (drops.y - drops.x) * (below ? 1 - within.y : within.y);
        const float sine = std::sqrt(away * (2 - away)), up = below ? away - 1 : 1 - away;
        square = {across <= 1 ? across : 1.0f, 2 * turns(sine, up)};
        square.y = square.y <= 1 ? square.y : 1.0f;
        const auto phi = sine_cosine_of_turns(across - 0.5f);
        return axes.to_world({sine * phi.sine, up, -sine * phi.cosine});
    }

    Frame axes;
    float width, height;
};

// Calls `use` with the Placing of the map's layout.
template <class Use>
[[gnu::always_inline]] inline auto Environment::placed(const Use& use) const {
    if (layout_ == Layout::equal_area) return use(Placing<Layout::equal_area>(*this));
    return use(Placing<Layout::latitude_longitude>(*this));
}

/// Places in the map, many at once.
struct Environment::Places {
    Places(const Environment& environment, std::size_t places) : sky(environment), count(places) {}

    [[gnu::always_inline]] void find_spots(const auto& placing) {
        for (std::size_t i = 0; i < count; ++i) {
            const Spot spot = placing.spot(squares[i]);
            x[i] = spot.x;
            y[i] = spot.y;
            between.set(i, {spot.dx, spot.dy});
        }
    }
    Rgb radiance(std::size_t i) const { return sky.radiance_at({x[i], y[i], between.x[i], between.y[i]}); }

    const Environment& sky;
    std::size_t count;
    Columns3 directions;
    Columns2 squares, between;
    std::array<std::int32_t, lanes> x, y;
};

/// Of directions.
struct Environment::Looking : Places {
    using Places::Places;
    [[gnu::always_inline]] void work() {
        sky.placed([this](const auto& placing) __attribute__((always_inline)) {
            for (std::size_t i = 0; i < count; ++i) squares.set(i, placing.square(directions[i]));
            find_spots(placing);
        });
    }
};

/// Of cells.
struct Environment::Seeing : Places {
    using Places::Places;
    [[gnu::always_inline]] void work() {
        sky.placed([this](const auto& placing) __attribute__((always_inline)) {
            for (std::size_t i = 0; i < count; ++i) {
                Vec2 square;
                const Vec2 cell{float(std::int32_t(cells.x[i])), float(std::int32_t(cells.y[i]))};
                directions.set(i, placing.direction(cell, cells.within[i], drops[i], square));
                squares.set(i, square);
            }
            find_spots(placing);
        });
    }

    SkyCellColumns cells;
    Columns2 drops;
};

inline Rgb Environment::radiance_at(const Spot& spot) const {
    const auto [x, y, dx, dy] = spot;
    const bool inside = x >= 0 && y >= 0 && std::uint32_t(x) + 1 < width_ && std::uint32_t(y) + 1 < height_;
    if (inside && numbers_) {
        const float* upper = numbers_ + 3 * (std::size_t(y) * width_ + std::size_t(x));
        const float* lower = upper + 3 * std::size_t{width_};
        const auto colour = [](const float* at) { return Rgb{at[0], at[1], at[2]}; };
        return scale_ *
               Image::Square{colour(upper), colour(upper + 3), colour(lower), colour(lower + 3)}.bilinear(dx, dy);
    }
    return scale_ * at_the_rim(spot);
}

Rgb Environment::at_the_rim(const Spot& spot) const {
    const auto [x, y, dx, dy] = spot;
    return Image::Square{pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)}.bilinear(dx, dy);
}

inline float Environment::pdf_at(Vec2 p) const {
    const std::uint32_t x = cell(p.x, width_), y = cell(p.y, height_);
    return cells_.share_in_row(x, y) * density_[y];
}

Rgb Environment::radiance(Vec3 direction) const {
    if (!image_) return scale_;
    return placed([&](const auto& placing) { return radiance_at(placing.spot(placing.square(direction))); });
}

float Environment::pdf(Vec3 direction) const {
    if (!image_) return inverse_pi / 4;
    return placed([&](const auto& placing) { return pdf_at(placing.square(direction)); });
}

SkyRadiance Environment::look(Vec3 direction) const {
    if (!image_) return {direction, scale_, inverse_pi / 4};
    return placed([&](const auto& placing) {
        const Vec2 p = placing.square(direction);
        return SkyRadiance{direction, radiance_at(placing.spot(p)), pdf_at(p)};
    });
}

// Both rows of pixels that lie around.
inline void Environment::expect(std::int64_t x, std::int64_t y) const {
    const auto column = std::uint32_t(std::max<std::int64_t>(0, x)), row = std::uint32_t(std::max<std::int64_t>(0, y));
    const std::uint32_t below = std::min(row + 1, height_ - 1);
    if (!numbers_) {
        image_->expect(column, row);
        image_->expect(column, below);
        return;
    }
    __builtin_prefetch(numbers_ + 3 * (std::size_t{row} * width_ + column));
    __builtin_prefetch(numbers_ + 3 * (std::size_t{below} * width_ + column));
}

void Environment::look(std::span<const Vec3> directions, std::span<SkyRadiance> seen) const {
    if (!image_) {
        for (std::size_t i = 0; i < directions.size(); ++i) seen[i] = look(directions[i]);
        return;
    }
    Looking looking(*this, directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) looking.directions.set(i, directions[i]);
    work_in_lanes(looking);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        __builtin_prefetch(cells_.at(cell(looking.squares.x[i], width_), cell(looking.squares.y[i], height_)));
        expect(looking.x[i], looking.y[i]);
    }
    for (std::size_t i = 0; i < directions.size(); ++i)
        seen[i] = {directions[i], looking.radiance(i), pdf_at(looking.squares[i])};
}

Vec2 Environment::drops_of(std::uint32_t y) const {
    const std::uint32_t from_pole = 2 * y >= height_ ? height_ - 1 - y : y;
    return {drops_[from_pole], drops_[from_pole + 1]};
}

SkyRadiance Environment::sample(Vec2 u) const {
    if (!image_) return {sphere(u), scale_, inverse_pi / 4};
    const SkyCell cell = cells_.find(u);
    return placed([&](const auto& placing) {
        Vec2 square;
        const Vec3 direction = placing.direction({float(cell.x), float(cell.y)}, cell.within, drops_of(cell.y), square);
        return SkyRadiance{direction, radiance_at(placing.spot(square)), cell.share * density_[cell.y]};
    });
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
    if (!image_) {
        for (std::size_t i = 0; i < u.size(); ++i) seen[i] = sample(u[i]);
        return;
    }
    Seeing seeing(*this, u.size());
    const SkyCellColumns& cells = seeing.cells;
    cells_.find(u, seeing.cells);
    for (std::size_t i = 0; i < u.size(); ++i) {  // before their places are known: those take a while
        expect(std::int64_t{cells.x[i]} - (cells.within.x[i] < 0.5f),
               std::int64_t{cells.y[i]} - (cells.within.y[i] < 0.5f));
        seeing.drops.set(i, drops_of(cells.y[i]));
    }
    work_in_lanes(seeing);
    for (std::size_t i = 0; i < u.size(); ++i)
        seen[i] = {{seeing.directions[i]}, seeing.radiance(i), cells.share[i] * density_[cells.y[i]]};
}

}  // namespace lightnet
