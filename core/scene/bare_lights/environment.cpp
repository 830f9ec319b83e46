#include "core/scene/bare_lights/environment.hpp"

#include "core/base/math/columns.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/sky_layout.hpp"
#include "core/base/math/turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace lightnet {
namespace {

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
    : portal_(data.portal), scale_(data.radiance), axes_(axes_of(data.to_world)) {
    if (data.image && !data.image->empty()) map_ = environment_map(data.image, data.layout);
    total_ = scale_ * (map_ ? map_->total() : Rgb{4 * pi, 4 * pi, 4 * pi});
}

/// What turns directions into places of the map, for one layout of it: a value, which loops keep in registers.
template <EnvironmentData::Layout layout>
struct Environment::Placing {
    explicit Placing(const Environment& sky)
        : axes(sky.axes_), width(float(sky.map_->width())), height(float(sky.map_->height())) {}

    [[gnu::always_inline]] Vec2 square(Vec3 direction) const {
        const Vec3 d = axes.to_local(direction);
        const Vec2 p = layout == Layout::equal_area ? to_equal_area(d) : to_latitude_longitude(d);
        const auto within = [](float t) { return t >= 0 ? (t <= 1 ? t : 1.0f) : 0.0f; };  // no number: 0
        return {within(p.x), within(p.y)};
    }
    [[gnu::always_inline]] EnvironmentMap::Spot spot(Vec2 p) const {
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
    if (map_->layout() == Layout::equal_area) return use(Placing<Layout::equal_area>(*this));
    return use(Placing<Layout::latitude_longitude>(*this));
}

/// Places in the map, many at once.
struct Environment::Places {
    Places(const Environment& environment, std::size_t places) : sky(environment), count(places) {}

    [[gnu::always_inline]] void find_spots(const auto& placing) {
        for (std::size_t i = 0; i < count; ++i) {
            const EnvironmentMap::Spot spot = placing.spot(squares[i]);
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

inline Rgb Environment::radiance_at(const EnvironmentMap::Spot& spot) const { return scale_ * map_->colour(spot); }

inline float Environment::pdf_at(Vec2 p) const {
    const std::uint32_t x = cell(p.x, map_->width()), y = cell(p.y, map_->height());
    return map_->cells().share_in_row(x, y) * map_->density(y);
}

Rgb Environment::radiance(Vec3 direction) const {
    if (!map_) return scale_;
    return placed([&](const auto& placing) { return radiance_at(placing.spot(placing.square(direction))); });
}

float Environment::pdf(Vec3 direction) const {
    if (!map_) return inverse_pi / 4;
    return placed([&](const auto& placing) { return pdf_at(placing.square(direction)); });
}

SkyRadiance Environment::look(Vec3 direction) const {
    if (!map_) return {direction, scale_, inverse_pi / 4};
    return placed([&](const auto& placing) {
        const Vec2 p = placing.square(direction);
        return SkyRadiance{direction, radiance_at(placing.spot(p)), pdf_at(p)};
    });
}

void Environment::look(std::span<const Vec3> directions, std::span<SkyRadiance> seen) const {
    if (!map_) {
        for (std::size_t i = 0; i < directions.size(); ++i) seen[i] = look(directions[i]);
        return;
    }
    Looking looking(*this, directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) looking.directions.set(i, directions[i]);
    work_in_lanes(looking);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        __builtin_prefetch(
            map_->cells().at(cell(looking.squares.x[i], map_->width()), cell(looking.squares.y[i], map_->height())));
        map_->expect(looking.x[i], looking.y[i]);
    }
    for (std::size_t i = 0; i < directions.size(); ++i)
        seen[i] = {directions[i], looking.radiance(i), pdf_at(looking.squares[i])};
}

SkyRadiance Environment::sample(Vec2 u) const {
    if (!map_) return {sphere(u), scale_, inverse_pi / 4};
    const SkyCell cell = map_->cells().find(u);
    return placed([&](const auto& placing) {
        Vec2 square;
        const Vec3 direction =
            placing.direction({float(cell.x), float(cell.y)}, cell.within, map_->drops(cell.y), square);
        return SkyRadiance{direction, radiance_at(placing.spot(square)), cell.share * map_->density(cell.y)};
    });
}

// What sample() leaves out is even, or nearly so, and taken as if it were.
SkyRadiance Environment::sample_all(Vec2 u) const {
    if (!map_) return sample(u);
    const float bright_share = map_->bright_share();
    const bool bright = u.x < bright_share;
    const float start = bright ? 0 : bright_share, share = bright ? bright_share : 1 - bright_share;
    u.x = std::clamp((u.x - start) / share, 0.0f, 0x1.fffffep-1f);
    SkyRadiance seen = bright ? sample(u) : look(sphere(u));
    seen.pdf = bright_share * seen.pdf + (1 - bright_share) * inverse_pi / 4;
    return seen;
}

void Environment::sample(std::span<const Vec2> u, std::span<SkyRadiance> seen) const {
    if (!map_) {
        for (std::size_t i = 0; i < u.size(); ++i) seen[i] = sample(u[i]);
        return;
    }
    Seeing seeing(*this, u.size());
    const SkyCellColumns& cells = seeing.cells;
    map_->cells().find(u, seeing.cells);
    for (std::size_t i = 0; i < u.size(); ++i) {  // before their places are known: those take a while
        map_->expect(std::int64_t{cells.x[i]} - (cells.within.x[i] < 0.5f),
                     std::int64_t{cells.y[i]} - (cells.within.y[i] < 0.5f));
        seeing.drops.set(i, map_->drops(cells.y[i]));
    }
    work_in_lanes(seeing);
    for (std::size_t i = 0; i < u.size(); ++i)
        seen[i] = {{seeing.directions[i]}, seeing.radiance(i), cells.share[i] * map_->density(cells.y[i])};
}

}  // namespace lightnet
